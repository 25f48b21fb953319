//! What most checks go through: each field and its place.

use crate::load::draft::{Draft, Part, TypeDraft};
use crate::model::{Field, Kind, Text, Type, TypeShape};
use crate::text;

/// Every field that is sound enough to be checked, with its place and the type that holds it.
pub(super) fn fields<'d, 'a>(
    draft: &'d Draft<'a>,
) -> impl Iterator<Item = (&'d TypeDraft<'a>, &'d Field, Part<'a>)> {
    draft.types.iter().flat_map(|ty| {
        let fields = match &ty.def.shape {
            TypeShape::Struct(shape) => shape.fields.as_slice(),
            TypeShape::Enum(_) | TypeShape::OneOf(_) => &[],
        };
        let parts = fields.iter().zip(ty.parts.iter().copied());
        parts
            .filter(|(_, part)| !part.broken)
            .map(move |(field, part)| (ty, field, part))
    })
}

/// [`fields`] whose type is known. What an unknown one is good for is no question: that it is unknown is reported.
pub(super) fn typed_fields<'d, 'a>(
    draft: &'d Draft<'a>,
) -> impl Iterator<Item = (&'d TypeDraft<'a>, &'d Field, Part<'a>)> {
    fields(draft).filter(|(_, field, _)| match &field.ty {
        Type::Named(named) => draft.type_named(named.name()).is_some(),
        _ => true,
    })
}

/// What an operation of this kind is called.
pub(super) fn called(kind: Kind) -> Text {
    match kind {
        Kind::Command => text!("指令", "command"),
        Kind::Report => text!("上报", "report"),
        Kind::Stream => text!("数据流", "stream"),
    }
}
