//! States of a process: the marks of enum values, and the states in which a command is accepted.

use super::types::Here;
use super::{Judge, json};
use crate::finding::Finding;
use crate::matching::Pair;
use crate::rule::Language;
use crate::rules::choices::STATES;
use crate::rules::operations::ACCEPTED;
use fc_spec::model::{Accepted, EnumType, EnumValue, Operation, Scalar, StateOrder};
use std::collections::BTreeMap;

impl<'m> Judge<'m> {
    /// Judges `order`, `then`, `final` and `error` of an enum.
    pub(super) fn states(
        &mut self,
        here: &Here,
        [old, new]: [&EnumType; 2],
        pairs: &[Pair<'_, EnumValue>],
    ) {
        let pairs: Vec<_> = pairs.iter().filter_map(Pair::both).collect();
        let names = pairs.iter();
        let names: BTreeMap<&String, &String> =
            names.map(|(one, other)| (&one.name, &other.name)).collect();
        let mut changed = Vec::new();
        for (one, other) in &pairs {
            // Other findings report new and removed values.
            let kept = one.then.iter().filter_map(|name| names.get(name).copied());
            let is_kept = |name: &&String| names.values().any(|it| it == name);
            let is_same = (one.is_final, one.is_error) == (other.is_final, other.is_error)
                && kept.eq(other.then.iter().filter(is_kept));
            if !is_same {
                changed.push(other.name.as_str());
            }
        }
        let (before, after) = (functions(old), functions(new));
        let lost = before.into_iter().filter(|it| !after.contains(it));
        let mut source: Vec<Language> = lost.map(|(language, _)| language).collect();
        source.sort_unstable();
        source.dedup();
        let is_other = old.order != new.order || !changed.is_empty();
        if is_other || !source.is_empty() {
            let word = |it: &EnumType| it.order.map_or("", StateOrder::name);
            let values = match (old.order == new.order, changed.as_slice()) {
                (true, changed) => [String::new(), changed.join(", ")],
                (false, _) => [word(old).to_owned(), word(new).to_owned()],
            };
            let finding = Finding::new(&STATES, &here.subject, super::frame::both(&values));
            let finding = here.owned("enum", finding);
            self.report(finding.source(source).behaviour(is_other));
            self.claim_in(&here.path, &["order"]);
        }
        // This finding covers the marks, or the one about a new or removed value does.
        for (_, other) in pairs {
            for key in ["then", "final", "error"] {
                self.claim_in(&here.path, &["values", &other.name, key]);
            }
        }
    }

    /// Judges the states in which a command is accepted.
    pub(super) fn accepted(&mut self, old: &'m Operation, new: &'m Operation) {
        let types = &self.types.both;
        let new_name = |name: &'m str| {
            let pair = types.iter().find(|pair| pair.old.name == name);
            pair.map_or(name, |pair| &pair.new.name)
        };
        let (before, after) = (states(old, new_name), states(new, |name| name));
        let is_within = |inner: &States<'_>, outer: &States<'_>| {
            outer.iter().all(|(ty, allowed)| {
                let values = inner.get(ty);
                values.is_some_and(|values| values.iter().all(|value| allowed.contains(value)))
            })
        };
        let (narrows, widens) = (!is_within(&before, &after), !is_within(&after, &before));
        if !narrows && !widens {
            return;
        }
        let is_lost = before.keys().any(|ty| !after.contains_key(ty));
        let shown = |sets: &States<'_>| {
            let sets = sets.iter().map(|(ty, values)| {
                let values: Vec<String> = values.iter().map(json).collect();
                format!("{ty}: {}", values.join(", "))
            });
            sets.collect::<Vec<_>>().join("; ")
        };
        let values = [shown(&before), shown(&after)];
        let finding = Finding::new(&ACCEPTED, &new.name, super::frame::both(&values));
        let finding = finding.between(old, new).source_if(is_lost);
        self.report(finding.behaviour(narrows));
        match (old.accepted(), new.accepted()) {
            (Some(_), Some(_)) => self.claim(&["operations", &new.name, "accepted", "in"]),
            _ => self.claim(&["operations", &new.name, "accepted"]),
        }
    }
}

/// The values of enums in which a command is accepted, by the names of the enums.
type States<'m> = BTreeMap<&'m str, &'m [Scalar]>;

/// Returns the states in which a command is accepted. `name` returns the name of an enum.
fn states<'m>(command: &'m Operation, name: impl Fn(&'m str) -> &'m str) -> States<'m> {
    let sets = command
        .accepted()
        .into_iter()
        .flat_map(Accepted::state_sets);
    sets.map(|set| (name(set.ty.name()), set.values.as_slice()))
        .collect()
}

/// Returns the functions for states that the packages of an enum have, by language.
fn functions(of: &EnumType) -> Vec<(Language, &'static str)> {
    use Language::{Cpp, JvmBinary, Kotlin, Python, Rust};
    let has = |is: fn(&EnumValue) -> bool| of.values.iter().any(is);
    let (ends, fails) = (has(|it| it.is_final), has(|it| it.is_error));
    let follows = of.order.map(|order| match order {
        StateOrder::Normal => "normally_follows",
        StateOrder::Complete => "may_follow",
    });
    let is_marked = ends || fails || follows.is_some();
    let mut found = Vec::new();
    found.extend(ends.then_some((Rust, "is_final")));
    found.extend(fails.then_some((Rust, "is_error")));
    found.extend(follows.map(|name| (Rust, name)));
    found.extend(follows.map(|name| (Cpp, name)));
    if is_marked || has(|it| !it.then.is_empty()) {
        found.extend([Kotlin, JvmBinary].map(|it| (it, "State")));
    }
    if is_marked {
        found.extend([Rust, Cpp, Python].map(|it| (it, "State")));
    }
    found
}
