//! TypeScript types of fields and messages, and the imports of the package's files.

use crate::package::items::Shape;
use crate::package::language::{Role, TYPESCRIPT};
use crate::package::types::in_lists;
use fc_spec::model::{EnumRepr, Field, IntKind, Number, Type};

pub use crate::package::context::{Context, page_of};

/// The largest integer up to which a `number` is exact.
const SAFE: i128 = (1 << 53) - 1;

/// Returns the type of a field without its optional mark. An id field has its id type, if one exists.
pub fn field_type(context: &Context<'_>, field: &Field) -> String {
    match context.package.id_of(field) {
        Some(id) => in_lists(&field.ty, &id.name, |item| format!("{item}[]")),
        None => type_of(context, &field.ty, is_large(context, field)),
    }
}

/// Returns the type of a type of the spec; `large` makes its integers `bigint`.
pub fn type_of(context: &Context<'_>, ty: &Type, large: bool) -> String {
    match ty {
        Type::Bool => "boolean".to_owned(),
        Type::Int(_) | Type::TimestampMs | Type::TimestampS if large => "bigint".to_owned(),
        Type::Int(_) | Type::TimestampMs | Type::TimestampS | Type::Float(_) => "number".to_owned(),
        Type::String => "string".to_owned(),
        Type::Base64 => "Uint8Array".to_owned(),
        Type::Json => own(context, "JsonText"),
        Type::Array(item) => [&type_of(context, item, large), "[]"].concat(),
        Type::Named(named) => context.name_of(named).to_owned(),
    }
}

/// Returns `true` if the integers of a field are `bigint`.
pub fn is_large(context: &Context<'_>, field: &Field) -> bool {
    match field.ty.item() {
        Type::Named(named) => {
            let shape = &context.package.item(named).shape;
            matches!(shape, Shape::Enum(shape, _) if repr_is_large(shape.repr))
        }
        ty => is_64_bit(ty) && !is_safe(context, field),
    }
}

/// Returns the local name of a runtime type in files that have types of the spec.
///
/// The name ends in `$` if a type of the spec has the same name.
pub fn own(context: &Context<'_>, name: &str) -> String {
    let mark = if context.package.has_type(name) {
        "$"
    } else {
        ""
    };
    [name, mark].concat()
}

/// Spells a name that needs no check for clashes.
pub fn spelled(role: Role, words: &str) -> String {
    TYPESCRIPT.spelled(role, words).into_owned()
}

/// Returns a runtime type as an import names it.
pub fn imported(context: &Context<'_>, name: &str) -> String {
    let local = own(context, name);
    if local == name {
        local
    } else {
        format!("{name} as {local}")
    }
}

/// Returns `true` for integers that a `number` may not hold exactly.
pub fn is_64_bit(ty: &Type) -> bool {
    matches!(
        ty,
        Type::Int(IntKind::I64 | IntKind::U64) | Type::TimestampMs | Type::TimestampS
    )
}

/// Returns `true` if the values of an enum are `bigint`.
pub fn repr_is_large(repr: EnumRepr) -> bool {
    matches!(repr, EnumRepr::Int(IntKind::I64 | IntKind::U64))
}

/// Returns `true` for a 64-bit integer that is a `number`, because its range fits. An id has the same type in every field.
pub fn is_safe(context: &Context<'_>, field: &Field) -> bool {
    let fits = |number: &Option<Number>, or: i128| match number {
        Some(Number::Int(value)) => value.abs() <= SAFE,
        Some(Number::Float(_)) => false,
        None => or.abs() <= SAFE,
    };
    let least = match field.ty.item() {
        Type::Int(IntKind::U64) => 0,
        _ => i128::MAX,
    };
    let details = field.details();
    is_64_bit(field.ty.item())
        && context.package.id_of(field).is_none()
        && fits(&details.constraints.min, least)
        && fits(&details.constraints.max, i128::MAX)
}
