//! Files and directories of packages.

use crate::error::{LONGEST, PackError, unreadable, unwritable};
use std::fs;
use std::io::{self, ErrorKind, Read as _};
use std::path::{Path, PathBuf};
use toml_edit::DocumentMut;

/// Creates a directory with its parents, and returns its path.
pub fn directory(path: &Path) -> Result<PathBuf, PackError> {
    fs::create_dir_all(path).map_err(unwritable(path))?;
    Ok(path.to_owned())
}

/// Writes a file.
pub fn write(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), PackError> {
    fs::write(path, contents).map_err(unwritable(path))
}

/// Reads a text without its byte order mark. Opening a pipe would wait for its writer, so pipes are refused.
pub fn read(path: &Path) -> Result<String, PackError> {
    if path.metadata().is_ok_and(|found| !found.is_file()) {
        return Err(PackError::NotAFile(path.to_owned()));
    }
    let mut bytes = Vec::new();
    let file = fs::File::open(path).map_err(unreadable(path))?;
    // The extra byte shows that the file is too large.
    let read = file.take(LONGEST + 1).read_to_end(&mut bytes);
    read.map_err(unreadable(path))?;
    if u64::try_from(bytes.len()).is_ok_and(|length| length > LONGEST) {
        return Err(PackError::TooLarge(path.to_owned()));
    }
    let text = String::from_utf8(bytes).map_err(|_| PackError::NotUtf8(path.to_owned()))?;
    let without_mark = text.strip_prefix('\u{feff}').map(str::to_owned);
    Ok(without_mark.unwrap_or(text))
}

/// Reads a text, or returns `None` if nothing is at the path. A link to nothing is an error.
pub fn read_if_there(path: &Path) -> Result<Option<String>, PackError> {
    match path.symlink_metadata() {
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            Ok(None)
        }
        // With another error, the path may exist without being readable.
        _ => read(path).map(Some),
    }
}

/// Returns the entries of a directory, sorted.
pub fn entries(directory: &Path) -> Result<Vec<PathBuf>, PackError> {
    let entries = fs::read_dir(directory)?.map(|entry| Ok(entry?.path()));
    let mut entries: Vec<_> = entries.collect::<io::Result<_>>()?;
    entries.sort();
    Ok(entries)
}

/// Returns all files below a directory, sorted, as paths relative to it with `/` between their parts.
pub fn below(directory: &Path) -> Result<Vec<String>, PackError> {
    let mut found = Vec::new();
    let mut left = vec![directory.to_owned()];
    while let Some(next) = left.pop() {
        for path in entries(&next)? {
            if path.is_dir() {
                left.push(path);
                continue;
            }
            let relative = path.strip_prefix(directory).unwrap_or(&path);
            let parts: Vec<_> = relative.iter().map(|it| it.to_string_lossy()).collect();
            found.push(parts.join("/"));
        }
    }
    found.sort();
    Ok(found)
}

/// Returns the entry of a directory with this ending.
pub fn with_ending(directory: &Path, ending: &str) -> Result<PathBuf, PackError> {
    let mut found = entries(directory)?.into_iter();
    let ends = |path: &PathBuf| path.to_string_lossy().ends_with(ending);
    found.find(ends).ok_or_else(|| PackError::NoResult {
        directory: directory.to_owned(),
        ending: ending.to_owned(),
    })
}

/// Replaces the version of a package in a table of its TOML file. `version` gets the present number.
pub fn set_toml_version(
    file: &Path,
    table: &str,
    version: impl FnOnce(&str) -> Result<String, PackError>,
) -> Result<String, PackError> {
    let mut document: DocumentMut = read(file)?.parse()?;
    let number = document.get(table).and_then(|it| it.get("version"));
    let Some(number) = number.and_then(|it| it.as_str()) else {
        return Err(PackError::NoVersion {
            file: file.to_owned(),
            table: table.to_owned(),
        });
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
