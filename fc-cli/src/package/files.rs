//! Files and directories of packages.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use toml_edit::DocumentMut;

use crate::input;
use crate::lang::said;
use crate::outcome::{Failure, unwritable};
use crate::project::slashed;

/// Creates a directory with its parents, and returns its path.
pub fn directory(path: &Path) -> Result<PathBuf, Failure> {
    fs::create_dir_all(path).map_err(unwritable(path))?;
    Ok(path.to_owned())
}

/// Writes a file.
pub fn write(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), Failure> {
    fs::write(path, contents).map_err(unwritable(path))
}

/// Returns the entries of a directory, sorted.
pub fn entries(directory: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = fs::read_dir(directory)?.map(|entry| Ok(entry?.path()));
    let mut entries: Vec<_> = entries.collect::<io::Result<_>>()?;
    entries.sort();
    Ok(entries)
}

/// Returns all files below a directory, sorted, as paths relative to it with `/` between their parts.
pub fn below(directory: &Path) -> Result<Vec<String>, Failure> {
    let mut found = Vec::new();
    let mut left = vec![directory.to_owned()];
    while let Some(next) = left.pop() {
        for path in entries(&next)? {
            if path.is_dir() {
                left.push(path);
                continue;
            }
            found.push(slashed(path.strip_prefix(directory)?));
        }
    }
    found.sort();
    Ok(found)
}

/// Returns the entry of a directory with this ending.
pub fn with_ending(directory: &Path, ending: &str) -> Result<PathBuf, Failure> {
    let mut found = entries(directory)?.into_iter();
    let ends = |path: &PathBuf| path.to_string_lossy().ends_with(ending);
    found.find(ends).ok_or_else(|| {
        let directory = directory.display();
        said!(
            "`{directory}` 中没有 `{ending}`",
            "`{directory}` has no `{ending}`"
        )
        .into()
    })
}

/// Replaces the version of a package in a table of its TOML file. `version` gets the present number.
pub fn set_toml_version(
    file: &Path,
    table: &str,
    version: impl FnOnce(&str) -> Result<String, Failure>,
) -> Result<String, Failure> {
    let text = input::file(file)?;
    let mut document: DocumentMut = text.parse()?;
    let number = document.get(table).and_then(|it| it.get("version"));
    let Some(number) = number.and_then(|it| it.as_str()) else {
        let file = file.display();
        return Err(said!(
            "`{file}` 的 `[{table}]` 中没有 `version`",
            "`[{table}]` of `{file}` has no `version`"
        )
        .into());
    };
    let version = version(number)?;
    if let Some(table) = document.get_mut(table) {
        *table = with_version(table.clone(), &version);
    }
    write(file, document.to_string())?;
    Ok(version)
}

/// Returns a table with this version.
fn with_version(mut table: toml_edit::Item, version: &str) -> toml_edit::Item {
    if let Some(table) = table.as_table_like_mut() {
        table.insert("version", toml_edit::value(version));
    }
    table
}
