//! Prints what our own reader reads in each file named, as one JSON object by path, for `.ci/yaml-readers`:
//! `{"spec/types.yaml": {"fc": {"value": …}}}`, or `refused` with the first fault.

use std::process::ExitCode;

use fc_spec::diagnostic::Faults;
use fc_spec::source::FileId;
use fc_spec::syntax::{Node, NodeKind, Style, parse};
use serde_json::{Map, Value, json};

fn main() -> ExitCode {
    let mut files = Map::new();
    for path in std::env::args().skip(1) {
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) => {
                eprintln!("{path}: {error}");
                return ExitCode::FAILURE;
            }
        };
        let mut faults = Faults::new();
        let reading = match parse(FileId(0), &text, &mut faults) {
            Some(tree) => json!({ "value": value(tree.root()) }),
            None => json!({ "refused": faults.iter().next().map(|fault| &fault.message.en) }),
        };
        files.insert(path, json!({ "fc": reading }));
    }
    println!("{}", Value::Object(files));
    ExitCode::SUCCESS
}

fn value(node: Node<'_>) -> Value {
    match node.kind() {
        NodeKind::Null => Value::Null,
        NodeKind::Scalar(scalar) if scalar.style == Style::Plain => plain(scalar.text),
        NodeKind::Scalar(scalar) => Value::from(scalar.text),
        NodeKind::Sequence(items) => items.map(value).collect(),
        NodeKind::Mapping(entries) => entries
            .map(|entry| {
                let key = match value(entry.key) {
                    Value::String(key) => key,
                    key => key.to_string(),
                };
                (key, value(entry.value))
            })
            .collect(),
    }
}

/// Numbers and truth values are those of JSON, and hexadecimal integers; all else is text.
fn plain(text: &str) -> Value {
    if let Some(number) = text
        .strip_prefix("0x")
        .and_then(|digits| u64::from_str_radix(digits, 16).ok())
    {
        return Value::from(number);
    }
    match serde_json::from_str(text) {
        Ok(value @ (Value::Bool(_) | Value::Number(_))) => value,
        _ => Value::from(text),
    }
}
