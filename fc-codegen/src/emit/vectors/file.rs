//! The common keys of all files of vectors.

use crate::emit::json::{int, object, text};
use fc_spec::model::{Operation, Value};

/// The version of the format.
const FORMAT: i128 = 1;

/// Returns the contents of a file about one operation or none. Only one file has the version of the protocol, so that a
/// release does not change all files.
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
    object([format].into_iter().chain(version).chain(rest))
}
