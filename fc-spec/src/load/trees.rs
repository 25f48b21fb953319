//! The files of a spec as trees, which stay while other files change.

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

/// The files of a spec as trees: what reads a spec again and again, such as an editor's server, reads of the files that have
/// not changed what it has read before.
#[derive(Clone, Debug, Default)]
pub struct Trees {
    sources: Sources,
    files: Vec<Arc<File>>,
}

/// A file, and what has been found out about it by itself.
struct File {
    source: Arc<SourceFile>,
    /// Without its text.
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
    /// Of these files.
    #[must_use]
    pub fn new(sources: &Sources) -> Self {
        Self::default().with(sources)
    }

    /// Of these files, of which those that are the same as here are not parsed again.
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

    /// The files.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    fn file(&self, id: FileId) -> Option<&Arc<File>> {
        self.files.get(usize::try_from(id.0).ok()?)
    }

    /// The tree of a file; `None` of one that [`parse`](crate::syntax::parse) makes none of.
    #[must_use]
    pub fn tree(&self, file: FileId) -> Option<Tree<'_>> {
        let file = self.file(file).filter(|file| file.is_whole)?;
        Some(file.tree.as_ref()?.over(&file.source.text))
    }

    /// What the spec says, as far as it can be read, and all of its faults. Each text has to be in these languages.
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

    /// Hands on the draft of one file alone; `None` if it has no tree.
    pub(crate) fn draft_of<T>(&self, id: FileId, then: impl FnOnce(&Draft<'_>) -> T) -> Option<T> {
        let parsed = self.file(id)?.parsed()?;
        let sections = section::of_file(&parsed);
        Some(then(&lower::lower(
            &sections,
            &self.sources,
            Languages::Any,
        )))
    }

    /// Those files of which there are trees, and what is wrong with each and with the others; and whether there are no
    /// others.
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

/// Makes something of each file, on all processors. What is to be made of one alone is not handed to other threads, which
/// may be busy with something longer.
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

    /// Whether it is this file with this text.
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
