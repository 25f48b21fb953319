//! Reads files into [`Sources`].

use crate::text;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use super::find::{Found, find};
use super::limits;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::model::Text;
use crate::source::{SourceFile, Sources, Span};

/// Reads every `*.yaml` directly in `root/spec` and in `root/spec/commands`, sorted by path.
///
/// Ignores names that start with a dot. An unreadable file becomes an error, and a file of the result that is not
/// [`whole`](SourceFile::whole). Reading stops at the size limits.
///
/// **Architecture invariant.** Only this module and the output module access the disk.
pub fn read_dir(root: &Path, spec: &Path, faults: &mut Faults) -> Sources {
    let mut reader = Reader::new(faults);
    for (index, item) in find(root, spec).into_iter().enumerate() {
        let path = item.path;
        if index == limits::FILES {
            let message = text!(
                "规范的文件超过 {limit} 个",
                "the spec has more than {limit} files",
                limit = limits::FILES
            );
            reader.refuse(FaultCode::TooLarge, path, message, None);
            break;
        }
        match item.found {
            Found::Spec(disk) => reader.read(path, &disk),
            Found::Stray(advice) => {
                let message = text!(
                    "`{path}` 不会作为规范的一部分读取",
                    "`{path}` is not read as part of the spec"
                );
                reader.refuse(FaultCode::StrayFile, path, message, Some(advice));
            }
            Found::Directory => {
                let message = text!(
                    "`{path}` 是目录，不是文件",
                    "`{path}` is a directory, not a file"
                );
                let advice = text!(
                    "把文件移出来，再删除目录",
                    "move the file out of it and delete the directory"
                );
                reader.refuse(FaultCode::StrayFile, path, message, Some(advice));
            }
            Found::Error(error) => reader.unreadable(path, &error),
        }
    }
    reader.sources
}

/// Reads the given files in this order. Each has the path for errors and the path on the disk.
///
/// An unreadable file becomes an error, as in [`read_dir`].
pub fn read_files<'p>(
    files: impl IntoIterator<Item = (String, &'p Path)>,
    faults: &mut Faults,
) -> Sources {
    let mut reader = Reader::new(faults);
    for (index, (path, disk)) in files.into_iter().enumerate() {
        if index == limits::FILES {
            let message = text!(
                "文件超过 {limit} 个",
                "there are more than {limit} files",
                limit = limits::FILES
            );
            reader.refuse(FaultCode::TooLarge, path, message, None);
            break;
        }
        reader.read(path, disk);
    }
    reader.sources
}

/// Reads a text from elsewhere, such as standard input, under this path.
pub fn read_bytes(path: String, bytes: Vec<u8>, faults: &mut Faults) -> Sources {
    let mut reader = Reader::new(faults);
    if bytes.len() > limits::FILE_BYTES {
        reader.too_large(path, None);
    } else {
        reader.decode(path, bytes);
    }
    reader.sources
}

struct Reader<'a> {
    sources: Sources,
    faults: &'a mut Faults,
    /// The number of bytes that may still be read.
    bytes: usize,
}

impl<'a> Reader<'a> {
    fn new(faults: &'a mut Faults) -> Self {
        Self {
            sources: Sources::new(),
            faults,
            bytes: limits::SPEC_BYTES,
        }
    }

    fn read(&mut self, path: String, disk: &Path) {
        if let Some(message) = not_a_file(&path, disk) {
            return self.refuse(FaultCode::Unreadable, path, message, None);
        }
        match read_at_most(disk, limits::FILE_BYTES) {
            Err(error) => self.unreadable(path, &error),
            Ok(None) => {
                let advice = text!(
                    "拆分它：每组接口一个文件",
                    "split it: one file per command group"
                );
                self.too_large(path, Some(advice));
            }
            Ok(Some(bytes)) => {
                if let Some(rest) = self.bytes.checked_sub(bytes.len()) {
                    self.bytes = rest;
                    return self.decode(path, bytes);
                }
                let limit = limits::SPEC_BYTES >> 20;
                let message = text!(
                    "到 `{path}` 为止，文件总共超过 {limit} MiB",
                    "the files up to `{path}` exceed {limit} MiB in total"
                );
                self.refuse(FaultCode::TooLarge, path, message, None);
            }
        }
    }

