//! The modules of a crate depend on each other in one direction.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// A crate and its modules, lowest first. A module may use earlier ones.
struct Crate {
    name: &'static str,
    rooms: &'static [&'static str],
    /// Uses of a later module. This list may only become shorter.
    upwards: &'static [(&'static str, &'static str)],
}

const CRATES: &[Crate] = &[
    Crate {
        name: "fc-spec",
        rooms: &[
            "names",
            "vocabulary",
            "source",
            "model",
            "diagnostic",
            "syntax",
            "language",
            "load",
            "project",
            "index",
            "format",
            "lint",
            "fix",
            "merge",
            "scaffold",
            "rename",
            "retire",
            "amend",
            "revision",
        ],
        upwards: &[
            // The answer of an owner is written in the format of the file.
            ("load", "format"),
        ],
    },
    Crate {
        name: "fc-codegen",
        rooms: &[
            "version",
            "product",
            "package",
            "check",
            "target_error",
            "plugin",
            "target",
            "emit",
            "codes",
            "output",
            "project",
            "input",
            "questions",
            "inspect",
        ],
        upwards: &[],
    },
    Crate {
        name: "fc-runtime",
        rooms: &[
            "digest",
            "message",
            "json",
            "preconditions",
            "operation",
            "envelope",
            "wire",
            "protocol",
            "frame",
            "content",
            "condition",
            "session",
            "progress",
            "refusal",
            "open_message",
            "clock",
            "connection_settings",
            "link",
            "rate",
            "stream",
            "raw",
            "sync",
            "log_limiter",
            "metrics",
            "trace",
            "client",
            "blocking",
            "server",
        ],
        upwards: &[
            // The trait of messages names the JSON reader.
            ("message", "json"),
        ],
    },
    Crate {
        name: "fc-diff",
        rooms: &[
            "rule",
            "rules",
            "explanation",
            "finding",
            "release",
            "changelog",
            "matching",
            "sunset",
            "judge",
            "git",
            "version",
            "history",
            "waive",
            "render",
            "project",
            "file_diff",
            "next_release",
        ],
        upwards: &[],
    },
    Crate {
        name: "fc-reflect",
        rooms: &[
            "sample",
            "tree",
            "write",
            "message",
            "plan",
            "constraint",
            "limits",
            "read",
            "id",
            "error",
            "frame",
        ],
        upwards: &[],
    },
    Crate {
        name: "fc-lsp",
        rooms: &[
            "project",
            "position",
            "uri",
            "settings",
            "snapshot",
            "item",
            "references",
            "diagnostics",
            "rename",
            "actions",
            "lens",
            "workspace",
            "symbols",
            "language",
            "completion",
            "definition",
            "formatting",
            "hover",
            "dispatch",
            "event",
            "queue",
            "worker",
            "serve",
        ],
        upwards: &[],
    },
    Crate {
        name: "fc-workshop",
        rooms: &[
            "error",
            "facts",
            "paths",
            "dump",
            "stream",
            "table",
            "run",
            "listen",
            "address",
            "permission",
            "arguments",
            "request",
            "complete",
            "answer",
            "transcript",
            "connection",
            "client",
            "call",
            "scenario",
            "app",
            "mock",
            "capture",
            "decode",
            "drift",
            "replay",
            "fault",
            "proxy",
            "certify",
            "recording",
            "view",
        ],
        upwards: &[],
    },
    Crate {
        name: "fc-package",
        rooms: &[
            "error",
            "files",
            "tool",
            "sums",
            "sbom",
            "language",
            "job",
            "maven",
            "rust",
            "typescript",
            "python",
            "kotlin",
            "cpp",
        ],
        upwards: &[],
    },
    Crate {
        name: "fc-derive",
        rooms: &[
            "errors",
            "attr",
            "span",
            "codes",
            "item",
            "reports",
            "id",
            "process",
            "new",
            "json",
            "one_of",
            "declared",
            "operation",
            "redacted",
            "envelope",
            "defaults",
            "header",
            "dispatch",
            "message",
            "open_enum",
        ],
        upwards: &[],
    },
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

/// Returns the modules of a crate that a source file uses, outside of comments and tests.
fn used(text: &str) -> BTreeSet<String> {
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    let lines = code
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    let code: String = lines.collect();
    let uses = code.split("crate::").skip(1);
    uses.flat_map(|path| match path.strip_prefix('{') {
        Some(group) => grouped(group),
        None => vec![name(path)],
    })
    .collect()
}

/// Returns the name that a path begins with.
fn name(path: &str) -> String {
    let letters = path.trim_start().chars();
    letters
        .take_while(|it| it.is_alphanumeric() || *it == '_')
        .collect()
}

/// Returns the first name of each path in a group `a, b::{c, d}}`.
fn grouped(group: &str) -> Vec<String> {
    let (mut names, mut start, mut depth) = (Vec::new(), 0, 0);
    for (at, letter) in group.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                names.push(name(&group[start..at]));
                start = at + 1;
                if letter == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    names
}

#[test]
fn uses_in_groups_and_paths_are_found() {
    let text =
        "use crate::{facts, paths::{self, at}, run};\n// crate::no\nfn a() { crate::deep::b() }";
    let text = format!(
        "{text}\n#[cfg(test)]\nuse crate::dump;\n#[cfg(test)]\nmod tests {{ crate::view }}"
    );
    let found: Vec<_> = used(&text).into_iter().collect();
    assert_eq!(found, ["deep", "dump", "facts", "paths", "run"]);
}

/// Returns the uses of later modules in a crate.
fn upwards(of: &Crate) -> BTreeSet<(&'static str, &'static str)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the root")
        .join(of.name)
        .join("src");
    let rank = |name: &str| of.rooms.iter().position(|room| *room == name);
    let mut upwards = BTreeSet::new();
    let mut seen = BTreeSet::new();
    for path in sources(&root) {
        let relative = path.strip_prefix(&root).expect("a path below src");
        let first = relative.iter().next().expect("a name").to_string_lossy();
        let module = first.trim_end_matches(".rs");
        if ["lib", "tests"].contains(&module) {
            continue;
        }
        let own = rank(module)
            .unwrap_or_else(|| panic!("`{module}` of {} has no place in CRATES", of.name));
        seen.insert(own);
        let text = fs::read_to_string(&path).expect("a source file");
        let later = used(&text).into_iter().filter_map(|name| rank(&name));
        let later = later.filter(|other| *other > own);
        upwards.extend(later.map(|other| (of.rooms[own], of.rooms[other])));
    }
    assert_eq!(
        seen.len(),
        of.rooms.len(),
        "a module of {} is gone",
        of.name
    );
    upwards
}

