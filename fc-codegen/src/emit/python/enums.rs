//! Enums, and the rules for their values as states.

use super::literal::wire;
use super::source::{Code, Python};
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::items::{Item, Spelled};
use crate::package::process::{self, has_states, next_values};
use crate::package::source::Source;
use fc_spec::model::{EnumType, EnumValue, StateOrder, TypeDef};

/// Returns `true` if the values of an enum are states of a process.
///
/// They are states if the spec has rules for them, or if a report has the enum as its state.
pub fn is_state(context: &Context<'_>, shape: &EnumType, ty: &TypeDef) -> bool {
    has_states(shape)
        || context.model().operations.iter().any(|report| {
            process::state(context, report).is_some_and(|(_, state, _)| state.name() == ty.name)
        })
}

/// Writes an enum and its values.
pub fn enumeration(
    out: &mut Source,
    context: &Context<'_>,
    item: &Item<'_>,
    shape: &EnumType,
    values: &[Spelled<'_, EnumValue>],
) {
    let scalar = shape.repr.name();
    let closed = if shape.closed { ", is_open=False" } else { "" };
    out.line(format!("@rt.wire_enum(\"{scalar}\"{closed})"));
    let base = if is_state(context, shape, item.ty.of) {
        "rt.State"
    } else {
        "Enum"
    };
    out.suite(&format!("class {}({base})", item.ty.name), |out| {
        out.docstring(&facts::type_docs(context, item));
        for value in values {
            let docs = facts::value_docs(value);
            out.blank();
            out.line(format!("{} = {}", value.name, wire(&value.wire)));
            out.docstring(&docs);
        }
        if has_states(shape) {
            out.blank();
            states(out, shape, values);
        }
    });
}

/// Writes the rules for the values as states.
fn states(out: &mut Source, shape: &EnumType, values: &[Spelled<'_, EnumValue>]) {
    let named = |name: &str| Code::Text(format!("cls.{name}"));
    let all = |is: fn(&EnumValue) -> bool| {
        let these = values.iter().filter(|value| is(value));
        Code::tuple(these.map(|value| named(&value.name)).collect())
    };
    let mut said = Vec::new();
    if let Some(order) = shape.order {
        let followed = values.iter().filter(|value| !value.then.is_empty());
        let followed = followed.map(|value| {
            let next = next_values(value, values);
            let next = next.map(|next| named(&next.name)).collect();
            Code::Named(format!("cls.{}: ", value.name), Box::new(Code::tuple(next)))
        });
        let followed = Code::List("{", followed.collect(), "}");
        said.push(match order {
            StateOrder::Normal => Code::named("normal", followed),
            StateOrder::Complete => Code::named("complete", followed),
        });
    }
    if values.iter().any(|value| value.is_final) {
        said.push(Code::named("final", all(|value| value.is_final)));
    }
    if values.iter().any(|value| value.is_error) {
        said.push(Code::named("error", all(|value| value.is_error)));
    }
    out.line("@classmethod");
    out.suite("def process(cls) -> rt.Process", |out| {
        out.docstring(&Docs::line([
            "规范对这些状态的说明。",
            "The description of these states in the spec.",
        ]));
        Code::call("rt.Process", said).write(out, "return ", "");
    });
}
