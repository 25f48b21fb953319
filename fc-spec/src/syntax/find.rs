//! Finds the files of a spec.

use crate::model::Text;
use crate::text;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::limits;
use crate::diagnostic::nearest;

/// The directory for command groups, inside that of the spec.
const GROUPS: &str = "commands";

/// An entry of the spec's directories.
pub(super) struct Item {
    /// The path, relative to the project's root, with `/` as separator.
    pub path: String,
    /// The kind of entry.
    pub found: Found,
}

/// The kind of an entry in the spec's directories.
pub(super) enum Found {
    /// A file of the spec.
    Spec(PathBuf),
    /// A file, or a directory with files, that looks like a part of the spec. The text is advice.
    Stray(Text),
    /// A directory with the name of a spec file.
    Directory,
    /// An entry that cannot be read.
    Error(io::Error),
}

/// Returns `true` if a file can belong to a spec. The path is relative to the spec's directory.
#[must_use]
pub fn is_spec_file(path: &Path) -> bool {
    let is_file = path
        .extension()
        .is_some_and(|extension| extension == "yaml");
    let mut parts = path.iter();
    match (parts.next(), parts.next(), parts.next()) {
        (Some(_), None, _) => is_file,
        (Some(directory), Some(_), None) => is_file && directory == GROUPS,
        _ => false,
    }
}

/// Returns the entries of the spec's directories, sorted by path. It stops after one more than a spec may have.
pub(super) fn find(root: &Path, spec: &Path) -> Vec<Item> {
    let mut found = Vec::new();
    Directory::new(root, spec).list(true, &mut found);
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

struct Directory {
    disk: PathBuf,
    path: String,
}

impl Directory {
    fn new(root: &Path, spec: &Path) -> Self {
        let disk = root.join(spec);
        let path = match disk.strip_prefix(root) {
            Ok(below) => {
                let parts: Vec<_> = below.iter().map(|part| part.to_string_lossy()).collect();
                parts.join("/")
            }
            Err(_) => disk.display().to_string(),
        };
        Self { disk, path }
    }

    fn below(&self, name: &str) -> Self {
        Self {
            disk: self.disk.join(name),
            path: self.child(name),
        }
    }

    fn child(&self, name: &str) -> String {
        match self.path.as_str() {
            "" => name.to_owned(),
            path => format!("{path}/{name}"),
        }
    }

    /// Lists the spec files of this directory. With `top`, lists those of `commands` as well.
    fn list(&self, top: bool, found: &mut Vec<Item>) {
        self.each(found, |name, is_dir, found| {
            if top && name == GROUPS {
                // If `commands` is not a directory, this reports an error.
                self.below(name).list(false, found);
            } else if !is_dir {
                found.extend(self.file(name));
            } else if is_yaml(name) {
                found.push(Item {
                    path: self.child(name),
                    found: Found::Directory,
                });
            } else {
                self.below(name).strays(found);
            }
        });
    }

    /// Returns the entry of a file in a spec directory.
    fn file(&self, name: &str) -> Option<Item> {
        let (stem, extension) = name.rsplit_once('.')?;
        let found = match extension {
            "yaml" => Found::Spec(self.disk.join(name)),
            _ if is_yaml(name) => {
                Found::Stray(text!("改名为 `{stem}.yaml`", "name it `{stem}.yaml`"))
            }
            _ => return None,
        };
        Some(Item {
            path: self.child(name),
            found,
        })
    }

    /// Reports a directory with YAML files that the spec does not read.
    fn strays(&self, found: &mut Vec<Item>) {
        let mut files = 0_usize;
        self.each(found, |name, is_dir, _| {
            files += usize::from(!is_dir && is_yaml(name));
        });
        let name = self.path.rsplit('/').next().unwrap_or_default();
        let advice = match nearest(name, [GROUPS]) {
            Some(near) => text!("改名为 `{near}`", "name it `{near}`"),
            None => {
                text!(
                    "把其中的 YAML 文件移到规范目录，或移到规范目录下的 `{GROUPS}`",
                    "move its YAML files into the spec directory or into `{GROUPS}` below it"
                )
            }
        };
        if files > 0 {
            found.push(Item {
                path: self.path.clone(),
                found: Found::Stray(advice),
            });
        }
    }

    /// Visits every entry whose name does not start with a dot.
    fn each(&self, found: &mut Vec<Item>, mut visit: impl FnMut(&str, bool, &mut Vec<Item>)) {
        let entries = match fs::read_dir(&self.disk) {
            Ok(entries) => entries,
            Err(error) => return found.push(self.error(error)),
        };
        for entry in entries {
            if found.len() > limits::FILES {
                return;
            }
            let entry = match entry {
                Ok(entry) => entry,
                Err(error) => return found.push(self.error(error)),
            };
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if !name.starts_with('.') {
                // A link counts as its target.
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
