//! The project of a command, and paths in it.

use std::path::{Path, PathBuf};

pub use fc_codegen::project::{Project, is_there};

/// Returns the path from the repository to the project's root, with `/` as separator. It is empty if they are the same.
/// Code hosts need paths from the repository to show annotations. Without a repository, the path is relative to the
/// current directory.
pub fn in_repository(root: &Path) -> String {
    // Canonical paths have no links and no `..`, so that prefixes can be compared.
    let Ok(root) = root.canonicalize() else {
        return String::new();
    };
    let workspace = std::env::var_os("GITHUB_WORKSPACE").map(PathBuf::from);
    let workspace = workspace.and_then(|path| path.canonicalize().ok());
    let repository = workspace
        .filter(|path| root.starts_with(path))
        .or_else(|| {
            let mut above = root.ancestors();
            let found = above.find(|path| path.join(".git").exists());
            found.map(PathBuf::from)
        })
        .or_else(|| std::env::current_dir().ok()?.canonicalize().ok());
    let below = repository.and_then(|path| Some(slashed(root.strip_prefix(path).ok()?)));
    below.unwrap_or_default()
}

/// Returns a path with `/` as separator.
pub fn slashed(path: &Path) -> String {
    let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
    parts.join("/")
}
