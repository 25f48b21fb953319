//! Short spellings for JSON.

use fc_spec::model::{Number, Value};

/// An object.
pub(super) fn object<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::Object(entries.map(|(key, value)| (key.to_owned(), value)).into())
}

/// A string.
pub(super) fn text(text: &str) -> Value {
    Value::String(text.to_owned())
}

/// An integer.
pub(super) fn int(value: i128) -> Value {
    Value::Number(Number::Int(value))
}

/// A fraction.
pub(super) fn float(value: f64) -> Value {
    Value::Number(Number::Float(value))
}
