//! Conditions of fields: the values of other fields that decide whether a field is present.

use super::desk::Desk;
use super::rows::{RowPosition, scalar};
use fc_spec::model::{Asked, Condition, Field, Scalar, StructType, TypeShape};
use minijinja::{Value, context};

impl<'m> Desk<'_, 'm> {
    /// Returns the condition of a field of the struct that is listed at `position`.
    pub(super) fn condition(
        &self,
        shape: &'m StructType,
        field: &Field,
        position: &RowPosition,
    ) -> Option<Value> {
        let condition = field.details().condition.as_ref()?;
        let asked = condition.asked().iter();
        let asked: Vec<_> = asked
            .map(|asked| self.asked(shape, asked, position))
            .collect();
        Some(context! {
            is_unless => matches!(condition, Condition::Unless(_)),
            // The condition decides the presence of an optional field, and the validity of another one.
            is_presence => field.optional,
            asked,
        })
    }

    fn asked(&self, shape: &'m StructType, asked: &Asked, position: &RowPosition) -> Value {
        let beside = shape.field(&asked.wire);
        let value = |wire: &Scalar| {
            context! {
                wire => scalar(wire),
                known => beside.and_then(|field| self.known(field, wire)),
            }
        };
        context! {
            key => &asked.wire,
            href => self.link(self.page, position.field(&asked.wire).anchor()),
            any => asked.values.iter().map(value).collect::<Vec<_>>(),
        }
    }

    /// Returns the name of an enum value, and the position of the enum.
    fn known(&self, field: &'m Field, wire: &Scalar) -> Option<Value> {
        let ty = self.book.model.types.get(field.ty.innermost()?);
        let TypeShape::Enum(shape) = &ty.shape else {
            return None;
        };
        let value = shape.values.iter().find(|value| value.wire == *wire)?;
        Some(context! {
            name => &value.name,
            href => self.page.link(self.book.place_of_type(ty)),
        })
    }
}
