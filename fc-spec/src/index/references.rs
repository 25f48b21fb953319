//! The places where a spec names things that it declares elsewhere.

use super::definitions::{DefId, DefSite, Definitions};
use crate::language::{Reference, visit};
use crate::syntax::Tree;
use std::sync::Arc;

/// Every name of a thing, other than in its declaration, in the order of the files.
#[derive(Clone, Debug, Default)]
pub struct References(Vec<Arc<FileReferences>>);

/// The references in one file.
#[derive(Debug, Default)]
pub(super) struct FileReferences {
    /// In the order of the file.
    all: Vec<Reference>,
    /// Indexes into `all`, in the order of the names.
    by_name: Vec<usize>,
}

/// Returns the references in a file.
pub(super) fn of_file(tree: &Tree<'_>) -> FileReferences {
    let mut all = Vec::new();
    visit(tree.root(), &mut |occurrence| {
        all.extend(occurrence.reference());
    });
    let mut by_name: Vec<usize> = (0..all.len()).collect();
    by_name.sort_by_key(|at| {
        all.get(*at)
            .map(|reference: &Reference| reference.name.as_str())
    });
    FileReferences { all, by_name }
}

impl FileReferences {
    fn called<'n>(&'n self, name: &'n str) -> impl Iterator<Item = &'n Reference> {
        let named = |at: &usize| self.all.get(*at).map(|reference| reference.name.as_str());
        let first = self.by_name.partition_point(|at| named(at) < Some(name));
        let from = self.by_name.get(first..).unwrap_or_default();
        let references = from.iter().filter_map(|at| self.all.get(*at));
        references.take_while(move |reference| reference.name == name)
    }
}

impl References {
    pub(super) fn of_files(files: Vec<Arc<FileReferences>>) -> Self {
        Self(files)
    }

    /// Returns all references.
    pub fn iter(&self) -> impl Iterator<Item = &Reference> {
        self.0.iter().flat_map(|file| &file.all)
    }

    /// Returns the references to a thing.
    pub fn of<'u>(&'u self, item: &'u DefId) -> impl Iterator<Item = &'u Reference> {
        let called = self.0.iter().flat_map(|file| file.called(&item.name));
        called.filter(|reference| reference.is(item))
    }
}

impl Reference {
    /// Returns `true` if it names this thing.
    #[must_use]
    pub fn is(&self, item: &DefId) -> bool {
        self.name == item.name && self.kinds.contains(&item.kind) && self.owner == item.owner
    }

    /// Returns the thing with its place. `None` if the spec does not declare it.
    #[must_use]
    pub fn found<'p>(&self, places: &'p Definitions) -> Option<(DefId, &'p DefSite)> {
        self.kinds.iter().find_map(|kind| {
            let item = DefId {
                kind,
                owner: self.owner.clone(),
                name: self.name.clone(),
            };
            let place = places.get(&item)?;
            Some((item, place))
        })
    }
}