#[test]
fn modules_use_only_earlier_ones() {
    for of in CRATES {
        let known = of.upwards.iter().copied().collect();
        assert_eq!(upwards(of), known, "in {}", of.name);
    }
}

/// Names in the crate sections of ARCHITECTURE that are not files or folders of the crate.
const NO_MODULES: [&str; 3] = ["async", "fc.yaml", "fcproto"];

#[test]
fn architecture_names_modules_of_each_crate() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the root");
    for page in ["ARCHITECTURE.md", "ARCHITECTURE.zh-CN.md"] {
        let text = fs::read_to_string(root.join(page)).expect("a page");
        let sections = text.split("\n### `").skip(1);
        let sections = sections.filter_map(|section| section.split_once("`\n"));
        let mut names = 0;
        for (name, section) in sections {
            let files: BTreeSet<PathBuf> = ["src", "tests", "examples", "faults", "vectors"]
                .iter()
                .map(|folder| root.join(name).join(folder))
                .filter(|folder| folder.is_dir())
                .flat_map(|folder| sources(&folder))
                .collect();
            let section = section.split("\n#").next().unwrap_or_default();
            let quoted = section.split('`').skip(1).step_by(2);
            let is_name = |it: &&str| {
                it.chars()
                    .all(|c| c.is_ascii_lowercase() || "._/".contains(c))
            };
            for word in quoted.filter(is_name) {
                names += 1;
                let is_there = NO_MODULES.contains(&word)
                    || root.join(word).exists()
                    || root.join(name).join(word).exists()
                    || files.iter().any(|file| {
                        let file = file.with_extension("");
                        let word = Path::new(word).with_extension("");
                        file.ancestors().any(|path| path.ends_with(&word))
                    });
                assert!(is_there, "{page}: {name} has no `{word}`");
            }
        }
        assert!(names > 50, "{page} names {names} modules");
    }
}
