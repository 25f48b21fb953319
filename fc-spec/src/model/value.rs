//! Numbers, scalars, and JSON values that keep the order of their keys, as the wire does.

use super::schema::fixed_schema;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde::ser::{Serialize, Serializer};
use std::fmt::{self, Write as _};

/// A number as the spec writes it, without rounding.
#[derive(Clone, Debug, PartialEq)]
pub enum Number {
    /// An integer.
    Int(i128),
    /// A decimal fraction.
    Float(f64),
}

/// A scalar of the spec.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    /// `true`, `false`.
    Bool(bool),
    /// A number.
    Number(Number),
    /// A string.
    String(String),
}

/// A JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `null`.
    Null,
    /// `true`, `false`.
    Bool(bool),
    /// A number.
    Number(Number),
    /// A string.
    String(String),
    /// An array.
    Array(Vec<Value>),
    /// An object, with its keys in wire order.
    Object(Vec<(String, Value)>),
}

impl Number {
    /// Returns the nearest float. An integer above 2^53 can lose digits.
    #[must_use]
    #[allow(
        clippy::cast_precision_loss,
        reason = "the nearest value is what is wanted"
    )]
    pub fn to_f64(&self) -> f64 {
        match self {
            Self::Int(value) => *value as f64,
            Self::Float(value) => *value,
        }
    }
}

impl Value {
    /// Returns the value of a key, if this is an object with that key.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&Value> {
        match self {
            Self::Object(entries) => entries
                .iter()
                .find(|(name, _)| name == key)
                .map(|(_, value)| value),
            _ => None,
        }
    }

    /// Returns the value of a key for changes, if this is an object with that key.
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Value> {
        match self {
            Self::Object(entries) => entries
                .iter_mut()
                .find(|(name, _)| name == key)
                .map(|(_, value)| value),
            _ => None,
        }
    }

    /// Sets the value of a key, if this is an object. A new key comes last.
    pub fn set(&mut self, key: &str, value: Value) {
        if let Some(there) = self.get_mut(key) {
            *there = value;
        } else if let Self::Object(entries) = self {
            entries.push((key.to_owned(), value));
        }
    }

    /// Returns the items, if this is an array.
    pub fn items_mut(&mut self) -> impl Iterator<Item = &mut Value> {
        match self {
            Self::Array(items) => items.iter_mut(),
            _ => [].iter_mut(),
        }
    }

    /// Returns the levels of nesting: 0 for a number, 1 for a list of numbers.
    pub(crate) fn levels(&self) -> u32 {
        let inner = match self {
            Self::Array(items) => items.iter().map(Self::levels).max(),
            Self::Object(entries) => entries.iter().map(|(_, value)| value.levels()).max(),
            _ => return 0,
        };
        inner.unwrap_or_default().saturating_add(1)
    }

    /// Returns indented JSON, two spaces per level, without a final newline.
    #[must_use]
    pub fn pretty(&self) -> String {
        let mut out = String::new();
        self.write(&mut out, Some(0));
        out
    }

    /// Appends the value to `out`. With a depth, each item is on its own indented line. Without a depth, all is on one line.
    fn write(&self, out: &mut String, depth: Option<usize>) {
        match self {
            Self::Null => out.push_str("null"),
            Self::Bool(value) => out.push_str(if *value { "true" } else { "false" }),
            Self::Number(Number::Int(value)) => out.push_str(&value.to_string()),
            Self::Number(Number::Float(value)) => {
                // Writing to a String cannot fail.
                let _ = write!(out, "{value:?}");
            }
            Self::String(text) => write_string(out, text),
            Self::Array(items) => write_list(out, depth, ['[', ']'], items, |out, item, depth| {
                item.write(out, depth);
            }),
            Self::Object(entries) => {
                let colon = if depth.is_some() { ": " } else { ":" };
                write_list(
                    out,
                    depth,
                    ['{', '}'],
                    entries,
                    |out, (key, value), depth| {
                        write_string(out, key);
                        out.push_str(colon);
                        value.write(out, depth);
                    },
                );
            }
        }
    }
}

impl From<&Scalar> for Value {
    fn from(scalar: &Scalar) -> Self {
        match scalar {
            Scalar::Bool(value) => Self::Bool(*value),
            Scalar::Number(number) => Self::Number(number.clone()),
            Scalar::String(text) => Self::String(text.clone()),
        }
    }
}

impl FromIterator<Value> for Value {
    fn from_iter<T: IntoIterator<Item = Value>>(items: T) -> Self {
        Self::Array(items.into_iter().collect())
    }
}

