//! What every file of vectors has.

use crate::emit::json::{int, object, text};
use fc_spec::model::{Model, Operation, Value};

/// Version of the files' format.
const FORMAT: i128 = 1;

/// The contents of a file about one operation, or about none.
pub(super) fn contents(
    model: &Model,
    operation: Option<&Operation>,
    accepted: Vec<Value>,
    rejected: Vec<Value>,
) -> Value {
    let name = operation.map(|operation| text(&operation.name));
    let kind = operation.map(|operation| text(operation.kind().name()));
    let code = operation
        .and_then(|operation| operation.code.value)
        .map(int);
    object([
        ("format", int(FORMAT)),
        ("version", text(&model.protocol.version)),
        ("operation", name.unwrap_or(Value::Null)),
        ("kind", kind.unwrap_or(Value::Null)),
        ("code", code.unwrap_or(Value::Null)),
        ("accepted", Value::Array(accepted)),
        ("rejected", Value::Array(rejected)),
    ])
}
