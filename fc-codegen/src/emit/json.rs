//! Short spellings for JSON.

use fc_spec::model::{Number, Value};

/// An object.
pub(super) fn object<'k>(entries: impl IntoIterator<Item = (&'k str, Value)>) -> Value {
    let entries = entries.into_iter();
    Value::Object(
        entries
            .map(|(key, value)| (key.to_owned(), value))
            .collect(),
    )
}

/// A string.
pub(super) fn text(text: &str) -> Value {
    Value::String(text.to_owned())
}

/// An integer.
pub(super) fn int(value: impl Into<i128>) -> Value {
    Value::Number(Number::Int(value.into()))
}

/// A fraction.
pub(super) fn float(value: f64) -> Value {
    Value::Number(Number::Float(value))
}

/// Bytes as lower-case hexadecimal digits, without anything around them.
pub(super) fn hex(bytes: &[u8]) -> String {
    let digits: Vec<u8> = bytes.iter().copied().flat_map(hex_digits).collect();
    // Digits are ASCII.
    String::from_utf8(digits).unwrap_or_default()
}

/// The two lower-case hexadecimal digits of a byte, in ASCII. Of all that is made, they are the most, and formatting
/// each byte takes ten times as long.
pub(super) fn hex_digits(byte: u8) -> [u8; 2] {
    [byte >> 4, byte & 0xF].map(|half| match half {
        0..=9 => b'0' + half,
        _ => b'a' - 10 + half,
    })
}
