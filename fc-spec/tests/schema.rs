//! The schema of the spec language against the loader: what the loader takes the schema takes, and what is
//! wrong with the shape both refuse.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "tests"
)]

mod good_spec;

use fc_spec::schema::schema;
use regex_lite::Regex;
use serde_json::{Map, Value};
use std::fs;
use std::path::Path;

/// A validator for the keywords that the schema uses, and no others.
struct Validator<'s> {
    root: &'s Value,
}

impl Validator<'_> {
    fn accepts(&self, schema: &Value, value: &Value) -> bool {
        let Some(keywords) = schema.as_object() else {
            return schema != &Value::Bool(false);
        };
        keywords
            .iter()
            .all(|(keyword, argument)| self.holds(keywords, keyword, argument, value))
    }

    fn holds(
        &self,
        keywords: &Map<String, Value>,
        keyword: &str,
        argument: &Value,
        value: &Value,
    ) -> bool {
        let number = |value: &Value| value.as_f64();
        let count = argument
            .as_u64()
            .and_then(|count| usize::try_from(count).ok());
        match keyword {
            "$schema"
            | "$defs"
            | "title"
            | "description"
            | "markdownEnumDescriptions"
            | "then"
            | "else" => true,
            "$ref" => {
                let path = argument.as_str().and_then(|path| path.strip_prefix('#'));
                let target = path
                    .and_then(|path| self.root.pointer(path))
                    .expect("a definition");
                self.accepts(target, value)
            }
            "type" => match argument {
                Value::Array(types) => types.iter().any(|ty| is_type(ty, value)),
                ty => is_type(ty, value),
            },
            "enum" => argument
                .as_array()
                .is_some_and(|values| values.contains(value)),
            "minimum" => {
                number(value).is_none_or(|value| number(argument).is_some_and(|min| value >= min))
            }
            "maximum" => {
                number(value).is_none_or(|value| number(argument).is_some_and(|max| value <= max))
            }
            "pattern" => {
                let regex = Regex::new(argument.as_str().expect("a pattern"))
                    .expect("a regular expression");
                value.as_str().is_none_or(|text| regex.is_match(text))
            }
            "anyOf" => argument
                .as_array()
                .expect("a list")
                .iter()
                .any(|schema| self.accepts(schema, value)),
            "if" => {
                let branch = if self.accepts(argument, value) {
                    "then"
                } else {
                    "else"
                };
                keywords
                    .get(branch)
                    .is_none_or(|schema| self.accepts(schema, value))
            }
            "items" => value
                .as_array()
                .is_none_or(|items| items.iter().all(|item| self.accepts(argument, item))),
            "minItems" => value
                .as_array()
                .is_none_or(|items| Some(items.len()) >= count),
            "maxItems" => value
                .as_array()
                .is_none_or(|items| Some(items.len()) <= count),
            "minProperties" => value
                .as_object()
                .is_none_or(|entries| Some(entries.len()) >= count),
            "required" => value.as_object().is_none_or(|entries| {
                let mut names = argument
                    .as_array()
                    .expect("a list")
                    .iter()
                    .filter_map(Value::as_str);
                names.all(|name| entries.contains_key(name))
            }),
            "properties" => value.as_object().is_none_or(|entries| {
                let properties = argument.as_object().expect("an object");
                properties
                    .iter()
                    .filter_map(|(name, schema)| Some((schema, entries.get(name)?)))
                    .all(|(schema, value)| self.accepts(schema, value))
            }),
            "additionalProperties" => value.as_object().is_none_or(|entries| {
                let known = keywords.get("properties").and_then(Value::as_object);
                entries
                    .iter()
                    .filter(|(name, _)| known.is_none_or(|known| !known.contains_key(*name)))
                    .all(|(_, value)| self.accepts(argument, value))
            }),
            "propertyNames" => value.as_object().is_none_or(|entries| {
                entries
                    .keys()
                    .all(|name| self.accepts(argument, &Value::String(name.clone())))
            }),
            other => panic!("the keyword {other} is new here"),
        }
    }
}

fn is_type(ty: &Value, value: &Value) -> bool {
    match ty.as_str() {
        Some("string") => value.is_string(),
        Some("boolean") => value.is_boolean(),
        Some("integer") => value.is_i64() || value.is_u64(),
        Some("number") => value.is_number(),
        Some("array") => value.is_array(),
        Some("object") => value.is_object(),
        other => panic!("the type {other:?} is new here"),
    }
}

/// YAML as an editor's language server sees it.
fn json_of(yaml: &serde_yaml::Value) -> Value {
    match yaml {
        serde_yaml::Value::Mapping(entries) => entries
            .iter()
            .map(|(key, value)| {
                let name = match json_of(key) {
                    Value::String(name) => name,
                    other => other.to_string(),
                };
                (name, json_of(value))
            })
            .collect(),
        serde_yaml::Value::Sequence(items) => items.iter().map(json_of).collect(),
        serde_yaml::Value::Tagged(_) => panic!("the spec has no tags"),
        scalar => serde_json::to_value(scalar).expect("a JSON scalar"),
    }
}

fn check(text: &str) -> bool {
    let root: Value = serde_json::from_str(&schema()).expect("the schema is JSON");
    let yaml: serde_yaml::Value = serde_yaml::from_str(text).expect("the text is YAML");
    Validator { root: &root }.accepts(&root, &json_of(&yaml))
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

/// Faults of the shape that a schema can tell. The others need the spelling (`0x0a06`, `017`), which YAML readers do
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

#[test]
fn every_definition_is_used() {
    let text = schema();
    let root: Value = serde_json::from_str(&text).expect("the schema is JSON");
    for name in root["$defs"].as_object().expect("definitions").keys() {
        assert!(text.contains(&format!("\"#/$defs/{name}\"")), "{name}");
    }
}