/// Writes compact JSON.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The capacity is enough for most bodies.
        let mut out = String::with_capacity(256);
        self.write(&mut out, None);
        f.write_str(&out)
    }
}

/// Writes an array or an object. `write` appends each item.
fn write_list<T>(
    out: &mut String,
    depth: Option<usize>,
    [open, close]: [char; 2],
    items: &[T],
    write: impl Fn(&mut String, &T, Option<usize>),
) {
    let inside = depth.map(|depth| depth + 1);
    out.push(open);
    for (index, item) in items.iter().enumerate() {
        if index > 0 {
            out.push(',');
        }
        begin_line(out, inside);
        write(out, item, inside);
    }
    if !items.is_empty() {
        begin_line(out, depth);
    }
    out.push(close);
}

fn begin_line(out: &mut String, depth: Option<usize>) {
    if let Some(depth) = depth {
        out.push('\n');
        for _ in 0..depth {
            out.push_str("  ");
        }
    }
}

/// Writes a JSON string. It escapes only what JSON requires, so Chinese text stays readable.
fn write_string(out: &mut String, text: &str) {
    out.push('"');
    let needs_escape = |byte: u8| matches!(byte, b'"' | b'\\' | 0..b' ');
    let mut rest = text;
    // Long texts are mostly digits without escapes. A loop without early exit checks many bytes at a time.
    if !rest
        .bytes()
        .fold(false, |found, byte| found | needs_escape(byte))
    {
        out.push_str(rest);
        rest = "";
    }
    while let Some(at) = rest.bytes().position(needs_escape) {
        // An escaped character is ASCII, so it is one byte long.
        let (plain, from) = rest.split_at(at);
        let (escaped, behind) = from.split_at(1);
        out.push_str(plain);
        match escaped {
            "\"" => out.push_str("\\\""),
            "\\" => out.push_str("\\\\"),
            "\n" => out.push_str("\\n"),
            "\r" => out.push_str("\\r"),
            "\t" => out.push_str("\\t"),
            control => {
                for byte in control.bytes() {
                    // Writing to a String cannot fail.
                    let _ = write!(out, "\\u{byte:04x}");
                }
            }
        }
        rest = behind;
    }
    out.push_str(rest);
    out.push('"');
}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match *self {
            // Not every format has 128-bit integers.
            Self::Int(value) => match (i64::try_from(value), u64::try_from(value)) {
                (Ok(value), _) => serializer.serialize_i64(value),
                (_, Ok(value)) => serializer.serialize_u64(value),
                _ => serializer.serialize_i128(value),
            },
            Self::Float(value) => serializer.serialize_f64(value),
        }
    }
}

impl Serialize for Scalar {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Bool(value) => serializer.serialize_bool(*value),
            Self::Number(value) => value.serialize(serializer),
            Self::String(text) => serializer.serialize_str(text),
        }
    }
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Null => serializer.serialize_unit(),
            Self::Bool(value) => serializer.serialize_bool(*value),
            Self::Number(value) => value.serialize(serializer),
            Self::String(text) => serializer.serialize_str(text),
            Self::Array(items) => serializer.collect_seq(items),
            Self::Object(entries) => {
                serializer.collect_map(entries.iter().map(|(key, value)| (key, value)))
            }
        }
    }
}

impl<'de> Deserialize<'de> for Value {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AnyValue)
    }
}

struct AnyValue;

impl<'de> Visitor<'de> for AnyValue {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(Value::Number(Number::Int(value.into())))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(Value::Number(Number::Int(value.into())))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(Value::Number(Number::Float(value)))
    }

    fn visit_str<E>(self, text: &str) -> Result<Value, E> {
        Ok(Value::String(text.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = items.next_element()? {
            values.push(value);
        }
        Ok(Value::Array(values))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut values = Vec::new();
        while let Some(entry) = entries.next_entry()? {
            values.push(entry);
        }
        Ok(Value::Object(values))
    }
}

impl<'de> Deserialize<'de> for Scalar {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Value::deserialize(deserializer)? {
            Value::Bool(value) => Ok(Self::Bool(value)),
            Value::Number(value) => Ok(Self::Number(value)),
            Value::String(text) => Ok(Self::String(text)),
            _ => Err(D::Error::custom("neither a bool nor a number nor a text")),
        }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Value::deserialize(deserializer)? {
            Value::Number(value) => Ok(value),
            _ => Err(D::Error::custom("not a number")),
        }
    }
}

fixed_schema!(Number, { "type": "number" });
fixed_schema!(Scalar, { "type": ["boolean", "number", "string"] });
fixed_schema!(Value, {});
