//! The places where a spec declares and names each thing, for editors, renames and messages about a model.
//!
//! It reads each file separately, also in specs with errors, and keeps the results of unchanged files.

mod definitions;
mod located;
mod references;

use crate::load::Trees;
use crate::source::{FileId, Sources};
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use std::sync::{Arc, OnceLock};

pub use crate::language::{Occurrence, OtherKey, Reference, Role, occurrence_at, visit};
use definitions::FileDefinitions;
pub(crate) use definitions::entry_at;
pub use definitions::{DefId, DefSite, Definitions, described};
pub use located::{Located, NotDeclared, locate};
use references::FileReferences;
pub use references::References;

/// The files of a spec as trees, with the places and names found in each.
#[derive(Clone, Debug, Default)]
pub struct Index {
    trees: Trees,
    files: Vec<Arc<FileIndex>>,
}

/// The places and names in one file.
#[derive(Debug, Default)]
struct FileIndex {
    definitions: OnceLock<Arc<FileDefinitions>>,
    references: OnceLock<Arc<FileReferences>>,
}

/// Returns the place of each declaration in a spec.
#[must_use]
pub fn definitions(sources: &Sources) -> Definitions {
    Index::new(Trees::new(sources)).definitions()
}

/// Returns all references in a spec. Skips files that are not valid YAML.
#[must_use]
pub fn references(sources: &Sources) -> References {
    Index::new(Trees::new(sources)).references()
}

impl Index {
    /// Returns the index of these files.
    #[must_use]
    pub fn new(trees: Trees) -> Self {
        Self::default().with(trees)
    }

    /// Returns the index of other files. The parts of unchanged files stay.
    #[must_use]
    pub fn with(&self, trees: Trees) -> Self {
        let kept = |id: FileId| {
            let file = self.files.get(usize::try_from(id.0).ok()?)?;
            trees.shares(&self.trees, id).then(|| Arc::clone(file))
        };
        let files = trees.sources().iter();
        Self {
            files: files.map(|(id, _)| kept(id).unwrap_or_default()).collect(),
            trees,
        }
    }

    /// Returns the files as trees.
    #[must_use]
    pub fn trees(&self) -> &Trees {
        &self.trees
    }

    /// Returns the place of each declaration.
    #[must_use]
    pub fn definitions(&self) -> Definitions {
        Definitions::of_files(self.each(
            |file| &file.definitions,
            |id| self.trees.draft_of(id, definitions::of_file),
        ))
    }

    /// Returns all references.
    #[must_use]
    pub fn references(&self) -> References {
        References::of_files(self.each(
            |file| &file.references,
            |id| self.trees.tree(id).as_ref().map(references::of_file),
        ))
    }

    /// Computes one part of the index for each file.
    ///
    /// It uses all processors if several files are new. It computes a single new file directly, because other threads may be busy with a
    /// longer task.
    fn each<T: Default + Send + Sync>(
        &self,
        part: impl Fn(&FileIndex) -> &OnceLock<Arc<T>> + Sync,
        find: impl Fn(FileId) -> Option<T> + Sync,
    ) -> Vec<Arc<T>> {
        let ids = self.trees.sources().iter().map(|(id, _)| id);
        let files: Vec<_> = ids.zip(&self.files).collect();
        let found = |(id, file): &(FileId, &Arc<FileIndex>)| {
            let made = || Arc::new(find(*id).unwrap_or_default());
            Arc::clone(part(file).get_or_init(made))
        };
        let is_new = |(_, file): &&(FileId, &Arc<FileIndex>)| part(file).get().is_none();
        if files.iter().filter(is_new).nth(1).is_some() {
            files.par_iter().map(found).collect()
        } else {
            files.iter().map(found).collect()
        }
    }
}
