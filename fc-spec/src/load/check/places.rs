//! Coordinate systems and stores, and what names them.

use super::each::{fields, typed_fields};
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::grammar::unit::is_length;
use crate::language::grammar::{COMMON, FIELD, FILE};
use crate::load::draft::Draft;
use crate::model::{StructType, Text, Type, TypeShape};
use crate::names;
use crate::source::Span;
use crate::text;
use std::collections::HashSet;

/// `coordinates` of a field stands where objects are, and says what their struct leaves open.
pub(super) fn check_objects(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        let Some(system) = field.details().coordinates.as_deref() else {
            continue;
        };
        let Some(shape) = structure(draft, field.ty.item()) else {
            // A list of an unknown type has been reported.
            let named = field.ty.innermost();
            if named.is_none_or(|named| draft.type_named(named.name()).is_some()) {
                let message = text!(
                    "`{coordinates}` 应用于对象或对象的列表，而 `{field}` 不是",
                    "`{coordinates}` needs an object or a list of objects, but `{field}` is not one",
                    coordinates = FIELD.coordinates.name,
                    field = field.wire
                );
                let span = part.place.at(FIELD.coordinates);
                let fault = Diagnostic::error(FaultCode::CoordinatesOnWrongType, span, message);
                faults.push(fault.also(part.ty, text!("类型", "the type")));
            }
            continue;
        };
        if let Some(known) = shape
            .coordinates
            .as_deref()
            .filter(|known| *known != system)
        {
            let span = part.place.at(FIELD.coordinates);
            let message = text!(
                "`{ty}` 已经写了坐标系 `{known}`",
                "`{ty}` already has the coordinate system `{known}`",
                ty = field.ty.item()
            );
            faults.push(
                Diagnostic::error(FaultCode::CoordinatesTwice, span, message).note(text!(
                    "类型用于几个坐标系时，`coordinates` 只写在字段上",
                    "if a type is used in several systems, write `coordinates` on the fields only"
                )),
            );
        }
    }
}

/// What is given in a coordinate system has a length, which says in what positions are measured.
pub(super) fn check_lengths(draft: &Draft<'_>, faults: &mut Faults) {
    let mut push = |shape: &StructType, span, what: &str| {
        if !has_length(draft, shape, &mut HashSet::new()) {
            let message = text!(
                "{what} 没有带长度单位的字段",
                "no field of {what} has a unit of length",
                what = what
            );
            faults.push(
                Diagnostic::error(FaultCode::CoordinatesWithoutLength, span, message).note(text!(
                    "给位置写上 `unit`，例如 `m`",
                    "write the `unit` of its positions, such as `m`"
                )),
            );
        }
    };
    for ty in &draft.types {
        if let TypeShape::Struct(shape) = &ty.def.shape
            && shape.coordinates.is_some()
        {
            let what = format!("`{}`", ty.place.key.as_str().unwrap_or_default());
            push(shape, ty.place.at(FIELD.coordinates), &what);
        }
    }
    for (_, field, part) in typed_fields(draft) {
        let shape = structure(draft, field.ty.item());
        if let Some(shape) = shape.filter(|shape| shape.coordinates.is_none())
            && field.details().coordinates.is_some()
        {
            let what = format!("`{}`", field.ty.item());
            push(shape, part.place.at(FIELD.coordinates), &what);
        }
    }
}

/// Whether a field of it, or of an object in it, is a length.
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
    let Type::Named(named) = ty else {
        return None;
    };
    match &draft.type_named(named.name())?.def.shape {
        TypeShape::Struct(shape) => Some(shape),
        TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
    }
}

