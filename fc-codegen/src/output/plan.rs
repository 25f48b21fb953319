//! Plans all changes on the disk before the first one.

use super::OutputError;
use super::disk;
use super::manifest::{MANIFEST, Manifest};
use super::path::resolve;
use crate::product::Artifact;
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// The planned changes on the disk. The lists are sorted by path. The manifest is in one of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    root: PathBuf,
    /// New files.
    pub created: Vec<StaleFile>,
    /// Generated files with other contents.
    pub updated: Vec<StaleFile>,
    /// Files that are up to date.
    pub unchanged: Vec<String>,
    /// Generated files that are no longer needed.
    pub orphaned: Vec<StaleFile>,
    /// Files in the places of artifacts that are not generated.
    pub foreign: Vec<String>,
}

/// A file that differs from its artifact, or that has no artifact.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StaleFile {
    /// The path, relative to the root.
    pub path: String,
    /// The contents on the disk; `None` for a new file.
    pub before: Option<Vec<u8>>,
    /// The new contents; `None` for a file to be removed.
    pub contents: Option<String>,
}

/// Compares artifacts with the disk below `root`. With `only`, the files and manifest entries of all other targets stay
/// unchanged. An empty `only` means all targets.
///
/// # Errors
/// All of [`OutputError`] except `Foreign`. The plan lists foreign files.
pub fn plan(artifacts: Vec<Artifact>, root: &Path, only: &[String]) -> Result<Plan, OutputError> {
    let chosen = |target: &str| only.is_empty() || only.iter().any(|name| name == target);
    let manifest_place = resolve(root, MANIFEST)?;
    let manifest_bytes = disk::read(&manifest_place, MANIFEST)?;
    let owned = match &manifest_bytes {
        Some(bytes) => Manifest::parse(&String::from_utf8_lossy(bytes))
            .map_err(|why| OutputError::Manifest { why })?,
        None => Manifest::default(),
    };

    let mut plan = Plan {
        root: root.to_owned(),
        created: Vec::new(),
        updated: Vec::new(),
        unchanged: Vec::new(),
        orphaned: Vec::new(),
        foreign: Vec::new(),
    };
    let mut next = Manifest::default();
    for (target, path) in owned.iter().filter(|(target, _)| !chosen(target)) {
        next.add(target, path);
    }

    let mut made: HashSet<String> = HashSet::from([MANIFEST.to_lowercase()]);
    for artifact in artifacts {
        let target = artifact.target.as_str();
        if !chosen(target) {
            continue;
        }
        let place = resolve(root, &artifact.path)?;
        if !made.insert(artifact.path.to_lowercase()) {
            return Err(OutputError::Duplicate {
                path: artifact.path,
            });
        }
        next.leave_to(target, &artifact.path);
        next.add(target, &artifact.path);
        let mine = owned.owns(&artifact.path);
        plan.compare(&place, artifact.path, artifact.contents, mine)?;
    }

    for (_, path) in owned.iter().filter(|(target, _)| chosen(target)) {
        let place = resolve(root, path)?;
        if !next.owns(path)
            && let Some(before) = disk::read(&place, path)?
        {
            plan.orphaned.push(StaleFile {
                path: path.to_owned(),
                before: Some(before),
                contents: None,
            });
        }
    }

    plan.compare(&manifest_place, MANIFEST.to_owned(), next.print(), true)?;
    plan.sort();
    Ok(plan)
}

impl Plan {
    /// Returns `true` if the disk is up to date.
    #[must_use]
    pub fn is_fresh(&self) -> bool {
        self.created.is_empty()
            && self.updated.is_empty()
            && self.orphaned.is_empty()
            && self.foreign.is_empty()
    }

    /// Updates the disk, and the manifest last.
    ///
    /// # Errors
    /// `Foreign`, before any change. After `Symlink` or `Io`, running again completes the work.
    pub fn write(&self) -> Result<(), OutputError> {
        if !self.foreign.is_empty() {
            return Err(OutputError::Foreign {
                paths: self.foreign.clone(),
            });
        }
        let changed = self.created.iter().chain(&self.updated);
        let (last, first): (Vec<_>, Vec<_>) = changed.partition(|file| file.path == MANIFEST);
        // Most of the time is spent in the system, which can do several writes at once.
        let replace = |file: &&StaleFile| {
            let StaleFile { path, contents, .. } = file;
            let contents = contents.as_deref().unwrap_or_default();
            disk::replace(&resolve(&self.root, path)?, path, contents.as_bytes())
        };
        first.par_iter().try_for_each(replace)?;
        for file in &self.orphaned {
            disk::remove(&self.root, &resolve(&self.root, &file.path)?, &file.path)?;
        }
        last.iter().try_for_each(replace)
    }

    /// Adds a file to its list.
    fn compare(
        &mut self,
        place: &Path,
        path: String,
        contents: String,
        mine: bool,
    ) -> Result<(), OutputError> {
        match disk::read(place, &path)? {
            Some(before) if before == contents.as_bytes() => self.unchanged.push(path),
            Some(_) if !mine => self.foreign.push(path),
            before => {
                let list = match before {
                    Some(_) => &mut self.updated,
                    None => &mut self.created,
                };
                list.push(StaleFile {
                    path,
                    before,
                    contents: Some(contents),
                });
            }
        }
        Ok(())
    }

    fn sort(&mut self) {
        for list in [&mut self.created, &mut self.updated, &mut self.orphaned] {
            list.sort_by(|a, b| a.path.cmp(&b.path));
        }
        self.unchanged.sort();
        self.foreign.sort();
    }
}
