//! The dump of a release, as a repository stores it.

use super::tree;
use fc_spec::model::{Dump, Model, Value};
use std::fmt::Write as _;

/// Returns the dump as JSON for storage, without derived keys.
///
/// Each operation, type or other item of a list has one line, so that text tools can find and compare it. A release
/// dump is read like any other dump.
#[must_use]
pub fn release_dump(model: &Model) -> String {
    let mut out = String::new();
    parts(&mut out, &tree(&Dump::from(model)), 2);
    out.push('\n');
    out
}

/// Writes a value with one line for each item, down to `depth`.
fn parts(out: &mut String, value: &Value, depth: usize) {
    // Writing to a `String` cannot fail.
    match value {
        Value::Object(entries) if depth > 0 && !entries.is_empty() => {
            let mut before = "{\n";
            for (key, value) in entries {
                let _ = write!(out, "{before}{}: ", Value::String(key.clone()));
                parts(out, value, depth - 1);
                before = ",\n";
            }
            out.push_str("\n}");
        }
        Value::Array(items) if depth > 0 && !items.is_empty() => {
            let mut before = "[\n";
            for item in items {
                let _ = write!(out, "{before}{item}");
                before = ",\n";
            }
            out.push_str("\n]");
        }
        value => {
            let _ = write!(out, "{value}");
        }
    }
}
