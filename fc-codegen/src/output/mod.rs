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
pub use manifest::MANIFEST;
pub use plan::{NewFile, OldFile, Plan, UpdatedFile, plan};

use std::path::Path;

/// Replaces the text of a spec file; nobody ever sees half of it. `path` leads there from `root`.
///
/// # Errors
/// If it cannot be written.
pub fn replace_spec_file(root: &Path, path: &str, text: &str) -> Result<(), OutputError> {
    disk::replace(&root.join(path), path, text.as_bytes())
}
