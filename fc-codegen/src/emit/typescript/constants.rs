//! Constants of the spec in TypeScript: rows of tables, samples, what a field takes.

use super::context::{Context, is_large, repr_is_large};
use super::layout::Layout;
use super::source::float;
use crate::surface::expr::{Expr, Record};
use crate::surface::package::Shape;
use fc_spec::model::{EnumRepr, Number, Scalar};

/// An integer of a type that may be a `bigint`.
pub fn integer(value: i128, large: bool) -> Layout {
    Layout::Number(if large {
        format!("{value}n")
    } else {
        value.to_string()
    })
}

/// A number of a constraint.
pub fn number(number: &Number, large: bool) -> Layout {
    match number {
        Number::Int(value) => integer(*value, large),
        Number::Float(value) => Layout::Number(float(*value)),
    }
}

/// What an enum's value is on the wire.
pub fn wire(wire: &Scalar, repr: EnumRepr) -> Layout {
    match wire {
        Scalar::Number(value) => number(value, repr_is_large(repr)),
        Scalar::String(text) => Layout::text(text),
        Scalar::Bool(value) => Layout::word(value.to_string()),
    }
}

/// A constant; `large` says that its integers are `bigint`.
pub fn constant(context: &Context<'_>, expr: &Expr<'_>, large: bool) -> Layout {
    match expr {
        Expr::Bool(value) => Layout::word(value.to_string()),
        Expr::Int(value) => integer(*value, large),
        Expr::Float(value) => Layout::Number(float(*value)),
        Expr::Text(text) | Expr::Json(text) => Layout::text(text),
        Expr::Bytes(bytes) => {
            let bytes = bytes.iter().map(|byte| integer((*byte).into(), false));
            Layout::Around(
                "new Uint8Array(",
                Box::new(Layout::List(bytes.collect())),
                ")",
            )
        }
        Expr::Id(_, value) => constant(context, value, large),
        Expr::List(items) => Layout::List(
            items
                .iter()
                .map(|item| constant(context, item, large))
                .collect(),
        ),
        Expr::Record(record) => fields(context, record),
        Expr::Choice(_, variant, record) => Layout::Object(vec![
            ("case".to_owned(), Layout::text(&variant.name)),
            ("value".to_owned(), fields(context, record)),
        ]),
        Expr::Value(item, value) => {
            Layout::word(format!("messages.{}.{}", item.ty.name, value.name))
        }
        Expr::Unlisted(item, value) => {
            let large = matches!(&item.shape, Shape::Enum(shape, _) if repr_is_large(shape.repr));
            constant(context, value, large)
        }
    }
}

/// A struct with a constant in each of its fields; what is absent is left out.
fn fields(context: &Context<'_>, record: &Record<'_>) -> Layout {
    let members = record.members.iter().filter_map(|(field, value)| {
        let value = constant(context, value.as_ref()?, is_large(context, field));
        Some((field.name.to_string(), value))
    });
    Layout::Object(members.collect())
}
