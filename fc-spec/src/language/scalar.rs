//! The values of scalars in a spec. Only plain scalars are numbers and booleans: `"5"` is a string.

use crate::model::{Number, Scalar, Type, Value};
use crate::names;
use crate::syntax::{Node, NodeKind};

/// Returns `true` for a decimal integer with leading zeros, which some YAML readers parse as octal.
pub(crate) fn has_leading_zero(text: &str) -> bool {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    digits.len() > 1 && digits.starts_with('0') && digits.bytes().all(|b| b.is_ascii_digit())
}

/// Returns the value of a plain `true` or `false`.
pub(crate) fn bool(node: Node<'_>) -> Option<bool> {
    match node.as_plain()? {
        "true" => Some(true),
        "false" => Some(false),
        _ => None,
    }
}

/// Returns the value of a plain integer.
pub(crate) fn int(node: Node<'_>) -> Option<i128> {
    int_text(node.as_plain()?)
}

/// Parses a decimal integer without leading zeros, or a hexadecimal one after `0x`.
pub(crate) fn int_text(text: &str) -> Option<i128> {
    let (negative, digits) = match text.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, text),
    };
    let value = if let Some(hex) = digits.strip_prefix("0x") {
        if !hex.bytes().all(|b| b.is_ascii_hexdigit()) {
            return None;
        }
        i128::from_str_radix(hex, 16).ok()?
    } else {
        if has_leading_zero(digits) || !digits.bytes().all(|b| b.is_ascii_digit()) {
            return None;
        }
        digits.parse().ok()?
    };
    Some(if negative { -value } else { value })
}

/// Returns the value of a plain integer that fits `T`.
pub(crate) fn small_int<T: TryFrom<i128>>(node: Node<'_>) -> Option<T> {
    T::try_from(int(node)?).ok()
}

/// Returns the value of a plain number.
pub(crate) fn number(node: Node<'_>) -> Option<Number> {
    number_text(node.as_plain()?)
}

/// Parses an integer, or a decimal fraction in JSON notation.
pub(crate) fn number_text(text: &str) -> Option<Number> {
    if !text.starts_with(|first: char| first == '-' || first.is_ascii_digit()) {
        return None;
    }
    if let Some(value) = int_text(text) {
        return Some(Number::Int(value));
    }
    let unsigned = text.strip_prefix('-').unwrap_or(text);
    let (mantissa, exponent) = match unsigned.find(['e', 'E']) {
        Some(at) => (unsigned.get(..at)?, unsigned.get(at + 1..)),
        None => (unsigned, None),
    };
    let (whole, fraction) = match mantissa.split_once('.') {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (mantissa, None),
    };
    let is_digits = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    let exponent_digits =
        exponent.map(|exponent| exponent.strip_prefix(['-', '+']).unwrap_or(exponent));
    let well_formed = is_digits(whole)
        && !has_leading_zero(whole)
        && fraction.is_none_or(is_digits)
        && exponent_digits.is_none_or(is_digits);
    if !well_formed {
        return None;
    }
    let value: f64 = text.parse().ok()?;
    value.is_finite().then_some(Number::Float(value))
}

/// Returns the number as a float. Large integers are rounded.
#[allow(clippy::cast_precision_loss)]
pub(crate) fn float(number: &Number) -> f64 {
    match number {
        Number::Int(value) => *value as f64,
        Number::Float(value) => *value,
    }
}

/// Returns the value of a code: `0x` and four upper-case hex digits.
pub(crate) fn code(node: Node<'_>) -> Option<u16> {
    names::code(node.as_plain()?)
}

/// Returns a type, and `true` if it has the mark of an optional field.
///
/// `[T]` may also be a YAML list of one type. Names are not resolved.
pub(crate) fn field_type(node: Node<'_>) -> Option<(Type, bool)> {
    if let Some(mut items) = node.as_sequence() {
        let (Some(item), None) = (items.next(), items.next()) else {
            return None;
        };
        let (item, false) = field_type(item)? else {
            return None;
        };
        return Some((Type::Array(Box::new(item)), false));
    }
    let text = node.as_str()?;
    match text.strip_suffix('?') {
        Some(text) => Some((text.parse().ok()?, true)),
        None => Some((text.parse().ok()?, false)),
    }
}

/// Returns the text of a scalar without the newline at the end of a block scalar.
pub(crate) fn text(node: Node<'_>) -> Option<String> {
    let text = node.as_str()?;
    Some(text.strip_suffix('\n').unwrap_or(text).to_owned())
}

/// Returns a bool, a number or a string.
pub(crate) fn scalar(node: Node<'_>) -> Option<Scalar> {
    match value(node) {
        Value::Bool(value) => Some(Scalar::Bool(value)),
        Value::Number(value) => Some(Scalar::Number(value)),
        Value::String(value) => Some(Scalar::String(value)),
        _ => None,
    }
}

/// Returns the node itself, or the items of a list.
pub(crate) fn each_value(node: Node<'_>) -> impl Iterator<Item = Node<'_>> {
    let single = node.as_scalar().map(|_| node);
    node.items().chain(single)
}

/// Returns the JSON value of a node.
pub(crate) fn value(node: Node<'_>) -> Value {
    match node.kind() {
        NodeKind::Null => Value::Null,
        NodeKind::Sequence(items) => items.map(value).collect(),
        NodeKind::Mapping(entries) => Value::Object(
            entries
                .map(|entry| (entry.name().to_owned(), value(entry.value)))
                .collect(),
        ),
        NodeKind::Scalar(written) => {
            if let Some(value) = bool(node) {
                Value::Bool(value)
            } else if let Some(value) = number(node) {
                Value::Number(value)
            } else {
                Value::String(written.text.to_owned())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_are_decimal_or_hex_without_leading_zeros() {
        for (text, expected) in [
            ("0", Some(0)),
            ("-5", Some(-5)),
            ("0x0A01", Some(0x0A01)),
            ("017", None),
            ("-017", None),
            ("+5", None),
            ("1_000", None),
            ("0o17", None),
            ("0x", None),
            ("-", None),
            ("", None),
            ("99999999999999999999999999999999999999999", None),
        ] {
            assert_eq!(int_text(text), expected, "{text}");
        }
    }

    #[test]
    fn numbers_are_those_of_json_and_hex() {
        for (text, expected) in [
            ("0.5", Some(Number::Float(0.5))),
            ("-0.81532", Some(Number::Float(-0.81532))),
            ("1e3", Some(Number::Float(1000.0))),
            ("5", Some(Number::Int(5))),
            (".5", None),
            ("5.", None),
            ("00.5", None),
            ("1e999", None),
            (".inf", None),
            ("inf", None),
            ("nan", None),
            ("e5", None),
        ] {
            assert_eq!(number_text(text), expected, "{text}");
        }
    }
}
