//! Under which values of the fields beside it a field is there, as rows show it.

use super::rows::{Place, Rows, scalar};
use fc_spec::model::{Asked, Condition, Field, Scalar, StructType, TypeShape};
use serde::Serialize;

/// A condition: fields and values with links to where they are explained.
#[derive(Debug, Serialize)]
pub(super) struct ConditionView {
    /// Whether it is there where what is asked does not hold.
    is_unless: bool,
    /// Whether it says when the field is there, and not when it is valid.
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
    /// Of a value of an enum: its name, and where the enum is shown.
    known: Option<KnownValue>,
}

#[derive(Debug, Serialize)]
struct KnownValue {
    name: String,
    href: String,
}

impl<'m> Rows<'_, 'm> {
    /// The condition of a field of a struct that is listed at `place`.
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
            href: self
                .page
                .link((self.page, place.field(&asked.wire).anchor())),
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
