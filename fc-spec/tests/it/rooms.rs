//! The modules of this crate depend on each other in one direction.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The modules, lowest first. A module may use earlier ones.
const ROOMS: &[&str] = &[
    "names",
    "vocabulary",
    "source",
    "model",
    "diagnostic",
    "syntax",
    "language",
    "load",
    "index",
    "format",
    "lint",
    "fix",
    "merge",
    "scaffold",
    "rename",
    "retire",
    "revision",
];

/// Uses of a later module. This list may only become shorter.
const UPWARDS: &[(&str, &str)] = &[
    // An answer of the owner is written in the layout of the file.
    ("load", "format"),
];

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder of sources");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    paths
        .flat_map(|path| {
            if path.is_dir() {
                sources(&path)
            } else {
                vec![path]
            }
        })
        .collect()
}

/// Names of the modules of this crate that a source file uses, outside of comments.
fn used(text: &str) -> BTreeSet<&str> {
    let lines = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    let uses = lines.flat_map(|line| line.split("crate::").skip(1));
    uses.map(|path| {
        path.split(|c: char| !c.is_alphanumeric() && c != '_')
            .next()
            .unwrap_or_default()
    })
    .filter(|name| ROOMS.contains(name))
    .collect()
}

#[test]
fn modules_use_only_earlier_ones() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let rank = |name: &str| ROOMS.iter().position(|room| *room == name);
    let mut upwards = BTreeSet::new();
    let mut seen = BTreeSet::new();
    for path in sources(&root) {
        let relative = path.strip_prefix(&root).expect("a path below src");
        let first = relative.iter().next().expect("a name").to_string_lossy();
        let module = first.trim_end_matches(".rs");
        if module == "lib" {
            continue;
        }
        let Some(own) = ROOMS.iter().find(|known| **known == module) else {
            panic!("`{module}` has no place in ROOMS");
        };
        seen.insert(*own);
        let text = fs::read_to_string(&path).expect("a source file");
        for other in used(&text) {
            if rank(other) > rank(own) {
                let other = ROOMS.iter().find(|room| **room == other).expect("a room");
                upwards.insert((*own, *other));
            }
        }
    }
    assert_eq!(seen.len(), ROOMS.len(), "a module of ROOMS is gone");
    assert_eq!(upwards, UPWARDS.iter().copied().collect());
}
