//! The imports and the comment links of the Kotlin package have targets, and its runtime depends on no protocol.

use fc_codegen::product::Product;
use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let inside = fs::read_dir(folder).expect("the folder is there");
    let mut found = Vec::new();
    for entry in inside {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "kt") {
            let text = fs::read_to_string(&path).unwrap();
            found.push((path, text));
        }
    }
    found
}

/// Every name that a file imports from the runtime is declared there.
#[test]
fn every_import_exists() {
    let place = root().join(Product::Kotlin.usual_place());
    let runtime: String = (sources(&place.join("runtime/src/main")).into_iter())
        .map(|(_, text)| text)
        .collect();
    let generated = sources(&place.join("generated/src/main"));
    assert!(generated.len() > 5, "{}", generated.len());
    for (path, text) in generated {
        for line in text.lines() {
            let Some(name) = line.strip_prefix("import fc.runtime.") else {
                continue;
            };
            let is_declared = ["class", "interface", "object", "fun"].iter().any(|kind| {
                let head = format!("{kind} {name}");
                runtime.contains(&head)
            });
            assert!(is_declared, "{}: {name}", path.display());
        }
    }
}

/// Every link in a comment has a target. The target is in the package, is imported, or has its full name. An import
/// that only comments use would not do, because compilers that deny warnings refuse it.
#[test]
fn targets_of_comment_links_exist() {
    let place = root().join(Product::Kotlin.usual_place());
    let runtime = declared(&sources(&place.join("runtime/src/main")));
    let files = sources(&place.join("generated/src/main"));
    let own = declared(&files);
    let mut count = 0;
    let mut lost = Vec::new();
    for (path, text) in &files {
        let is_imported = |name: &str| {
            let end = format!(".{name}");
            let mut imports = text.lines().filter(|line| line.starts_with("import "));
            imports.any(|line| line.ends_with(&end))
        };
        for link in text.lines().flat_map(links) {
            let is_there = if let Some(name) = link.strip_prefix("fc.runtime.") {
                name.split('.').all(|part| runtime.contains(part))
            } else {
                let first = link.split('.').next().unwrap_or_default();
                own.contains(first) || is_imported(first)
            };
            count += 1;
            if !is_there {
                lost.push(format!("{}: {link}", path.display()));
            }
        }
    }
    assert!(count > 10, "{count}");
    assert!(lost.is_empty(), "{}", lost.join("\n"));
}

/// Returns the links of a comment line: `[Name]`, and the class after `@throws`.
fn links(line: &str) -> Vec<&str> {
    let trimmed = line.trim_start();
    if !(trimmed.starts_with('*') || trimmed.starts_with("/**")) {
        return Vec::new();
    }
    let thrown = trimmed.strip_prefix("* @throws ");
    let thrown = thrown.and_then(|rest| rest.split_whitespace().next());
    // Skips code spans.
    let prose = trimmed.split('`').step_by(2);
    let linked = prose
        .flat_map(|part| part.split('[').skip(1))
        .filter_map(|rest| rest.split_once(']'));
    let is_name = |link: &&str| {
        link.chars()
            .all(|c| c.is_alphanumeric() || "_.".contains(c))
    };
    thrown
        .into_iter()
        .chain(linked.map(|(link, _)| link).filter(is_name))
        .collect()
}

/// Returns the names of all declared classes and members.
fn declared(files: &[(PathBuf, String)]) -> HashSet<String> {
    let mut names = HashSet::new();
    for line in files.iter().flat_map(|(_, text)| text.lines()) {
        let mut words = line.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        while let Some(word) = words.next() {
            if ["class", "interface", "object", "fun", "val", "var"].contains(&word) {
                let name = words.find(|word| !word.is_empty());
                names.extend(name.map(str::to_owned));
            }
        }
    }
    names
}

/// The runtime serves any protocol, so it imports none.
#[test]
fn the_runtime_knows_no_protocol() {
    let place = root().join(Product::Kotlin.usual_place());
    for (path, text) in sources(&place.join("runtime/src/main")) {
        let uses = text
            .lines()
            .find(|line| line.starts_with("import fc.") && !line.starts_with("import fc.runtime."));
        assert_eq!(uses, None, "{}", path.display());
    }
}
