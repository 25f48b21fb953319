//! Messages of a newer peer, with keys and enum values that this spec does not have.

use super::edit::{Path, get, replaced};
use super::sites::{shape_of, sites};
use crate::emit::json::{int, object, text};
use crate::sample::{Samples, constraint};
use fc_spec::model::{EnumRepr, EnumType, Number, Scalar, StructRef, TypeShape, Value};

/// The name of the unknown key. Underscores are added if an object already has this key.
pub(super) const UNKNOWN_KEY: &str = "unknownKey";

/// Returns a copy of a struct's value. It and every object of the spec in it get an unknown key at the end.
pub(super) fn with_unknown_keys(samples: &Samples<'_>, ty: &StructRef, value: &Value) -> Value {
    let mut objects = vec![Path::default()];
    for site in sites(samples, ty, value) {
        let shape = shape_of(samples, site.ty);
        let is_object = matches!(shape, Some(TypeShape::Struct(_) | TypeShape::OneOf(_)));
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

/// Returns a copy of a struct's value in which every open enum has an unknown value. Returns `None` if it has no open
/// enum. A field with `only` accepts no unknown value.
pub(super) fn with_unknown_values(
    samples: &Samples<'_>,
    ty: &StructRef,
    value: &Value,
) -> Option<Value> {
    let mut copy = None;
    for site in sites(samples, ty, value) {
        let Some(TypeShape::Enum(shape)) = shape_of(samples, site.ty) else {
            continue;
        };
        if site.present
            && !shape.closed
            && site.field.details().constraints.only.is_empty()
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

/// Returns a value that fits the representation of an enum and is not one of its values. Returns `None` if all values
/// of a small integer have names.
pub(super) fn unknown_enum_value(shape: &EnumType) -> Option<Value> {
    let taken = |wanted: &Scalar| shape.values.iter().any(|value| value.wire == *wanted);
    match shape.repr {
        EnumRepr::Int(kind) => {
            let (least, most) = kind.range();
            // Small values come first because they are easy to read. They start above the values that an author adds
            // next.
            let from = 99.min(most);
            let mut candidates = (from..=most).chain((least..from).rev()).take(1 << 16);
            candidates
                .find(|value| !taken(&Scalar::Number(Number::Int(*value))))
                .map(int)
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
    object([("kept", Value::Array(vec![int(1), text("two"), Value::Null]))])
}
