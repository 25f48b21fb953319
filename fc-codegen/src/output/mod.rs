//! The only writer of generated files: compares artifacts with the disk, then updates the disk.
//!
//! **Architecture invariant.** A file belongs to the generator only if its manifest lists it: `fc-manifest.json` at the
//! project's root. The writer never changes other files. It removes listed files that are no longer generated, and does
//! not touch files that are up to date. It writes only inside the root, and never through a symbolic link.
//!
//! ```
//! use fc_codegen::product::Artifact;
//! use fc_codegen::output::plan;
//!
//! # let root = tempfile::tempdir()?;
//! # let root = root.path();
//! let hello = Artifact { target: "rust".into(), path: "a/b.rs".into(), contents: "// hello\n".into() };
//! let plan = plan(vec![hello.clone()], root, &[])?;
//! assert_eq!(plan.created.len(), 2); // the file and the manifest
//! plan.write()?;
//!
//! let again = fc_codegen::output::plan(vec![hello], root, &[])?;
//! assert!(again.is_fresh());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod diff;
mod disk;
mod error;
mod manifest;
mod path;
mod plan;

pub use diff::{FileDiff, unified};
pub use error::OutputError;
pub use manifest::{MANIFEST, merge_manifests};
pub use plan::{Plan, StaleFile, plan};

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Returns the paths of the generated files, relative to `root`, each once.
///
/// # Errors
/// If the manifest cannot be read.
pub fn generated(root: &Path) -> Result<Vec<String>, OutputError> {
    let bytes = disk::read(&path::resolve(root, MANIFEST)?, MANIFEST)?;
    let text = bytes.unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    if text.is_empty() {
        return Ok(Vec::new());
    }
    let manifest = manifest::Manifest::parse(&text).map_err(|why| OutputError::Manifest { why })?;
    let paths: BTreeSet<&str> = manifest.iter().map(|(_, path)| path).collect();
    Ok(paths.into_iter().map(str::to_owned).collect())
}

/// Returns the outermost directory around a path that contains only generated files. All paths are relative to `root`.
#[must_use]
pub fn generated_directory<'p>(
    root: &Path,
    path: &'p str,
    generated: &BTreeSet<String>,
) -> Option<&'p str> {
    let ends = path.match_indices('/').map(|(at, _)| at);
    let mut above = ends.filter_map(|at| path.get(..at));
    above.find(|directory| has_only(root, directory, generated))
}

/// Returns `true` if a directory contains only these files.
fn has_only(root: &Path, directory: &str, files: &BTreeSet<String>) -> bool {
    let Ok(entries) = fs::read_dir(root.join(directory)) else {
        return false;
    };
    entries.into_iter().all(|entry| {
        let Ok(entry) = entry else { return false };
        let path = format!("{directory}/{}", entry.file_name().to_string_lossy());
        if entry.file_type().is_ok_and(|it| it.is_dir()) {
            has_only(root, &path, files)
        } else {
            files.contains(&path)
        }
    })
}

/// Replaces the text of a spec file atomically. `path` is relative to `root`.
///
/// The file keeps its byte order mark, which `text` does not have. If the path is a link, its target is replaced.
///
/// # Errors
/// If the file cannot be written.
pub fn replace_spec_file(root: &Path, path: &str, text: &str) -> Result<(), OutputError> {
    disk::edit(&root.join(path), path, text)
}
