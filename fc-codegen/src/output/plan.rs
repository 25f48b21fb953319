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
    pub created: Vec<NewFile>,
    /// Generated files with other contents.
    pub updated: Vec<UpdatedFile>,
    /// Files that are up to date.
    pub unchanged: Vec<String>,
    /// Generated files that are no longer needed.
    pub orphaned: Vec<OldFile>,
    /// Files in the places of artifacts that are not generated.
    pub foreign: Vec<String>,
}

/// A new file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NewFile {
    /// The path, relative to the root.
    pub path: String,
    /// The contents.
    pub contents: String,
}

/// A file to be overwritten.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UpdatedFile {
    /// The path, relative to the root.
    pub path: String,
    /// The contents on the disk.
    pub before: Vec<u8>,
    /// The new contents.
    pub contents: String,
}

/// A file to be removed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OldFile {
    /// The path, relative to the root.
    pub path: String,
    /// The contents on the disk.
    pub before: Vec<u8>,
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
            plan.orphaned.push(OldFile {
                path: path.to_owned(),
                before,
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
        let created = self.created.iter().map(|file| (&file.path, &file.contents));
        let updated = self.updated.iter().map(|file| (&file.path, &file.contents));
        let (last, first): (Vec<_>, Vec<_>) = created
            .chain(updated)
            .partition(|(path, _)| *path == MANIFEST);
        // Most of the time is spent in the system, which can do several writes at once.
        let replace = |&(path, contents): &(&String, &String)| {
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
            None => self.created.push(NewFile { path, contents }),
            Some(before) if before == contents.as_bytes() => self.unchanged.push(path),
            Some(before) if mine => self.updated.push(UpdatedFile {
                path,
                before,
                contents,
            }),
            Some(_) => self.foreign.push(path),
        }
        Ok(())
    }

    fn sort(&mut self) {
        self.created.sort_by(|a, b| a.path.cmp(&b.path));
        self.updated.sort_by(|a, b| a.path.cmp(&b.path));
        self.unchanged.sort();
        self.orphaned.sort_by(|a, b| a.path.cmp(&b.path));
        self.foreign.sort();
    }
}
