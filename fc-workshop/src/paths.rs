//! Finds the fields and values of a message by their keys.

use fc_reflect::sample::Samples;
use fc_spec::model::{Field, Model, StructRef, StructType, Type, TypeShape, Value};

/// Returns the field at a path from a body, through lists into their items: `data.stations.x` or `data.stations[3].x`.
#[must_use]
pub fn field<'m>(model: &'m Model, body: &StructRef, path: &str) -> Option<&'m Field> {
    let mut shape = Some(model.types.structure(body));
    let mut found = None;
    for step in path.split('.') {
        let key = step.split('[').next().unwrap_or_default();
        let field = shape?.field(key)?;
        let named = field.ty.innermost().map(|named| model.types.get(named));
        shape = named.and_then(|ty| ty.shape.structure());
        found = Some(field);
    }
    found
}

/// Returns the objects that a value of a type, or an item of its list, may have.
pub(crate) fn shapes<'m>(model: &'m Model, ty: &Type) -> Vec<&'m StructType> {
    let shape = ty.innermost().map(|named| &model.types.get(named).shape);
    match shape {
        Some(TypeShape::Struct(shape)) => vec![shape],
        Some(TypeShape::OneOf(choice)) => {
            let variants = choice.variants.iter();
            let shapes = variants.map(|variant| model.types.structure(&variant.ty));
            shapes.collect()
        }
        Some(TypeShape::Enum(_)) | None => Vec::new(),
    }
}

/// Returns the value at a path of wire keys.
#[must_use]
pub fn at<'v>(value: &'v Value, keys: &[String]) -> Option<&'v Value> {
    keys.iter().try_fold(value, |value, key| value.get(key))
}

/// Returns `true` if the path of wire keys leads to values, through lists into all their items, and all of them satisfy
/// `test`.
pub(crate) fn all(value: &Value, keys: &[&str], test: &dyn Fn(&Value) -> bool) -> bool {
    match (value, keys.split_first()) {
        (Value::Array(items), _) => items.iter().all(|item| all(item, keys, test)),
        (_, None) => test(value),
        (_, Some((key, rest))) => value.get(key).is_some_and(|value| all(value, rest, test)),
    }
}

/// Visits each field of an object and of the objects in it, with its value. Absent fields are left out.
///
/// The recursion is as deep as the value.
pub(crate) fn visit(
    model: &Model,
    shape: &StructType,
    object: &mut Value,
    each: &mut dyn FnMut(&Field, &mut Value),
) {
    for field in &shape.fields {
        if let Some(value) = object.get_mut(&field.wire) {
            each(field, value);
            visit_value(model, &field.ty, value, each);
        }
    }
}

fn visit_value(
    model: &Model,
    ty: &Type,
    value: &mut Value,
    each: &mut dyn FnMut(&Field, &mut Value),
) {
    match ty {
        Type::Array(item) => {
            for value in value.items_mut() {
                visit_value(model, item, value, each);
            }
        }
        Type::Named(named) => match &model.types.get(named).shape {
            TypeShape::Struct(shape) => visit(model, shape, value, each),
            TypeShape::OneOf(choice) => {
                if let Some(variant) = Samples::new(model).variant_of(choice, value) {
                    visit(model, model.types.structure(&variant.ty), value, each);
                }
            }
            TypeShape::Enum(_) => {}
        },
        _ => {}
    }
}

/// Sets the value at a path of wire keys, through lists into all their items. A missing key is left out.
pub(crate) fn set(value: &mut Value, keys: &[&str], new: &Value) {
    if let Value::Array(_) = value {
        for item in value.items_mut() {
            set(item, keys, new);
        }
        return;
    }
    match keys.split_first() {
        None => value.clone_from(new),
        Some((key, rest)) => {
            if let Some(inner) = value.get_mut(key) {
                set(inner, rest, new);
            }
        }
    }
}
