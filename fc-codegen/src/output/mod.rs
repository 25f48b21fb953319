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

/// Replaces the text of a spec file atomically. `path` is relative to `root`.
///
/// The file keeps its byte order mark, which `text` does not have. If the path is a link, its target is replaced.
///
/// # Errors
/// If the file cannot be written.
pub fn replace_spec_file(root: &Path, path: &str, text: &str) -> Result<(), OutputError> {
    disk::edit(&root.join(path), path, text)
}
