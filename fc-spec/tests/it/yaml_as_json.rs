//! Reads YAML as an editor's language server does.

use serde_json::Value;

/// Returns the value of a YAML text as JSON.
pub fn parse(text: &str) -> Value {
    let yaml: serde_yaml::Value = serde_yaml::from_str(text).expect("the text is YAML");
    json_of(&yaml)
}

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
