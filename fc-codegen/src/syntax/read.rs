//! From the disk to [`Sources`].

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::{SourceFile, Sources, Span, limits};
use crate::diagnostic::{Diagnostic, FaultCode, Faults};

/// The directory below the spec's own in which command groups stand.
const GROUPS: &str = "commands";

/// Reads every `*.yaml` directly in `root/spec` and in `root/spec/commands`, sorted by path.
///
/// Names that start with a dot are left alone. Whatever cannot be read becomes a fault, and a file
/// of the result that is not [`whole`](SourceFile::whole); no file is read beyond its limit.
///
/// **Architecture invariant.** This and the output module alone touch the disk.
pub fn read_dir(root: &Path, spec: &Path, faults: &mut Faults) -> Sources {
    let mut found = Vec::new();
    let top = Directory::new(root, spec);
    top.list(true, &mut found);
    found.sort_by(|a, b| a.path.cmp(&b.path));

    let mut sources = Sources::new();
    let mut budget = Budget {
        files: limits::FILES,
        bytes: limits::SPEC_BYTES,
    };
    for item in found {
        match item.found {
            Found::Spec(disk) => budget.read(item.path, &disk, &mut sources, faults),
            Found::Stray(advice) => {
                let message = format!("`{}` is not read as a part of the spec", item.path);
                refuse(
                    FaultCode::StrayFile,
                    item.path,
                    message,
                    &advice,
                    &mut sources,
                    faults,
                );
            }
            Found::Error(error) => {
                let message = format!("cannot read `{}`: {error}", item.path);
                refuse(
                    FaultCode::Unreadable,
                    item.path,
                    message,
                    "",
                    &mut sources,
                    faults,
                );
            }
        }
    }
    sources
}

/// Something in the spec's directories.
struct Item {
    path: String,
    found: Found,
}

enum Found {
    /// A file of the spec.
    Spec(PathBuf),
    /// A file that someone may take for one; what to do about it.
    Stray(String),
    /// What cannot be looked at.
    Error(io::Error),
}

struct Directory {
    disk: PathBuf,
    path: String,
}

impl Directory {
    fn new(root: &Path, spec: &Path) -> Self {
        let disk = root.join(spec);
        let shown = disk.strip_prefix(root).unwrap_or(&disk);
        let parts: Vec<_> = shown.iter().map(|part| part.to_string_lossy()).collect();
        Self {
            path: parts.join("/"),
            disk,
        }
    }

    fn below(&self, name: &str) -> Self {
        Self {
            disk: self.disk.join(name),
            path: self.child(name),
        }
    }

    fn child(&self, name: &str) -> String {
        if self.path.is_empty() {
            name.to_owned()
        } else {
            format!("{}/{name}", self.path)
        }
    }

    /// Lists the spec files of this directory, and of `commands` where this is the `top`.
    fn list(&self, top: bool, found: &mut Vec<Item>) {
        self.each(found, |name, is_dir, found| {
            if !is_dir {
                found.extend(self.file(name));
            } else if top && name == GROUPS {
                self.below(name).list(false, found);
            } else {
                self.below(name).strays(found);
            }
        });
    }

    /// A file directly in a spec directory.
    fn file(&self, name: &str) -> Option<Item> {
        let (stem, extension) = name.rsplit_once('.')?;
        let found = match extension {
            "yaml" => Found::Spec(self.disk.join(name)),
            _ if is_yaml(name) => Found::Stray(format!("name it `{stem}.yaml`")),
            _ => return None,
        };
        Some(Item {
            path: self.child(name),
            found,
        })
    }

    /// YAML files in a directory that the spec does not look into.
    fn strays(&self, found: &mut Vec<Item>) {
        self.each(found, |name, is_dir, found| {
            if !is_dir && is_yaml(name) {
                found.push(Item {
                    path: self.child(name),
                    found: Found::Stray(format!(
                        "move it into the spec's own directory or into `{GROUPS}` below it"
                    )),
                });
            }
        });
    }

