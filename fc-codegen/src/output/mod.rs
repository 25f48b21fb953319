//! The only writer: compares artifacts with the disk, then makes the disk agree.
//!
//! **Architecture invariant.** A file belongs to the generator only if its manifest,
//! `fc-manifest.json` at the project's root, says so. It never changes another file, removes those
//! of its own that are no longer made, and leaves what is right alone, times included. Nothing is
//! written outside the root, and nothing through a symbolic link.
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
pub use plan::{NewFile, OldFile, Plan, UpdatedFile, plan};

use std::collections::BTreeSet;
use std::path::Path;

/// Paths of the files below `root` that are the generator's, from there, each once.
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

/// Replaces the text of a spec file; nobody ever sees half of it. `path` leads there from `root`.
///
/// The file keeps its byte order mark, which `text` does not have. A link stays, and the file that it leads to changes.
///
/// # Errors
/// If it cannot be written.
pub fn replace_spec_file(root: &Path, path: &str, text: &str) -> Result<(), OutputError> {
    disk::edit(&root.join(path), path, text)
}
