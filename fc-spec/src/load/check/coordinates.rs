//! Checks coordinate systems and stores, and the references to them.

use super::fields::misfit;
use super::iter::typed_fields;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::FIELD;
use crate::language::grammar::unit::is_length;
use crate::load::draft::Draft;
use crate::model::{StructType, Type, TypeShape};
use crate::text;
use std::collections::HashSet;

/// Checks that a field with `coordinates` holds objects whose struct names no other coordinate system.
pub(super) fn check_objects(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        let Some(system) = field.details().coordinates.as_deref() else {
            continue;
        };
        let Some(shape) = structure(draft, field.ty.item()) else {
            // An unknown type has its own error.
            let named = field.ty.innermost();
            if named.is_none_or(|named| draft.type_named(named.name()).is_some()) {
                let expected = text!("对象或对象的列表", "an object or a list of objects");
                let message = misfit(FIELD.coordinates.name, field, &expected);
                let span = part.origin.at(FIELD.coordinates);
                let fault = Diagnostic::error(FaultCode::CoordinatesOnWrongType, span, message);
                faults.push(fault.also_type(part.ty));
            }
            continue;
        };
        if let Some(known) = shape
            .coordinates
            .as_deref()
            .filter(|known| *known != system)
        {
            let span = part.origin.at(FIELD.coordinates);
            let message = text!(
                "`{ty}` 已经写了坐标系 `{known}`",
                "`{ty}` already has the coordinate system `{known}`",
                ty = field.ty.item()
            );
            let fault = Diagnostic::error(FaultCode::CoordinatesTwice, span, message);
            faults.push(fault.note(text!(
                "类型用于几个坐标系时，`coordinates` 只写在字段上",
                "if a type is used in several systems, write `coordinates` on the fields only"
            )));
        }
    }
}

/// Checks that an object in a coordinate system has a field with a unit of length. The unit tells how positions are
/// measured.
pub(super) fn check_lengths(draft: &Draft<'_>, faults: &mut Faults) {
    let mut push = |shape: &StructType, span, what: &str| {
        if !has_length(draft, shape, &mut HashSet::new()) {
            let message = text!(
                "{what} 没有带长度单位的字段",
                "no field of {what} has a unit of length",
                what = what
            );
            let fault = Diagnostic::error(FaultCode::CoordinatesWithoutLength, span, message);
            faults.push(fault.note(text!(
                "给位置写上 `unit`，例如 `m`",
                "write the `unit` of its positions, such as `m`"
            )));
        }
    };
    for ty in &draft.types {
        if let TypeShape::Struct(shape) = &ty.def.shape
            && shape.coordinates.is_some()
        {
            let what = format!("`{}`", ty.origin.key.as_str().unwrap_or_default());
            push(shape, ty.origin.at(FIELD.coordinates), &what);
        }
    }
    for (_, field, part) in typed_fields(draft) {
        let shape = structure(draft, field.ty.item());
        if let Some(shape) = shape.filter(|shape| shape.coordinates.is_none())
            && field.details().coordinates.is_some()
        {
            let what = format!("`{}`", field.ty.item());
            push(shape, part.origin.at(FIELD.coordinates), &what);
        }
    }
}

/// Returns `true` if a field of the struct, or of an object inside it, has a unit of length.
fn has_length<'d>(
    draft: &'d Draft<'_>,
    shape: &'d StructType,
    seen: &mut HashSet<*const StructType>,
) -> bool {
    if !seen.insert(std::ptr::from_ref(shape)) {
        return false;
    }
    shape.fields.iter().any(|field| {
        let unit = field.details().unit.as_deref();
        unit.is_some_and(is_length)
            || structure(draft, field.ty.item()).is_some_and(|it| has_length(draft, it, seen))
    })
}

fn structure<'d>(draft: &'d Draft<'_>, ty: &Type) -> Option<&'d StructType> {
    match draft.shape(ty)? {
        TypeShape::Struct(shape) => Some(shape),
        TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
    }
}