    fn each(&self, found: &mut Vec<Item>, mut visit: impl FnMut(&str, bool, &mut Vec<Item>)) {
        let entries = match fs::read_dir(&self.disk) {
            Ok(entries) => entries,
            Err(error) => return found.push(self.error(error)),
        };
        for entry in entries {
            let entry = match entry {
                Ok(entry) => entry,
                Err(error) => return found.push(self.error(error)),
            };
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if !name.starts_with('.') {
                // Through links, so that a linked file or directory counts as what it links to.
                let is_dir = fs::metadata(entry.path()).is_ok_and(|meta| meta.is_dir());
                visit(&name, is_dir, found);
            }
        }
    }

    fn error(&self, error: io::Error) -> Item {
        Item {
            path: self.path.clone(),
            found: Found::Error(error),
        }
    }
}

fn is_yaml(name: &str) -> bool {
    name.rsplit_once('.').is_some_and(|(_, extension)| {
        extension.eq_ignore_ascii_case("yaml") || extension.eq_ignore_ascii_case("yml")
    })
}

/// What may still be read.
struct Budget {
    files: usize,
    bytes: usize,
}

impl Budget {
    fn read(&mut self, path: String, disk: &Path, sources: &mut Sources, faults: &mut Faults) {
        let allowed = limits::FILE_BYTES.min(self.bytes);
        if self.files == 0 {
            let message = format!("the spec has more than {} files", limits::FILES);
            return refuse(FaultCode::TooLarge, path, message, "", sources, faults);
        }
        self.files -= 1;
        match read_at_most(disk, allowed) {
            Err(error) => {
                let message = format!("cannot read `{path}`: {error}");
                refuse(FaultCode::Unreadable, path, message, "", sources, faults);
            }
            Ok(None) if allowed < limits::FILE_BYTES => {
                self.bytes = 0;
                let message = format!(
                    "the files of the spec are more than {} MiB together",
                    limits::SPEC_BYTES >> 20
                );
                refuse(FaultCode::TooLarge, path, message, "", sources, faults);
            }
            Ok(None) => {
                let message = format!("`{path}` is larger than {} MiB", limits::FILE_BYTES >> 20);
                let advice = "split it: one file per command group";
                refuse(FaultCode::TooLarge, path, message, advice, sources, faults);
            }
            Ok(Some(bytes)) => {
                self.bytes -= bytes.len();
                decode(path, bytes, sources, faults);
            }
        }
    }
}

/// The bytes of a file, or `None` if there are more than `allowed`. Never holds more than that.
fn read_at_most(disk: &Path, allowed: usize) -> io::Result<Option<Vec<u8>>> {
    // Before opening: to open a pipe is to wait for its writer.
    let meta = fs::metadata(disk)?;
    if !meta.is_file() {
        return Err(io::Error::other("not a regular file"));
    }
    let beyond = u64::try_from(allowed).unwrap_or(u64::MAX).saturating_add(1);
    if meta.len() >= beyond {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    // The file may have grown since.
    File::open(disk)?.take(beyond).read_to_end(&mut bytes)?;
    Ok((bytes.len() <= allowed).then_some(bytes))
}

fn decode(path: String, bytes: Vec<u8>, sources: &mut Sources, faults: &mut Faults) {
    match String::from_utf8(bytes) {
        Ok(text) => {
            let text = match text.strip_prefix('\u{feff}') {
                Some(rest) => rest.to_owned(),
                None => text,
            };
            sources.push(SourceFile::new(path, text));
        }
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            let bytes = error.as_bytes();
            let wrong = bytes.get(at).copied().unwrap_or_default();
            let note = if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
                "it looks like UTF-16; save it as UTF-8"
            } else {
                "save it as UTF-8"
            };
            let message = format!("`{path}` is not UTF-8");
            let text = String::from_utf8_lossy(bytes.get(..at).unwrap_or_default()).into_owned();
            let file = sources.push(SourceFile::partial(path, text));
            faults.push(
                Diagnostic::error(FaultCode::NotUtf8, Span::point(file, at), message)
                    .label(format!("the byte {wrong:#04X} here"))
                    .note(note),
            );
        }
    }
}

/// A fault of a file as a whole; the file stands in `sources` without text.
fn refuse(
    code: FaultCode,
    path: String,
    message: String,
    advice: &str,
    sources: &mut Sources,
    faults: &mut Faults,
) {
    let file = sources.push(SourceFile::partial(path, ""));
    let mut fault = Diagnostic::error(code, Span::point(file, 0), message);
    if !advice.is_empty() {
        fault = fault.note(advice);
    }
    faults.push(fault);
}