    fn decode(&mut self, path: String, bytes: Vec<u8>) {
        let error = match String::from_utf8(bytes) {
            Ok(mut text) => {
                if text.starts_with('\u{feff}') {
                    text.remove(0);
                }
                self.sources.push(SourceFile::new(path, text));
                return;
            }
            Err(error) => error,
        };
        let at = error.utf8_error().valid_up_to();
        let bytes = error.as_bytes();
        let wrong = bytes.get(at).copied().unwrap_or_default();
        let utf16 = bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]);
        let note = if utf16 {
            text!(
                "看起来是 UTF-16；请保存为 UTF-8",
                "it looks like UTF-16; save it as UTF-8"
            )
        } else {
            text!("请保存为 UTF-8", "save it as UTF-8")
        };
        let message = text!("`{path}` 不是 UTF-8", "`{path}` is not UTF-8");
        let text = String::from_utf8_lossy(bytes.get(..at).unwrap_or_default()).into_owned();
        let file = self.sources.push(SourceFile::partial(path, text));
        self.faults.push(
            Diagnostic::error(FaultCode::NotUtf8, Span::point(file, at), message)
                .label(text!(
                    "这里是字节 {wrong:#04X}",
                    "the byte {wrong:#04X} here"
                ))
                .note(note),
        );
    }

    fn unreadable(&mut self, path: String, error: &io::Error) {
        let message = text!(
            "无法读取 `{path}`：{error}",
            "cannot read `{path}`: {error}"
        );
        self.refuse(FaultCode::Unreadable, path, message, None);
    }

    fn too_large(&mut self, path: String, advice: Option<Text>) {
        let limit = limits::FILE_BYTES >> 20;
        let message = text!(
            "`{path}` 超过 {limit} MiB",
            "`{path}` is larger than {limit} MiB"
        );
        self.refuse(FaultCode::TooLarge, path, message, advice);
    }

    /// Reports an error about a whole file. The sources get the file without its text.
    fn refuse(&mut self, code: FaultCode, path: String, message: Text, advice: Option<Text>) {
        let file = self.sources.push(SourceFile::partial(path, ""));
        let mut fault = Diagnostic::error(code, Span::point(file, 0), message);
        fault.notes.extend(advice);
        self.faults.push(fault);
    }
}

/// Describes a path that is not a file. Pipes are refused, because opening one would wait for a writer.
fn not_a_file(path: &str, disk: &Path) -> Option<Text> {
    match fs::metadata(disk) {
        Ok(meta) if meta.is_file() => None,
        Ok(meta) if meta.is_dir() => Some(text!(
            "`{path}` 是目录，不是文件",
            "`{path}` is a directory, not a file"
        )),
        Ok(_) => Some(text!(
            "`{path}` 不是普通文件",
            "`{path}` is not a regular file"
        )),
        Err(_) if disk.is_symlink() => Some(text!(
            "`{path}` 是链接，但它指向的文件无法读取",
            "`{path}` is a link to a file that cannot be read"
        )),
        Err(_) => None,
    }
}

/// Returns the bytes of a file, or `None` if there are more than `allowed`. It never holds more.
fn read_at_most(disk: &Path, allowed: usize) -> io::Result<Option<Vec<u8>>> {
    let meta = fs::metadata(disk)?;
    let beyond = u64::try_from(allowed).unwrap_or(u64::MAX).saturating_add(1);
    if meta.len() >= beyond {
        return Ok(None);
    }
    // The capacity is exact, because the text stays in memory as long as the spec.
    let mut bytes = Vec::with_capacity(usize::try_from(meta.len()).unwrap_or(0));
    // The file may have grown meanwhile.
    File::open(disk)?.take(beyond).read_to_end(&mut bytes)?;
    Ok((bytes.len() <= allowed).then_some(bytes))
}
