//! Keeps the files of a spec as trees while other files change.

use super::draft::Draft;
use super::section::Parsed;
use super::{Loaded, check, lower, partial, read, section};
use crate::diagnostic::Faults;
use crate::model::Languages;
use crate::source::{FileId, SourceFile, Sources};
use crate::syntax::{Tree, parse_parts};
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use std::fmt;
use std::sync::Arc;

/// The files of a spec as trees. A long-running reader, such as a language server, parses only the changed files again.
#[derive(Clone, Debug, Default)]
pub struct Trees {
    sources: Sources,
    files: Vec<Arc<File>>,
}

/// A parsed file and its own errors.
struct File {
    source: Arc<SourceFile>,
    /// The tree without the text of the file.
    tree: Option<Tree<'static>>,
    is_whole: bool,
    faults: Faults,
}

impl fmt::Debug for File {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.source.path)
    }
}

impl Trees {
    /// Parses the files.
    #[must_use]
    pub fn new(sources: &Sources) -> Self {
        Self::default().with(sources)
    }

    /// Returns the trees of these files. Does not parse unchanged files again.
    #[must_use]
    pub fn with(&self, sources: &Sources) -> Self {
        let all = sources.iter().filter_map(|(id, _)| {
            let source = sources.shared(id)?;
            let known = self.file(id).filter(|file| file.is_of(source));
            Some((id, source, known))
        });
        let all: Vec<_> = all.collect();
        let new: Vec<_> = all.iter().filter(|(.., known)| known.is_none()).collect();
        let new = together(&new, |(id, source, _)| Arc::new(File::new(*id, source)));
        let mut new = new.into_iter();
        let known = all.iter().map(|(.., known)| known.map(Arc::clone));
        Self {
            sources: sources.clone(),
            files: known
                .filter_map(|known| known.or_else(|| new.next()))
                .collect(),
        }
    }

    /// Returns the files.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    fn file(&self, id: FileId) -> Option<&Arc<File>> {
        self.files.get(usize::try_from(id.0).ok()?)
    }

    /// Returns the tree of a file; `None` if [`parse`](crate::syntax::parse) returns none.
    #[must_use]
    pub fn tree(&self, file: FileId) -> Option<Tree<'_>> {
        let file = self.file(file).filter(|file| file.is_whole)?;
        Some(file.tree.as_ref()?.over(&file.source.text))
    }

    /// Reads the spec: returns everything readable and adds all errors to `faults`. Each text must be in the languages
    /// `texts`.
    #[must_use]
    pub fn load(&self, texts: Languages, faults: &mut Faults) -> Loaded {
        read(self, texts, faults, |draft, whole, faults| {
            check::check(&draft, &self.sources, whole, faults);
            partial::build(draft, whole, !faults.has_errors())
        })
    }

    /// Returns `true` if a file of these was not parsed again since `other`.
    pub(crate) fn shares(&self, other: &Self, id: FileId) -> bool {
        match (self.file(id), other.file(id)) {
            (Some(own), Some(other)) => Arc::ptr_eq(own, other),
            _ => false,
        }
    }

    /// Passes the draft of one file to `then`; `None` if the file has no tree.
    pub(crate) fn draft_of<T>(&self, id: FileId, then: impl FnOnce(&Draft<'_>) -> T) -> Option<T> {
        let parsed = self.file(id)?.parsed()?;
        let sections = section::of_file(&parsed);
        Some(then(&lower::lower(
            &sections,
            &self.sources,
            Languages::Any,
        )))
    }

    /// Returns the files with a tree, and `true` if every file has one. Adds the errors of all files to `faults`.
    pub(super) fn parsed(&self, faults: &mut Faults) -> (Vec<Parsed<'_>>, bool) {
        let mut whole = true;
        let mut parsed = Vec::new();
        for file in &self.files {
            faults.append(file.faults.clone());
            match file.parsed() {
                Some(file) => parsed.push(file),
                None => whole = false,
            }
        }
        (parsed, whole)
    }
}

/// Maps the files in parallel. Keeps a single file on this thread, because the other threads may have longer tasks.
fn together<F: Sync, T: Send>(files: &[F], make: impl Fn(&F) -> T + Send + Sync) -> Vec<T> {
    if files.len() > 1 {
        files.par_iter().map(make).collect()
    } else {
        files.iter().map(make).collect()
    }
}

impl File {
    fn new(id: FileId, source: &Arc<SourceFile>) -> Self {
        let mut faults = Faults::new();
        let (tree, is_whole) = if source.whole {
            parse_parts(id, &source.text, &mut faults)
        } else {
            (None, false)
        };
        Self {
            source: Arc::clone(source),
            tree: tree.map(Tree::bare),
            is_whole,
            faults,
        }
    }

    /// Returns `true` if the source is this file with the same text.
    fn is_of(&self, source: &Arc<SourceFile>) -> bool {
        let own = &self.source;
        Arc::ptr_eq(own, source)
            || own.path == source.path && own.whole == source.whole && own.text == source.text
    }

    fn parsed(&self) -> Option<Parsed<'_>> {
        Some(Parsed {
            path: &self.source.path,
            tree: self.tree.as_ref()?.over(&self.source.text),
            gaps: self.faults.gaps(),
            is_whole: self.is_whole,
        })
    }
}
