//! Compares the schema of the spec language with the loader. The schema accepts every valid file and refuses errors of
//! the shape, as the loader does.

use crate::good_spec;
use crate::json_schema::Validator;
use crate::yaml_as_json;
use fc_spec::diagnostic::Faults;
use fc_spec::language::{project_schema, schema};
use fc_spec::model::Languages;
use fc_spec::project;
use fc_spec::source::{SourceFile, Sources};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn check(text: &str) -> bool {
    let root: Value = serde_json::from_str(&schema(Languages::All)).expect("the schema is JSON");
    Validator { root: &root }.accepts(&root, &yaml_as_json::parse(text))
}

#[test]
fn good_files_are_accepted() {
    for path in good_spec::FILES {
        assert!(check(&good_spec::file(path)), "{path}");
    }
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../spec");
    for folder in [spec.clone(), spec.join("commands")] {
        for entry in fs::read_dir(folder).expect("the spec can be read") {
            let path = entry.expect("an entry").path();
            if path
                .extension()
                .is_some_and(|extension| extension == "yaml")
            {
                let text = fs::read_to_string(&path).expect("the file can be read");
                assert!(check(&text), "{}", path.display());
            }
        }
    }
}

/// Errors of the shape that a schema can detect. The others need the spelling (`0x0a06`, `017`), which YAML readers do
/// not keep, or more than one place.
const SEEN_BY_SCHEMA: &[&str] = &[
    "FC0101", "FC0102", "FC0103", "FC0104", "FC0107", "FC0108", "FC0109", "FC0110", "FC0111",
    "FC0117", "FC0118", "FC0120", "FC0121", "FC0122", "FC0123",
];

#[test]
fn files_with_faults_of_shape_are_refused() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let mut seen = 0;
    for entry in fs::read_dir(folder).expect("tests/bad can be read") {
        let path = entry.expect("an entry").path();
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .unwrap_or_default();
        if name
            .get(..6)
            .is_some_and(|code| SEEN_BY_SCHEMA.contains(&code))
        {
            let text = fs::read_to_string(&path).expect("the file can be read");
            assert!(!check(&text), "{name} is accepted");
            seen += 1;
        }
    }
    assert!(seen >= SEEN_BY_SCHEMA.len(), "only {seen} fixtures");
}

/// The reader and the schema both accept the valid settings, and both refuse the others.
#[test]
fn settings_are_accepted_by_reader_and_schema() {
    let root: Value = serde_json::from_str(&project_schema()).expect("the schema is JSON");
    for (text, is_good) in [
        ("spec: protocol\n", true),
        ("languages: [en]\ntargets: {}\n", true),
        (
            "targets: { rust: { out: a, crate: b, newtypes: true } }\n",
            true,
        ),
        (
            "targets: { mine: { plugin: a, out: b, timeout_ms: 5, options: { c: [1] } } }\n",
            true,
        ),
        ("lint: { levels: { STANDARD: warning } }\n", true),
        ("target: {}\n", false),
        ("languages: []\n", false),
        ("languages: [fr]\n", false),
        ("targets: [rust]\n", false),
        ("targets: { rust: { ouut: a } }\n", false),
        ("targets: { rust: { newtypes: often } }\n", false),
        ("targets: { mine: { timeout_ms: 0 } }\n", false),
        ("targets: { mine: { output_bytes: 1073741825 } }\n", false),
        ("[]\n", false),
    ] {
        let mut sources = Sources::new();
        let file = sources.push(SourceFile::new("fc.yaml", text));
        let mut faults = Faults::new();
        let read = project::read(file, text, &mut faults);
        assert_eq!(read.is_some(), is_good, "{text}");
        assert_eq!(faults.is_empty(), is_good, "{text}");
        let accepted = Validator { root: &root }.accepts(&root, &yaml_as_json::parse(text));
        assert_eq!(accepted, is_good, "{text}");
    }
}

#[test]
fn every_definition_is_used() {
    let text = schema(Languages::All);
    let root: Value = serde_json::from_str(&text).expect("the schema is JSON");
    for name in root["$defs"].as_object().expect("definitions").keys() {
        assert!(text.contains(&format!("\"#/$defs/{name}\"")), "{name}");
    }
}

/// Editors offer defaults and examples, so each must be valid in its place.
#[test]
fn offered_values_are_valid() {
    let root: Value = serde_json::from_str(&schema(Languages::All)).expect("the schema is JSON");
    let mut offers = 0;
    for (name, definition) in root["$defs"].as_object().expect("definitions") {
        let properties = definition["properties"].as_object();
        for (key, place) in properties.into_iter().flatten() {
            let examples = place["examples"].as_array().into_iter().flatten();
            for offer in place.get("default").into_iter().chain(examples) {
                let misfit = Validator { root: &root }.misfit(place, offer, key);
                assert!(misfit.is_none(), "{name}: {offer} does not fit: {misfit:?}");
                offers += 1;
            }
        }
    }
    assert!(offers > 50, "only {offers}");
    let optional = &root["$defs"]["field"]["properties"]["optional"];
    assert_eq!(optional["default"], Value::Bool(false), "{optional}");
}
