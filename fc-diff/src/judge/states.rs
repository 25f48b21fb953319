//! States of a process: the marks of enum values, and the states in which a command is accepted.

use super::types::Here;
use super::{Judge, json};
use crate::finding::Finding;
use crate::matching::Pair;
use crate::rule::Language;
use crate::rules::choices::STATES;
use crate::rules::operations::ACCEPTED;
use fc_spec::model::{EnumType, EnumValue, Operation, Scalar, StateOrder, StateSet};
use std::collections::BTreeMap;

impl Judge<'_> {
    /// Judges `order`, `then`, `final` and `error` of an enum.
    pub(super) fn states(
        &mut self,
        here: &Here,
        [old, new]: [&EnumType; 2],
        pairs: &[Pair<'_, EnumValue>],
    ) {
        let pairs: Vec<_> = pairs.iter().filter_map(Pair::both).collect();
        let names = pairs.iter();
        let names: BTreeMap<&str, &str> = names
            .map(|(one, other)| (&*one.name, &*other.name))
            .collect();
        let mut changed = Vec::new();
        for (one, other) in &pairs {
            let kept = |then: &[String]| -> Vec<String> {
                let kept = then.iter().filter_map(|name| names.get(name.as_str()));
                kept.map(|name| (*name).to_owned()).collect()
            };
            // Other findings report new and removed values.
            let is_kept = |name: &&String| names.values().any(|it| *it == name.as_str());
            let now: Vec<String> = other.then.iter().filter(is_kept).cloned().collect();
            let is_same = (one.is_final, one.is_error) == (other.is_final, other.is_error)
                && kept(&one.then) == now;
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
    pub(super) fn accepted(&mut self, old: &Operation, new: &Operation) {
        let sets = |it: &Operation| {
            let sets = it
                .accepted()
                .into_iter()
                .flat_map(|it| it.state_sets().to_vec());
            sets.collect::<Vec<StateSet>>()
        };
        let (before, after) = (sets(old), sets(new));
        let other_name = |name: &str| -> String {
            let mut pairs = self.types.both.iter();
            let pair = pairs.find(|pair| pair.old.name == name);
            pair.map_or(name, |pair| &pair.new.name).to_owned()
        };
        let before: BTreeMap<String, Vec<Scalar>> = before
            .into_iter()
            .map(|set| (other_name(set.ty.name()), set.values))
            .collect();
        let after: BTreeMap<String, Vec<Scalar>> = after
            .into_iter()
            .map(|set| (set.ty.name().to_owned(), set.values))
            .collect();
        let is_within = |inner: &BTreeMap<String, Vec<Scalar>>,
                         outer: &BTreeMap<_, Vec<Scalar>>| {
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
        let shown = |sets: &BTreeMap<String, Vec<Scalar>>| {
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
