//! Applies the rules. Each section reports its findings and claims the paths of the dump that it has judged.

mod accept;
mod codes;
mod constraints;
mod fields;
mod frame;
mod operations;
mod process;
mod results;
mod sources;
mod states;
mod types;
mod unjudged;

pub(crate) use process::unannounced;

use crate::Packages;
use crate::finding::Finding;
use crate::matching::{self, Pair, TypePairs};
use fc_spec::model::{Model, Operation, TypeDef};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The last step of a path for a changed order of the items in both versions.
const ORDER: &str = "#order";

/// A path of the dump. The id of an item is its step into a list; the new version's id counts.
pub(crate) type Path = Vec<String>;

/// The judged paths, and the renamed items.
#[derive(Default)]
pub(crate) struct Account {
    /// Judged paths. A claim covers everything below its path.
    pub(crate) claims: BTreeSet<Path>,
    /// New ids by old ids, per path of a list.
    pub(crate) renames: BTreeMap<Path, BTreeMap<String, String>>,
}

/// Two models and the findings so far.
struct Judge<'m> {
    old: &'m Model,
    new: &'m Model,
    packages: Packages,
    /// New names of operations by their old names.
    new_names: HashMap<&'m str, &'m str>,
    operations: Vec<Pair<'m, Operation>>,
    types: TypePairs<'m>,
    found: Vec<Finding>,
    account: Account,
}

/// Returns the findings of all rules, and the differences without a rule, in no order.
pub(crate) fn judge(old: &Model, new: &Model, packages: Packages) -> Vec<Finding> {
    let mut judge = Judge::of(old, new, packages);
    judge.rules();
    let unjudged = unjudged::unjudged(old, new, &judge.account);
    judge.found.extend(unjudged);
    judge.found
}

/// Returns the findings of the rules alone.
pub(crate) fn judged(old: &Model, new: &Model) -> Vec<Finding> {
    let mut judge = Judge::of(old, new, Packages::default());
    judge.rules();
    judge.found
}

impl<'m> Judge<'m> {
    fn of(old: &'m Model, new: &'m Model, packages: Packages) -> Self {
        let operations = matching::operations(old, new);
        let types = matching::types(old, new, &operations);
        let names = operations.iter().filter_map(Pair::both);
        let names = names.map(|(one, other)| (one.name.as_str(), other.name.as_str()));
        Self {
            old,
            new,
            packages,
            new_names: names.collect(),
            operations,
            types,
            found: Vec::new(),
            account: Account::default(),
        }
    }

    fn rules(&mut self) {
        self.protocol();
        self.frame();
        self.operations();
        self.types();
        self.envelope();
        self.results();
        self.tables();
    }

    fn report(&mut self, finding: Finding) {
        self.found.push(finding);
    }

    /// Claims a path and everything below it.
    fn claim(&mut self, path: &[&str]) {
        self.claim_in::<&str>(&[], path);
    }

    /// Claims a path below another one.
    fn claim_in<S: AsRef<str>>(&mut self, base: &[S], parts: &[&str]) {
        let base = base.iter().map(AsRef::as_ref);
        let path = base.chain(parts.iter().copied()).map(str::to_owned);
        self.account.claims.insert(path.collect());
    }

    /// Claims an item that only one version of a list has, and the order of the list.
    fn claim_item<S: AsRef<str>>(&mut self, list: &[S], id: &str) {
        self.claim_in(list, &[id]);
        self.claim_in(list, &[ORDER]);
    }

    /// Records that an item of a list has another id in the new version.
    fn renamed<S: AsRef<str>>(&mut self, list: &[S], old: &str, new: &str) {
        let list: Path = list.iter().map(|part| part.as_ref().to_owned()).collect();
        let renames = self.account.renames.entry(list).or_default();
        renames.insert(old.to_owned(), new.to_owned());
    }
}

/// Returns the name of a type in findings: the message that contains it, or its own name.
fn called(ty: &TypeDef) -> String {
    match &ty.body_of {
        Some(place) => {
            let path = place.path.iter().map(String::as_str);
            let parts = [place.operation.as_str(), place.side.name()]
                .into_iter()
                .chain(path);
            parts.collect::<Vec<_>>().join(".")
        }
        None => ty.name.clone(),
    }
}

/// Returns a value as a string, or an empty string.
fn shown<T: std::fmt::Display>(value: Option<T>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}

/// Indexes items by a key.
fn by<'m, T, K: std::hash::Hash + Eq>(
    things: &'m [T],
    key: impl Fn(&'m T) -> K,
) -> HashMap<K, &'m T> {
    things.iter().map(|thing| (key(thing), thing)).collect()
}

/// Returns a value as JSON.
fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string(value).unwrap_or_default()
}
