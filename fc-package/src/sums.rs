//! The list of all files with their checksums, in the format of `sha256sum`.

use crate::error::{PackError, unwritable};
use crate::files;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// The name of the list.
const FILE: &str = "SHA256SUMS";

/// Returns the digest of bytes in hexadecimal.
pub fn hex<D: Digest>(bytes: &[u8]) -> String {
    let mut text = String::new();
    for byte in D::digest(bytes) {
        // Writing to a String cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

/// Returns the SHA-256 of a file in hexadecimal.
pub fn of_file(path: &Path) -> Result<String, PackError> {
    Ok(hex::<Sha256>(&fs::read(path)?))
}

/// Replaces the files of a language by those of another directory. Returns their paths relative to `out`.
///
/// Files that the list does not name stay.
pub fn replace(out: &Path, language: &str, made: &Path) -> Result<Vec<String>, PackError> {
    let list = out.join(FILE);
    let text = files::read_if_there(&list)?.unwrap_or_default();
    let lines = text.lines().filter_map(|line| line.split_once("  "));
    let mut sums: BTreeMap<String, String> = lines
        .map(|(sum, path)| (path.to_owned(), sum.to_owned()))
        .collect();
    let prefix = format!("{language}/");
    let mut old: Vec<_> = sums.keys().cloned().collect();
    old.retain(|path| path.starts_with(&prefix) && !path.split('/').any(|it| it == ".."));
    sums.retain(|path, _| !path.starts_with(&prefix));
    let mut listed = Vec::new();
    for path in files::below(made)? {
        let from = made.join(&path);
        let path = format!("{prefix}{path}");
        let to = out.join(&path);
        if let Some(parent) = to.parent() {
            files::directory(parent)?;
        }
        sums.insert(path.clone(), of_file(&from)?);
        fs::rename(&from, &to).map_err(unwritable(&to))?;
        listed.push(path);
    }
    for path in old.iter().filter(|path| !listed.contains(path)) {
        remove(out, path)?;
    }
    let lines = sums.iter().map(|(path, sum)| format!("{sum}  {path}\n"));
    files::write(&list, lines.collect::<String>())?;
    Ok(listed)
}

/// Removes a file if it exists, and its directories once they are empty.
fn remove(out: &Path, path: &str) -> Result<(), PackError> {
    let file = out.join(path);
    match fs::remove_file(&file) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            return Err(unwritable(&file)(error));
        }
        _ => {}
    }
    let above = file.ancestors().skip(1).take_while(|it| *it != out);
    for directory in above {
        if fs::remove_dir(directory).is_err() {
            break;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replace_removes_only_listed_files_of_a_language() -> Result<(), PackError> {
        let root = tempfile::tempdir()?;
        let out = files::directory(&root.path().join("out"))?;
        let made = files::directory(&root.path().join("made"))?;
        let listed = ["cpp/a", "rust/../../outside", "rust/old/a"];
        for path in listed.into_iter().chain(["rust/note"]) {
            files::directory(out.join(path).parent().unwrap_or(&out))?;
            files::write(&out.join(path), "")?;
        }
        let lines = listed.map(|path| format!("0  {path}\n"));
        files::write(&out.join(FILE), lines.concat())?;
        files::write(&made.join("new"), "new")?;

        assert_eq!(replace(&out, "rust", &made)?, ["rust/new"]);
        let left = ["SHA256SUMS", "cpp/a", "rust/new", "rust/note"];
        assert_eq!(files::below(&out)?, left);
        assert!(!out.join("rust/old").exists());
        assert!(root.path().join("outside").exists());
        let sum = hex::<Sha256>(b"new");
        let list = format!("0  cpp/a\n{sum}  rust/new\n");
        assert_eq!(files::read(&out.join(FILE))?, list);
        Ok(())
    }
}
