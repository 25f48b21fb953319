//! What keeps output from being written.

use super::manifest::MANIFEST;
use std::io;

/// What keeps output from being written. Unless it is an [`Io`](Self::Io) fault half-way, nothing
/// has been changed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// An artifact or the manifest names a path that may lead out of the root.
    #[error("`{path}` cannot be written: {why}")]
    BadPath {
        /// The path.
        path: String,
        /// What is wrong with it.
        why: &'static str,
    },
    /// Two artifacts have one path, or paths that differ in case alone.
    #[error("two artifacts are called `{path}`; rename one of the things they are made from")]
    Duplicate {
        /// The path of the second.
        path: String,
    },
    /// A part of a path below the root is a symbolic link.
    #[error("`{path}` is a symbolic link; replace it by what it points to, or delete it")]
    Symlink {
        /// The link.
        path: String,
    },
    /// Files stand where artifacts belong, hold something else, and are not the generator's.
    #[error(
        "{} would have to be overwritten, but `{MANIFEST}` does not list {}: move or delete {} and \
         run `fc generate` again",
        list(.paths),
        if .paths.len() == 1 { "it" } else { "them" },
        if .paths.len() == 1 { "it" } else { "them" },
    )]
    Foreign {
        /// Their paths, sorted.
        paths: Vec<String>,
    },
    /// The manifest cannot be read.
    #[error(
        "`{MANIFEST}` cannot be read: {why}. Restore it from version control, or delete it: \
         generated files that are up to date are then taken over, others have to be deleted first"
    )]
    Manifest {
        /// What is wrong with it.
        why: String,
    },
    /// The operating system refused.
    #[error("cannot {action} `{path}`: {source}")]
    Io {
        /// What was tried, as a verb.
        action: &'static str,
        /// On which path.
        path: String,
        /// Its reason.
        source: io::Error,
    },
}

/// Up to three paths by name, the rest by number.
fn list(paths: &[String]) -> String {
    let named: Vec<String> = paths
        .iter()
        .take(3)
        .map(|path| format!("`{path}`"))
        .collect();
    let rest = paths.len().saturating_sub(named.len());
    if rest == 0 {
        named.join(", ")
    } else {
        format!("{} and {rest} more", named.join(", "))
    }
}
