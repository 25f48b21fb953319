//! Modules that need each other, for languages whose files cannot import in a circle.

use std::collections::{BTreeMap, BTreeSet};

/// The ids that an id needs.
pub type Needs<'a> = BTreeMap<&'a str, BTreeSet<&'a str>>;

/// Adds what each id needs by way of others.
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

/// The first id of those that need this one and that it needs. An id outside of a circle is alone.
#[must_use]
pub fn first_of_circle<'a>(reached: &Needs<'a>, id: &'a str) -> &'a str {
    let leads_to = |one: &str, other: &str| reached.get(one).is_some_and(|it| it.contains(other));
    let mut ids = reached.keys();
    let first = ids.find(|other| leads_to(other, id) && leads_to(id, other));
    first.copied().unwrap_or(id)
}
