//! Where a spec names things that it says elsewhere.

use super::places::{Item, Place, Places};
use crate::language::{Sought, sites};
use crate::syntax::Tree;
use std::sync::Arc;

/// Every place at which a thing is named, other than that which says it, in the order of the files.
#[derive(Clone, Debug, Default)]
pub struct Uses(Vec<Arc<Named>>);

/// Those of one file.
#[derive(Debug, Default)]
pub(super) struct Named {
    /// In the order in which they stand.
    all: Vec<Sought>,
    /// The same by their names.
    by_name: Vec<usize>,
}

/// Of one file.
pub(super) fn named(tree: &Tree<'_>) -> Named {
    let mut all = Vec::new();
    sites(tree.root(), &mut |site| all.extend(site.sought()));
    let mut by_name: Vec<usize> = (0..all.len()).collect();
    by_name.sort_by_key(|at| all.get(*at).map(|sought: &Sought| sought.name.as_str()));
    Named { all, by_name }
}

impl Named {
    fn called<'n>(&'n self, name: &'n str) -> impl Iterator<Item = &'n Sought> {
        let named = |at: &usize| self.all.get(*at).map(|sought| sought.name.as_str());
        let first = self.by_name.partition_point(|at| named(at) < Some(name));
        let from = self.by_name.get(first..).unwrap_or_default();
        let sought = from.iter().filter_map(|at| self.all.get(*at));
        sought.take_while(move |sought| sought.name == name)
    }
}

impl Uses {
    pub(super) fn of_files(files: Vec<Arc<Named>>) -> Self {
        Self(files)
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = &Sought> {
        self.0.iter().flat_map(|file| &file.all)
    }

    /// Those of one thing.
    pub fn of<'u>(&'u self, item: &'u Item) -> impl Iterator<Item = &'u Sought> {
        let called = self.0.iter().flat_map(|file| file.called(&item.name));
        called.filter(|sought| sought.is(item))
    }
}

impl Sought {
    /// Whether it is this thing.
    #[must_use]
    pub fn is(&self, item: &Item) -> bool {
        self.name == item.name && self.kinds.contains(&item.kind) && self.owner == item.owner
    }

    /// The thing, and where it is written; `None` if the spec does not have it.
    #[must_use]
    pub fn found<'p>(&self, places: &'p Places) -> Option<(Item, &'p Place)> {
        self.kinds.iter().find_map(|kind| {
            let item = Item {
                kind,
                owner: self.owner.clone(),
                name: self.name.clone(),
            };
            let place = places.get(&item)?;
            Some((item, place))
        })
    }
}
