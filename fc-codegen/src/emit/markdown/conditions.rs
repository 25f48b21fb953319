//! Conditions of fields: the values of other fields that decide whether a field is present.

use super::desk::Desk;
use super::rows::{Place, scalar};
use fc_spec::model::{Asked, Condition, Field, Scalar, StructType, TypeShape};
use serde::Serialize;

/// A condition: fields and values with links to their descriptions.
#[derive(Debug, Serialize)]
pub(super) struct ConditionView {
    /// `true` if the field is present when the condition does not hold.
    is_unless: bool,
    /// `true` if the condition decides the presence of the field, and not its validity.
    is_presence: bool,
    asked: Vec<AskedView>,
}

#[derive(Debug, Serialize)]
struct AskedView {
    key: String,
    href: String,
    any: Vec<ValueView>,
}

#[derive(Debug, Serialize)]
struct ValueView {
    /// JSON.
    wire: String,
    /// The name of an enum value, and the place of the enum.
    known: Option<KnownValue>,
}

#[derive(Debug, Serialize)]
struct KnownValue {
    name: String,
    href: String,
}

impl<'m> Desk<'_, 'm> {
    /// Returns the condition of a field of the struct that is listed at `place`.
    pub(super) fn condition(
        &self,
        shape: &'m StructType,
        field: &Field,
        place: &Place,
    ) -> Option<ConditionView> {
        let condition = field.details().condition.as_ref()?;
        let asked = condition.asked().iter();
        Some(ConditionView {
            is_unless: matches!(condition, Condition::Unless(_)),
            is_presence: field.optional,
            asked: asked.map(|asked| self.asked(shape, asked, place)).collect(),
        })
    }

    fn asked(&self, shape: &'m StructType, asked: &Asked, place: &Place) -> AskedView {
        let beside = shape.field(&asked.wire);
        let value = |wire: &Scalar| ValueView {
            wire: scalar(wire),
            known: beside.and_then(|field| self.known(field, wire)),
        };
        AskedView {
            key: asked.wire.clone(),
            href: self.link(self.page, place.field(&asked.wire).anchor()),
            any: asked.values.iter().map(value).collect(),
        }
    }

    fn known(&self, field: &'m Field, wire: &Scalar) -> Option<KnownValue> {
        let ty = self.book.model.types.get(field.ty.innermost()?);
        let TypeShape::Enum(shape) = &ty.shape else {
            return None;
        };
        let value = shape.values.iter().find(|value| value.wire == *wire)?;
        Some(KnownValue {
            name: value.name.clone(),
            href: self.page.link(self.book.place_of_type(ty)),
        })
    }
}
