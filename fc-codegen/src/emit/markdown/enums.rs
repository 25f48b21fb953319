//! Views of enums.

use super::desk::Desk;
use super::rows::scalar;
use super::states::diagram;
use fc_spec::model::{EnumType, EnumValue, Operation, StateOrder, TypeDef, TypeShape};
use minijinja::{Value, context};

impl<'m> Desk<'_, 'm> {
    /// Returns the enums in the bodies of an operation, each once.
    pub(super) fn enums(&self, operation: &Operation) -> Vec<Value> {
        let types = self.book.types_of(operation).into_iter();
        let enums = types.filter_map(|ty| match &ty.shape {
            TypeShape::Enum(shape) => Some(self.enum_view(ty, shape)),
            TypeShape::Struct(_) | TypeShape::OneOf(_) => None,
        });
        enums.collect()
    }

    /// Returns the view of an enum. Its order is `normal` or `complete`, or absent if the values are not states.
    pub(super) fn enum_view(&self, ty: &'m TypeDef, shape: &EnumType) -> Value {
        let value = |value: &EnumValue| {
            context! {
                wire => scalar(&value.wire),
                name => &value.name,
                text => self.lang.text(&value.text),
                is_final => value.is_final,
                is_error => value.is_error,
                since => &value.since,
                available => self.available(value.available.as_ref()),
            }
        };
        context! {
            name => &ty.name,
            title => self.lang.text(&ty.title),
            href => self.page.link(self.book.place_of_type(ty)),
            repr => shape.repr.name(),
            closed => shape.closed,
            order => shape.order.map(StateOrder::name),
            states => diagram(shape),
            values => shape.values.iter().map(value).collect::<Vec<_>>(),
        }
    }
}
