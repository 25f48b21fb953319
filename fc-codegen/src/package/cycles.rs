//! Import cycles between modules, for languages whose files cannot import each other.

use std::collections::{BTreeMap, BTreeSet};

/// The ids that each id needs directly.
pub type Needs<'a> = BTreeMap<&'a str, BTreeSet<&'a str>>;

/// Returns the transitive closure of `needs`.
#[must_use]
pub fn reached<'a>(needs: &Needs<'a>) -> Needs<'a> {
    let all = needs.iter().map(|(id, direct)| {
        let mut reached = BTreeSet::new();
        let mut open: Vec<&str> = direct.iter().copied().collect();
        while let Some(next) = open.pop() {
            if reached.insert(next) {
                open.extend(needs.get(next).into_iter().flatten());
            }
        }
        (*id, reached)
    });
    all.collect()
}

/// Returns the smallest id of the cycle that contains `id`.
///
/// Returns `id` if it is in no cycle.
#[must_use]
pub fn first_of_circle<'a>(reached: &Needs<'a>, id: &'a str) -> &'a str {
    let leads_to = |one: &str, other: &str| reached.get(one).is_some_and(|it| it.contains(other));
    let mut ids = reached.keys();
    let first = ids.find(|other| leads_to(other, id) && leads_to(id, other));
    first.copied().unwrap_or(id)
}
