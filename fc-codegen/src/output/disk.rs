//! Reads, replaces and removes single files.

use super::OutputError;
use std::fs::{self, OpenOptions};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

/// The byte order mark of a UTF-8 file.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// The maximum number of further names that are tried for a temporary file.
const ATTEMPTS: u32 = 100;

/// Returns the contents of a file, or `None` if it does not exist. Refuses pipes, because opening one would wait for a
/// writer.
pub fn read(place: &Path, path: &str) -> Result<Option<Vec<u8>>, OutputError> {
    if fs::metadata(place).is_ok_and(|found| !found.is_file()) {
        let path = path.to_owned();
        return Err(OutputError::NotAFile { path });
    }
    match fs::read(place) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(fault("read", path, source)),
    }
}

/// Replaces the text of a file that people edit. Keeps its byte order mark and a link to it.
pub fn edit(place: &Path, path: &str, text: &str) -> Result<(), OutputError> {
    let place = match fs::canonicalize(place) {
        Ok(place) => place,
        Err(error) if error.kind() == io::ErrorKind::NotFound => place.to_owned(),
        Err(source) => return Err(fault("write", path, source)),
    };
    let mut start = [0; BYTE_ORDER_MARK.len()];
    let has_mark = fs::File::open(&place)
        .and_then(|mut file| file.read_exact(&mut start))
        .is_ok_and(|()| start == BYTE_ORDER_MARK);
    let mark = if has_mark { BYTE_ORDER_MARK } else { b"" };
    replace(&place, path, &[mark, text.as_bytes()].concat())
}

/// Replaces a file atomically: writes a temporary file in the same directory, then renames it.
pub fn replace(place: &Path, path: &str, contents: &[u8]) -> Result<(), OutputError> {
    if let Some(folder) = place.parent() {
        fs::create_dir_all(folder).map_err(|source| fault("create the folder of", path, source))?;
    }
    let (temporary, mut file) = temporary(place).map_err(|source| fault("write", path, source))?;
    let written = file.write_all(contents).and_then(|()| {
        drop(file);
        if let Ok(before) = fs::metadata(place) {
            fs::set_permissions(&temporary, before.permissions())?;
        }
        fs::rename(&temporary, place)
    });
    written.map_err(|source| {
        // The first error is reported.
        let _ = fs::remove_file(&temporary);
        fault("write", path, source)
    })
}

/// Creates a new file in the directory of `place`.
fn temporary(place: &Path) -> io::Result<(PathBuf, fs::File)> {
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    let mut attempt = 0;
    loop {
        let candidate = place.with_file_name(format!(".{name}.{attempt}.tmp"));
        match OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&candidate)
        {
            Ok(file) => return Ok((candidate, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && attempt < ATTEMPTS => {
                attempt += 1;
            }
            Err(error) => return Err(error),
        }
    }
}

/// Removes a file, and the folders below the root that become empty.
pub fn remove(root: &Path, place: &Path, path: &str) -> Result<(), OutputError> {
    match fs::remove_file(place) {
        Ok(()) => {}
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        Err(source) => return Err(fault("remove", path, source)),
    }
    let mut folder = place.parent();
    while let Some(place) = folder
        && place != root
        && fs::remove_dir(place).is_ok()
    {
        folder = place.parent();
    }
    Ok(())
}

fn fault(action: &'static str, path: &str, source: io::Error) -> OutputError {
    OutputError::Io {
        action,
        path: path.to_owned(),
        source,
    }
}
