//! The sources spell each key of the language only in its declaration, `language/grammar`. All other code refers to the
//! key by its field.

use fc_spec::model::Languages;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Sources that read a spec by its keys. The others know no spec, or write words of other formats (SARIF, JSON Schema).
const READERS: [&str; 2] = ["load", "scaffold.rs"];

/// The sources that declare the keys.
const HOME: &str = "language/grammar";

/// Keys that have another meaning in the sources, and that meaning.
const ALSO: [(&str, &str); 12] = [
    ("body", "what a fault calls a message"),
    ("command", "what a fault calls an operation"),
    ("commands", "the folder of the groups' files"),
    ("data", "the wire key whose object has a title of its own"),
    ("encodings", "what a fault calls several of them"),
    ("json", "a type"),
    (
        "number",
        "what a fault calls a value, and what others call a type",
    ),
    ("report", "what a fault calls an operation"),
    ("request", "what a fault calls a message"),
    ("response", "what a fault calls a message"),
    ("streams", "what a fault calls several of them"),
    (
        "text",
        "what a fault calls a value, and what others call a type",
    ),
];

/// Collects all keys of the language from its JSON Schema.
fn keys(schema: &Value, found: &mut BTreeSet<String>) {
    let Value::Object(entries) = schema else {
        return;
    };
    for (name, value) in entries {
        match (name.as_str(), value) {
            ("properties", Value::Object(properties)) => {
                found.extend(properties.keys().cloned());
            }
            ("$defs", Value::Object(tables)) => {
                tables.values().for_each(|table| keys(table, found));
            }
            _ => {}
        }
    }
}

/// Collects the string literals of the sources, except those in comments and tests.
fn literals(found: &mut Vec<(String, String)>, root: &Path, path: &Path) {
    let name = path
        .strip_prefix(root)
        .unwrap()
        .to_string_lossy()
        .into_owned();
    if name == HOME {
        return;
    }
    if path.is_dir() {
        for entry in fs::read_dir(path).unwrap() {
            literals(found, root, &entry.unwrap().path());
        }
        return;
    }
    let text = fs::read_to_string(path).unwrap();
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    for line in code.lines() {
        let line = line.split("//").next().unwrap_or_default();
        // Every second part is inside quotes. No key has an escaped quote.
        let inside = line.split('"').skip(1).step_by(2);
        found.extend(inside.map(|literal| (literal.to_owned(), name.clone())));
    }
}

#[test]
fn no_key_is_spelled_outside_its_declaration() {
    let schema = serde_json::from_str(&fc_spec::language::schema(Languages::All)).unwrap();
    let mut known = BTreeSet::new();
    keys(&schema, &mut known);
    assert!(known.len() > 80, "the keys are not found: {known:?}");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    for reader in READERS {
        literals(&mut found, &root, &root.join(reader));
    }
    let wrong: Vec<_> = found
        .iter()
        .filter(|(literal, _)| known.contains(literal))
        .filter(|(literal, _)| !ALSO.iter().any(|(also, _)| also == literal))
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    // An exception that is not needed must be removed.
    for (also, _) in ALSO {
        let is_found = found.iter().any(|(literal, _)| literal == also);
        assert!(
            known.contains(also) && is_found,
            "`{also}` is no exception any more"
        );
    }
}
