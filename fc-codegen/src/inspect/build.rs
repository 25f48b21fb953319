//! Pieces of JSON that stand in many places.

use fc_spec::model::{
    Aliases, Change, Deprecation, FloatKind, Location, Number, Scalar, Text, Type, Value,
};

/// An object with these entries.
pub(super) fn object<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::Object(
        entries
            .into_iter()
            .map(|(key, value)| (key.to_owned(), value))
            .collect(),
    )
}

/// `first`, then the entries of a text, then `last`.
pub(super) fn described<const N: usize, const M: usize>(
    first: [(&str, Value); N],
    text: &Text,
    last: [(&str, Value); M],
) -> Value {
    let owned = |(key, value): (&str, Value)| (key.to_owned(), value);
    let mut entries: Vec<_> = first.into_iter().map(owned).collect();
    entries.extend(text_entries(text));
    entries.extend(last.into_iter().map(owned));
    Value::Object(entries)
}

/// `zh` and `en`.
pub(super) fn text_entries(text: &Text) -> [(String, Value); 2] {
    [
        ("zh".to_owned(), string(&text.zh)),
        ("en".to_owned(), string(&text.en)),
    ]
}

/// `{ zh, en }`.
pub(super) fn text(text: &Text) -> Value {
    Value::Object(text_entries(text).into())
}

/// `{ zh, en }`, lists of words.
pub(super) fn aliases(aliases: &Aliases) -> Value {
    object([
        ("zh", list(&aliases.zh, |word| string(word))),
        ("en", list(&aliases.en, |word| string(word))),
    ])
}

/// A value of each item.
pub(super) fn list<T>(items: &[T], value: impl FnMut(&T) -> Value) -> Value {
    items.iter().map(value).collect()
}

/// A string.
pub(super) fn string(text: &str) -> Value {
    Value::String(text.to_owned())
}

/// A number.
pub(super) fn number(value: impl Into<i128>) -> Value {
    Value::Number(Number::Int(value.into()))
}

/// A size.
pub(super) fn size(value: usize) -> Value {
    number(i128::try_from(value).unwrap_or(i128::MAX))
}

/// The value, or `null`.
pub(super) fn or_null<T>(option: Option<T>, value: impl FnOnce(T) -> Value) -> Value {
    option.map_or(Value::Null, value)
}

/// A scalar of the spec.
pub(super) fn scalar(scalar: &Scalar) -> Value {
    match scalar {
        Scalar::Bool(value) => Value::Bool(*value),
        Scalar::Number(value) => Value::Number(value.clone()),
        Scalar::String(value) => string(value),
    }
}

/// `{ file, line }`.
pub(super) fn place(location: &Location) -> Value {
    object([
        ("file", string(&location.file)),
        ("line", size(location.line)),
    ])
}

/// `{ date, zh, en }`.
pub(super) fn dated(change: &Change) -> Value {
    described([("date", string(&change.date))], &change.text, [])
}

/// `{ since, replaced_by, zh, en }`.
pub(super) fn deprecation(deprecation: &Deprecation) -> Value {
    described(
        [
            ("since", or_null(deprecation.since.as_deref(), string)),
            (
                "replaced_by",
                or_null(deprecation.replaced_by.as_deref(), string),
            ),
        ],
        &deprecation.note,
        [],
    )
}

/// A type as the spec writes it.
pub(super) fn type_name(ty: &Type) -> String {
    match ty {
        Type::Bool => "bool".to_owned(),
        Type::Int(kind) => kind.name().to_owned(),
        Type::Float(FloatKind::F32) => "f32".to_owned(),
        Type::Float(FloatKind::F64) => "f64".to_owned(),
        Type::String => "string".to_owned(),
        Type::TimestampMs => "timestamp_ms".to_owned(),
        Type::TimestampS => "timestamp_s".to_owned(),
        Type::Base64 => "base64".to_owned(),
        Type::Json => "json".to_owned(),
        Type::Array(item) => format!("[{}]", type_name(item)),
        Type::Named(name) => name.clone(),
    }
}
