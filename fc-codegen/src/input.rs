//! The input of the generator, for programs that wait for changes of it.

use crate::project::read_settings;
use crate::target::FILE;
use fc_spec::diagnostic::Faults;
use fc_spec::syntax::read_dir;
use std::path::Path;

/// The files of a spec and `fc.yaml` at one time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// Paths and texts, sorted by path.
    files: Vec<(String, String)>,
    /// The codes of errors in reading.
    faults: Vec<&'static str>,
}

/// The change of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileChange {
    /// The file is new.
    Added,
    /// The file has another text.
    Modified,
    /// The file no longer exists.
    Removed,
}

impl Input {
    /// Reads the input of a project. `spec` is relative to its root. Errors in reading are part of the input.
    #[must_use]
    pub fn read(root: &Path, spec: &Path) -> Self {
        let mut faults = Faults::new();
        let sources = read_dir(root, spec, &mut faults);
        let files = sources.iter();
        let mut files: Vec<_> = files
            .map(|(_, file)| (file.path.clone(), file.text.clone()))
            .collect();
        if let Ok(Some(text)) = read_settings(root) {
            files.push((FILE.to_owned(), text));
        }
        files.sort();
        Self {
            files,
            faults: faults.iter().map(|it| it.code.as_str()).collect(),
        }
    }

    /// Returns the paths of the files that differ from an earlier input, the removed ones last.
    #[must_use]
    pub fn changes_since<'i>(&'i self, earlier: &'i Self) -> Vec<(FileChange, &'i str)> {
        let new = self.files.iter().filter(|it| !earlier.files.contains(it));
        let new = new.map(|(path, _)| {
            if earlier.has(path) {
                (FileChange::Modified, path.as_str())
            } else {
                (FileChange::Added, path.as_str())
            }
        });
        let removed = earlier.files.iter().filter(|(path, _)| !self.has(path));
        let removed = removed.map(|(path, _)| (FileChange::Removed, path.as_str()));
        new.chain(removed).collect()
    }

    fn has(&self, path: &str) -> bool {
        self.files.iter().any(|(known, _)| known == path)
    }
}
