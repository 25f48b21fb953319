//! Iterates over the fields that most checks visit, with their places.

use crate::load::draft::{Draft, Part, TypeDraft};
use crate::model::{Field, Kind, Text, Type};
use crate::text;

/// Returns every field that is valid enough to check, with its place and its type.
pub(super) fn fields<'d, 'a>(
    draft: &'d Draft<'a>,
) -> impl Iterator<Item = (&'d TypeDraft<'a>, &'d Field, Part<'a>)> {
    draft.types.iter().flat_map(|ty| {
        let sound = ty.fields().filter(|(_, part)| !part.broken);
        sound.map(move |(field, part)| (ty, field, part))
    })
}

/// Returns the [`fields`] whose type is known. An unknown type has its own error.
pub(super) fn typed_fields<'d, 'a>(
    draft: &'d Draft<'a>,
) -> impl Iterator<Item = (&'d TypeDraft<'a>, &'d Field, Part<'a>)> {
    fields(draft).filter(|(_, field, _)| match &field.ty {
        Type::Named(named) => draft.type_named(named.name()).is_some(),
        _ => true,
    })
}

/// Returns the name of this kind of operation.
pub(super) fn called(kind: Kind) -> Text {
    match kind {
        Kind::Command => text!("指令", "command"),
        Kind::Report => text!("上报", "report"),
        Kind::Stream => text!("数据流", "stream"),
    }
}
