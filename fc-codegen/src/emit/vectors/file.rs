//! What every file of vectors has.

use crate::emit::json::{int, text};
use fc_spec::model::{Operation, Value};

/// Version of the files' format.
const FORMAT: i128 = 1;

/// The contents of a file about one operation, or about none. The version of the protocol is for one file alone, so that a release does
/// not change all of them.
pub(super) fn contents(
    version: Option<&str>,
    operation: Option<&Operation>,
    accepted: Vec<Value>,
    rejected: Vec<Value>,
) -> Value {
    let name = operation.map(|operation| text(&operation.name));
    let kind = operation.map(|operation| text(operation.kind().name()));
    let code = operation
        .and_then(|operation| operation.code.value)
        .map(int);
    let format = ("format", int(FORMAT));
    let version = version.map(|version| ("version", text(version)));
    let rest = [
        ("operation", name.unwrap_or(Value::Null)),
        ("kind", kind.unwrap_or(Value::Null)),
        ("code", code.unwrap_or(Value::Null)),
        ("accepted", Value::Array(accepted)),
        ("rejected", Value::Array(rejected)),
    ];
    let entries = [format].into_iter().chain(version).chain(rest);
    Value::Object(
        entries
            .map(|(key, value)| (key.to_owned(), value))
            .collect(),
    )
}