/// Coordinate systems and stores that something names are declared.
pub(super) fn check_declared(draft: &Draft<'_>, faults: &mut Faults) {
    for set in [systems(draft), stores(draft)] {
        let declared: HashSet<&str> = set.declared.iter().map(|(name, _)| *name).collect();
        // What is no name has been reported.
        let users = set.users.iter().filter(|(name, _)| names::is_snake(name));
        for (name, span) in users.filter(|(name, _)| !declared.contains(name)) {
            let message = text!(
                "没有{what} `{name}`",
                "there is no {what} `{name}`",
                what = set.what
            );
            let fault = Diagnostic::error(set.unknown, *span, message);
            faults.push(match nearest(name, declared.iter().copied()) {
                Some(near) => fault.fix(
                    *span,
                    near,
                    text!("是否想写 `{near}`？", "did you mean `{near}`?"),
                ),
                None => fault.note(text!(
                    "在 `{key}:` 下声明",
                    "declare it under `{key}:`",
                    key = set.key
                )),
            });
        }
    }
}

/// Something names each of them. The one that a slip stands for is not reported a second time.
pub(super) fn check_unused(draft: &Draft<'_>, faults: &mut Faults) {
    for set in [systems(draft), stores(draft)] {
        let declared: HashSet<&str> = set.declared.iter().map(|(name, _)| *name).collect();
        let mut used: HashSet<&str> = set.users.iter().map(|(name, _)| *name).collect();
        let slips: Vec<&str> = used.difference(&declared).copied().collect();
        for slip in slips {
            used.extend(nearest(slip, declared.iter().copied()));
        }
        for (name, span) in set.declared.iter().filter(|(name, _)| !used.contains(name)) {
            let message = text!(
                "{what} `{name}` 没有用到",
                "the {what} `{name}` is not used",
                what = set.what
            );
            let note = text!(
                "在适用的地方写 `{by}`，或将它删除",
                "write `{by}` where it applies, or delete it",
                by = set.by
            );
            faults.push(Diagnostic::error(set.unused, *span, message).note(note));
        }
    }
}

/// What is declared under one key and named by another, each name with its place.
struct Names<'d> {
    what: Text,
    key: &'static str,
    by: &'static str,
    unknown: FaultCode,
    unused: FaultCode,
    declared: Vec<(&'d str, Span)>,
    users: Vec<(&'d str, Span)>,
}

fn systems<'d>(draft: &'d Draft<'_>) -> Names<'d> {
    let declared = draft.coordinates.iter();
    let of_types = draft.types.iter().filter_map(|ty| match &ty.def.shape {
        TypeShape::Struct(shape) => {
            let name = shape.coordinates.as_deref()?;
            Some((name, ty.place.at(FIELD.coordinates)))
        }
        TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
    });
    let of_fields = fields(draft).filter_map(|(_, field, part)| {
        let name = field.details().coordinates.as_deref()?;
        Some((name, part.place.at(FIELD.coordinates)))
    });
    Names {
        what: text!("坐标系", "coordinate system"),
        key: FILE.coordinates.name,
        by: FIELD.coordinates.name,
        unknown: FaultCode::UnknownCoordinates,
        unused: FaultCode::UnusedCoordinates,
        declared: declared
            .map(|it| (it.item.name.as_str(), it.place.name()))
            .collect(),
        users: of_types.chain(of_fields).collect(),
    }
}

fn stores<'d>(draft: &'d Draft<'_>) -> Names<'d> {
    let declared = draft.stores.iter();
    let operations = draft.operations.iter();
    let of_operations = operations.map(|it| (it.item.kept.as_deref(), it.place));
    let of_tables = draft.tables.iter();
    let of_tables = of_tables.map(|it| (it.item.kept.as_deref(), it.place));
    let of_fields =
        fields(draft).map(|(_, field, part)| (field.details().kept.as_deref(), part.place));
    let users = of_operations.chain(of_tables).chain(of_fields);
    Names {
        what: text!("存储位置", "store"),
        key: FILE.stores.name,
        by: COMMON.kept.name,
        unknown: FaultCode::UnknownStore,
        unused: FaultCode::UnusedStore,
        declared: declared
            .map(|it| (it.item.name.as_str(), it.place.name()))
            .collect(),
        users: users
            .filter_map(|(name, place)| Some((name?, place.at(COMMON.kept))))
            .collect(),
    }
}
