//! What the Kotlin package has of a spec, whatever that is: nothing is forgotten, and the runtime is told of no protocol.

#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    reason = "a test fails by panicking"
)]

use fc_codegen::product::Product;
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

/// No import is missing: the names that files use of the runtime are those that it has.
#[test]
fn what_is_imported_is_there() {
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

/// The runtime is anybody's: it names no protocol.
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
