//! Constants of the spec in TypeScript: table rows, samples and constraints.

use super::context::{Context, is_large, repr_is_large};
use super::layout::Layout;
use super::source::float;
use crate::package::expr::{Expr, Record};
use crate::package::items::Shape;
use fc_spec::model::{EnumRepr, Number, Scalar};
use std::collections::BTreeSet;

/// Returns an integer; `large` makes it a `bigint`.
pub fn integer(value: i128, large: bool) -> Layout {
    Layout::Number(if large {
        format!("{value}n")
    } else {
        value.to_string()
    })
}

/// Returns the number of a constraint.
pub fn number(number: &Number, large: bool) -> Layout {
    match number {
        Number::Int(value) => integer(*value, large),
        Number::Float(value) => Layout::Number(float(*value)),
    }
}

/// Returns an enum value in its wire form.
pub fn wire(wire: &Scalar, repr: EnumRepr) -> Layout {
    match wire {
        Scalar::Number(value) => number(value, repr_is_large(repr)),
        Scalar::String(text) => Layout::text(text),
        Scalar::Bool(value) => Layout::word(value.to_string()),
    }
}

/// Returns a constant for a file that imports all messages as one module.
///
/// `large` makes its integers `bigint`.
pub fn constant(context: &Context<'_>, expr: &Expr<'_>, large: bool) -> Layout {
    Constants::new(context, "messages.").value(expr, large)
}

/// Lays out constants, and collects the enums and id types that they name.
pub struct Constants<'c, 'm> {
    context: &'c Context<'m>,
    /// The text before the name of an enum or id type.
    prefix: &'static str,
    /// The enums and id types named so far.
    pub names: BTreeSet<String>,
}

impl<'c, 'm> Constants<'c, 'm> {
    /// Creates an instance for a file that puts `prefix` before these names.
    pub fn new(context: &'c Context<'m>, prefix: &'static str) -> Self {
        Self {
            context,
            prefix,
            names: BTreeSet::new(),
        }
    }

    /// Returns a constant; `large` makes its integers `bigint`.
    pub fn value(&mut self, expr: &Expr<'_>, large: bool) -> Layout {
        match expr {
            Expr::Bool(value) => Layout::word(value.to_string()),
            Expr::Int(value) => integer(*value, large),
            Expr::Float(value) => Layout::Number(float(*value)),
            Expr::Text(text) | Expr::Json(text) => Layout::text(text),
            Expr::Bytes(bytes) => {
                let bytes = bytes.iter().map(|byte| integer((*byte).into(), false));
                call("new Uint8Array".into(), Layout::List(bytes.collect()))
            }
            Expr::Id(id, value) => call(self.named(id), self.value(value, large)),
            Expr::List(items) => {
                let items = items.iter().map(|item| self.value(item, large));
                Layout::List(items.collect())
            }
            Expr::Record(record) => self.record(record),
            Expr::Choice(_, variant, record) => Layout::Object(vec![
                ("case".to_owned(), Layout::text(&variant.name)),
                ("value".to_owned(), self.record(record)),
            ]),
            Expr::Value(item, value) => {
                let name = self.named(&item.ty.name);
                Layout::word(format!("{name}.{}", value.name))
            }
            Expr::Unlisted(item, value) => {
                let is_large =
                    matches!(&item.shape, Shape::Enum(shape, _) if repr_is_large(shape.repr));
                self.value(value, is_large)
            }
        }
    }

    /// Returns a struct with a constant in each field. Absent fields are omitted.
    pub fn record(&mut self, record: &Record<'_>) -> Layout {
        let members = record.members.iter().filter_map(|(field, value)| {
            let value = self.value(value.as_ref()?, is_large(self.context, field));
            Some((field.name.to_string(), value))
        });
        Layout::Object(members.collect())
    }

    fn named(&mut self, name: &str) -> String {
        self.names.insert(name.to_owned());
        [self.prefix, name].concat()
    }
}

/// Returns a call with one argument.
fn call(function: String, argument: Layout) -> Layout {
    Layout::Around((function + "(").into(), Box::new(argument), ")")
}
