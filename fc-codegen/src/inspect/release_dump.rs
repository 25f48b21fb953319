//! The dump of a release, as it is kept in a repository.

use super::tree;
use fc_spec::model::{Dump, Model, Value};
use std::fmt::Write as _;

/// The dump as JSON for files that are kept: without what is worked out from the rest, and with a line for each operation, type and
/// other thing of a list, so that text tools find and compare them. It is read like any other dump.
#[must_use]
pub fn release_dump(model: &Model) -> String {
    let mut out = String::new();
    parts(&mut out, &tree(&Dump::from(model)), 2);
    out.push('\n');
    out
}

/// A value with a line for each thing in it, down to some depth.
fn parts(out: &mut String, value: &Value, depth: usize) {
    // Writing to a String cannot fail.
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
