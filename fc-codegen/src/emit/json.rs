//! Short spellings for JSON.

use fc_spec::model::{Number, Text, Value};

/// An object.
pub(super) fn object<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::Object(entries.map(|(key, value)| (key.to_owned(), value)).into())
}

/// An object that ends with its description in both languages.
pub(super) fn described<const N: usize>(about: &Text, entries: [(&str, Value); N]) -> Value {
    let languages = [("zh", text(&about.zh)), ("en", text(&about.en))];
    let entries = entries.into_iter().chain(languages);
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
    // A digit at a time: of all that is made, hexadecimal digits are the most, and formatting each byte takes ten times
    // as long.
    let digit = |half: u8| char::from_digit(half.into(), 16).unwrap_or_default();
    let halves = bytes.iter().flat_map(|byte| [byte >> 4, byte & 0xF]);
    let mut digits = String::with_capacity(bytes.len() * 2);
    digits.extend(halves.map(digit));
    digits
}
