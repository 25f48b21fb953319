//! Checks that paths stay below the root.

use super::OutputError;
use fc_spec::text;
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the place of a root-relative path, if the path is plain and no part of it is a symbolic link.
///
/// # Errors
/// `BadPath`, `Symlink`.
pub fn resolve(root: &Path, path: &str) -> Result<PathBuf, OutputError> {
    check(path)?;
    let mut place = root.to_owned();
    for part in path.split('/') {
        place.push(part);
        if fs::symlink_metadata(&place).is_ok_and(|found| found.is_symlink()) {
            let link = place.strip_prefix(root).unwrap_or(&place);
            return Err(OutputError::Symlink {
                path: link.to_string_lossy().replace('\\', "/"),
            });
        }
    }
    Ok(place)
}

/// Returns `Ok` if a path names a file below the root on every system.
fn check(path: &str) -> Result<(), OutputError> {
    let mut parts = path.split('/');
    let bad_part = parts.find(|part| matches!(*part, "" | "." | ".."));
    let why = if path.is_empty() {
        text!("路径为空", "it is empty")
    } else if path.starts_with('/') {
        text!(
            "必须是相对于根目录的路径",
            "it must be relative to the root"
        )
    } else if path.contains(['\\', ':', '\0']) {
        text!(
            "不能含有 `\\`、`:` 或 NUL",
            "it must not contain `\\`, `:` or NUL"
        )
    } else {
        match bad_part {
            None => return Ok(()),
            Some("") => text!("路径中有空的一段", "it has an empty part"),
            Some(_) => text!("不能含有 `.` 或 `..`", "it must not contain `.` or `..`"),
        }
    };
    let path = path.to_owned();
    Err(OutputError::BadPath { path, why })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_plain_relative_paths() {
        for good in ["a", "a/b.rs", "en/参考/a.md", "a/..b"] {
            assert!(check(good).is_ok(), "{good}");
        }
        for bad in [
            "",
            "/a",
            "a//b",
            "a/",
            "./a",
            "../a",
            "a/../../b",
            r"a\b",
            "C:a",
            "a\0b",
        ] {
            assert!(
                matches!(check(bad), Err(OutputError::BadPath { .. })),
                "{bad:?}"
            );
        }
    }
}
