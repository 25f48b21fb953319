//! Views of enums.

use super::available::AvailableView;
use super::desk::Desk;
use super::rows::scalar;
use super::states::StateDiagram;
use fc_spec::model::{EnumType, Operation, StateOrder, TypeDef, TypeShape};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(super) struct EnumView {
    pub(super) name: String,
    pub(super) title: String,
    pub(super) href: String,
    pub(super) repr: &'static str,
    pub(super) closed: bool,
    /// `normal` or `complete`; `None` if the values are not states.
    order: Option<&'static str>,
    states: StateDiagram,
    pub(super) values: Vec<EnumValueView>,
}

#[derive(Debug, Serialize)]
pub(super) struct EnumValueView {
    /// JSON.
    wire: String,
    name: String,
    text: String,
    is_final: bool,
    is_error: bool,
    since: Option<String>,
    available: Option<AvailableView>,
}

impl<'m> Desk<'_, 'm> {
    /// Returns the enums in the bodies of an operation, each once.
    pub(super) fn enums(&self, operation: &Operation) -> Vec<EnumView> {
        let types = self.book.types_of(operation).into_iter();
        let enums = types.filter_map(|ty| match &ty.shape {
            TypeShape::Enum(shape) => Some(self.enum_view(ty, shape)),
            TypeShape::Struct(_) | TypeShape::OneOf(_) => None,
        });
        enums.collect()
    }

    pub(super) fn enum_view(&self, ty: &'m TypeDef, shape: &EnumType) -> EnumView {
        let values = shape.values.iter().map(|value| EnumValueView {
            wire: scalar(&value.wire),
            name: value.name.clone(),
            text: self.lang.text(&value.text).to_owned(),
            is_final: value.is_final,
            is_error: value.is_error,
            since: value.since.clone(),
            available: self.available(value.available.as_ref()),
        });
        EnumView {
            name: ty.name.clone(),
            title: self.lang.text(&ty.title).to_owned(),
            href: self.page.link(self.book.place_of_type(ty)),
            repr: shape.repr.name(),
            closed: shape.closed,
            order: shape.order.map(StateOrder::name),
            states: StateDiagram::of(shape),
            values: values.collect(),
        }
    }
}
