//! JSON without a type, read and written by the runtime, and texts to read it from.

use fc_runtime::json::{Reader, Writer};
use fc_runtime::{BodyError, Extra, FromJson, Json, ToJson};
use proptest::collection::vec;
use proptest::prelude::*;
use std::collections::BTreeMap;

/// Any JSON value, objects with the last of equal keys.
#[derive(Clone, Debug)]
pub enum Tree {
    Null,
    Bool(bool),
    Number(f64),
    String(String),
    Array(Vec<Tree>),
    Object(BTreeMap<String, Tree>),
}

impl FromJson for Tree {
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        Ok(match reader.peek() {
            Some(b'n') if reader.take_null() => Self::Null,
            Some(b't' | b'f') => Self::Bool(reader.bool()?),
            Some(b'"') => Self::String(reader.string()?.into_owned()),
            Some(b'[') => Self::Array(reader.list(Self::read)?),
            Some(b'{') => {
                let mut object = BTreeMap::new();
                reader.begin_object()?;
                while !reader.end_object() {
                    let key = reader.key()?.into_owned();
                    object.insert(key, Self::read(reader)?);
                    reader.end_value()?;
                }
                Self::Object(object)
            }
            _ => Self::Number(reader.f64()?),
        })
    }
}

impl ToJson for Tree {
    fn write(&self, writer: &mut Writer<'_>) {
        match self {
            Self::Null => writer.null(),
            Self::Bool(value) => writer.bool(*value),
            Self::Number(value) => writer.f64(*value),
            Self::String(text) => writer.string(text),
            Self::Array(items) => writer.array(items),
            Self::Object(entries) => {
                let mut extra = Extra::new();
                for (key, value) in entries {
                    let text =
                        String::from_utf8(fc_runtime::json::to_vec(value)).unwrap_or_default();
                    extra.insert(
                        key.as_str(),
                        text.parse::<Json>().unwrap_or_else(|_| Json::null()),
                    );
                }
                let mut object = writer.object();
                object.extra(&extra);
                object.end();
            }
        }
    }
}

/// Returns `true` if `serde_json` reads the same value, floats to the last bit.
pub fn same(tree: &Tree, value: &serde_json::Value) -> bool {
    use serde_json::Value;
    match (tree, value) {
        (Tree::Null, Value::Null) => true,
        (Tree::Bool(ours), Value::Bool(theirs)) => ours == theirs,
        (Tree::Number(ours), Value::Number(theirs)) => theirs
            .as_f64()
            .is_some_and(|theirs| theirs.to_bits() == ours.to_bits()),
        (Tree::String(ours), Value::String(theirs)) => ours == theirs,
        (Tree::Array(ours), Value::Array(theirs)) => {
            ours.len() == theirs.len()
                && ours
                    .iter()
                    .zip(theirs)
                    .all(|(ours, theirs)| same(ours, theirs))
        }
        (Tree::Object(ours), Value::Object(theirs)) => {
            ours.len() == theirs.len()
                && ours
                    .iter()
                    .all(|(key, ours)| theirs.get(key).is_some_and(|theirs| same(ours, theirs)))
        }
        _ => false,
    }
}

/// Numbers as JSON may write them.
pub fn number() -> impl Strategy<Value = String> {
    prop_oneof![
        "-?(0|[1-9][0-9]{0,24})",
        "-?(0|[1-9][0-9]{0,20})\\.[0-9]{1,25}",
        "-?(0|[1-9][0-9]{0,6})(\\.[0-9]{1,6})?[eE][+-]?[0-9]{1,3}",
        any::<i64>().prop_map(|value| value.to_string()),
        any::<f64>()
            .prop_filter("finite", |value| value.is_finite())
            .prop_map(|value| format!("{value:?}")),
    ]
}

/// Strings as JSON may write them.
pub fn string() -> impl Strategy<Value = String> {
    let piece = prop_oneof![
        4 => "[ -!#-\\[\\]-~]{1,12}",
        2 => "[一-龥é€😀]{1,6}",
        2 => "\\\\[\"\\\\/bfnrt]",
        1 => "\\\\u00[0-7][0-9a-fA-F]",
        1 => "\\\\u[4-9][0-9a-fA-F]{3}",
        1 => "\\\\u[dD]8[0-9a-f]{2}\\\\u[dD][cC][0-9a-f]{2}",
        1 => "x{60,200}",
    ];
    vec(piece, 0..4).prop_map(|pieces| format!("\"{}\"", pieces.concat()))
}

fn space() -> impl Strategy<Value = &'static str> + Clone {
    prop_oneof![6 => Just(""), 2 => Just(" "), 1 => Just("\n  "), 1 => Just("\r\n\t")]
}

/// A text that is JSON.
pub fn text() -> impl Strategy<Value = String> {
    let scalar = prop_oneof![
        Just("null".to_owned()),
        Just("true".to_owned()),
        Just("false".to_owned()),
        number(),
        string(),
    ];
    let value = scalar.prop_recursive(6, 48, 6, |inner| {
        let item = (space(), inner.clone(), space())
            .prop_map(|(before, item, after)| format!("{before}{item}{after}"));
        let member = (space(), key(), space(), item.clone())
            .prop_map(|(before, key, after, item)| format!("{before}{key}{after}:{item}"));
        prop_oneof![
            vec(item, 0..6).prop_map(|items| format!("[{}]", items.join(","))),
            vec(member, 0..6).prop_map(|members| format!("{{{}}}", members.join(","))),
            Just("[ ]".to_owned()),
            Just("{ }".to_owned()),
        ]
    });
    (space(), value, space()).prop_map(|(before, value, after)| format!("{before}{value}{after}"))
}

/// Few enough keys that some come twice.
fn key() -> impl Strategy<Value = String> {
    prop_oneof![
        Just("\"a\"".to_owned()),
        Just("\"\\u0061\"".to_owned()),
        string()
    ]
}

/// A text that is nearly JSON.
pub fn mutated() -> impl Strategy<Value = String> {
    const PIECES: [&str; 34] = [
        "", "", "{", "}", "[", "]", ",", ":", "\"", "\\", "0", "1", "-", "+", ".", "e", "E", " ",
        "\n", "\u{b}", "\u{0}", "\u{1f}", "\u{7f}", "null", "nul", "tru", "\\u12", "\\ud800",
        "\\udc00", "号", "\u{feff}", "'", "/**/", "NaN",
    ];
    let edit = (
        any::<prop::sample::Index>(),
        0..3_usize,
        prop::sample::select(&PIECES[..]),
    );
    (text(), vec(edit, 1..4)).prop_map(|(text, edits)| {
        let mut characters: Vec<char> = text.chars().collect();
        for (place, removed, piece) in edits {
            let start = place.index(characters.len() + 1);
            let end = (start + removed).min(characters.len());
            characters.splice(start..end, piece.chars());
        }
        characters.into_iter().collect()
    })
}
