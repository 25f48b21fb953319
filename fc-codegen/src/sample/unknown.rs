//! What a newer peer may send: keys and enum values that this spec does not know.

use super::edit::{get, replaced};
use super::{Path, Samples, constraint, sites};
use fc_spec::model::{EnumRepr, EnumType, Number, Scalar, Type, TypeShape, Value};

/// Stem of the unknown key; underscores are added where an object already has such a key.
pub const UNKNOWN_KEY: &str = "unknownKey";

/// A copy of a struct's value with an unknown key at the end of it and of every object in it that
/// the spec describes.
#[must_use]
pub fn with_unknown_keys(samples: &Samples<'_>, type_name: &str, value: &Value) -> Value {
    let mut objects = vec![Path::default()];
    for site in sites(samples, type_name, value) {
        let is_object = match site.ty {
            Type::Named(name) => samples
                .type_named(name)
                .is_some_and(|ty| !matches!(ty.shape, TypeShape::Enum(_))),
            _ => false,
        };
        if site.present && is_object {
            objects.push(site.path);
        }
    }
    objects.iter().fold(value.clone(), |value, path| {
        let Some(Value::Object(entries)) = get(&value, path) else {
            return value;
        };
        let mut key = UNKNOWN_KEY.to_owned();
        while entries.iter().any(|(name, _)| *name == key) {
            key.push('_');
        }
        replaced(&value, &path.key(&key), unknown_value())
    })
}

/// A copy of a struct's value in which every open enum holds a value it does not know; `None` if
/// there is no open enum in it.
#[must_use]
pub fn with_unknown_values(samples: &Samples<'_>, type_name: &str, value: &Value) -> Option<Value> {
    let mut copy = None;
    for site in sites(samples, type_name, value) {
        let Type::Named(name) = site.ty else { continue };
        let Some(ty) = samples.type_named(name) else {
            continue;
        };
        let TypeShape::Enum(shape) = &ty.shape else {
            continue;
        };
        if site.present
            && !shape.closed
            && let Some(unknown) = unknown_enum_value(shape)
        {
            let unknown = constraint::on_the_wire(unknown, site.field.wire_form);
            copy = Some(replaced(
                copy.as_ref().unwrap_or(value),
                &site.path,
                unknown,
            ));
        }
    }
    copy
}

/// A value that fits an enum's representation and is none of its values; `None` where all of a
/// small integer's values have names.
#[must_use]
pub fn unknown_enum_value(shape: &EnumType) -> Option<Value> {
    let taken = |wanted: &Scalar| shape.values.iter().any(|value| value.wire == *wanted);
    match shape.repr {
        EnumRepr::Int(kind) => {
            let (least, most) = kind.range();
            // Small first, so that it reads well, and past every value that an author adds next.
            let from = 99.min(most);
            let mut candidates = (from..=most).chain((least..from).rev()).take(1 << 16);
            candidates
                .find(|value| !taken(&Scalar::Number(Number::Int(*value))))
                .map(|value| Value::Number(Number::Int(value)))
        }
        EnumRepr::String => {
            let mut text = "unknown_value".to_owned();
            while taken(&Scalar::String(text.clone())) {
                text.push('_');
            }
            Some(Value::String(text))
        }
    }
}

fn unknown_value() -> Value {
    Value::Object(vec![(
        "kept".to_owned(),
        Value::Array(vec![
            Value::Number(Number::Int(1)),
            Value::String("two".to_owned()),
            Value::Null,
        ]),
    )])
}
