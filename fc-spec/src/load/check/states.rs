//! Enums whose values are the states of a process.

use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::load::draft::{Draft, Part, TypeDraft};
use crate::load::grammar::{ENUM, ENUM_VALUE};
use crate::model::{EnumType, EnumValue, TypeShape};
use std::collections::HashSet;

/// Enums with their drafts.
fn enums<'d, 'a>(draft: &'d Draft<'a>) -> impl Iterator<Item = (&'d TypeDraft<'a>, &'d EnumType)> {
    draft.types.iter().filter_map(|ty| match &ty.def.shape {
        TypeShape::Enum(shape) => Some((ty, shape)),
        TypeShape::Struct(_) | TypeShape::OneOf(_) => None,
    })
}

/// Values with their places.
fn values<'d, 'a>(
    ty: &'d TypeDraft<'a>,
    shape: &'d EnumType,
) -> impl Iterator<Item = (&'d EnumValue, &'d Part<'a>)> {
    shape.values.iter().zip(&ty.parts)
}

/// What follows what is claimed in one sense, and a sense has something that it is of.
pub(super) fn check_order(draft: &Draft<'_>, faults: &mut Faults) {
    for (ty, shape) in enums(draft) {
        let node = ENUM.order.of(ty.place.node);
        let mut following = values(ty, shape).filter_map(|(value, part)| {
            let then = ENUM_VALUE.then.entry(part.place.node);
            let start = ENUM_VALUE.start.entry(part.place.node);
            then.or(start.filter(|_| value.start))
        });
        let first = following.next();
        let fault = match (node, first) {
            (Some(order), None) => Diagnostic::error(
                FaultCode::OrderWithoutStates,
                order.span(),
                "an order is claimed, but no value says what follows it",
            )
            .note("say it with `then:`, such as `then: [running]`"),
            (None, Some(entry)) => Diagnostic::error(
                FaultCode::OrderWithoutStates,
                entry.key.span(),
                "is this the normal order, or every change there is?",
            )
            .also(ty.place.name(), "this enum has no `order`")
            .note("write `order: normal` or `order: complete` beside `values:`"),
            _ => continue,
        };
        faults.push(fault);
    }
}

/// What follows a value is a value of the same enum.
pub(super) fn check_names(draft: &Draft<'_>, faults: &mut Faults) {
    for (ty, shape) in enums(draft) {
        let names: HashSet<&str> = shape.values.iter().map(|it| it.name.as_str()).collect();
        for (_, part) in values(ty, shape) {
            for node in ENUM_VALUE.then.items(part.place.node) {
                let Some(name) = node.as_str().filter(|name| !names.contains(name)) else {
                    continue;
                };
                let message = format!("`{}` has no value `{name}`", ty.def.name);
                let span = node.span();
                let fault = Diagnostic::error(FaultCode::UnknownValue, span, message);
                let known = shape.values.iter().map(|value| value.name.as_str());
                faults.push(match nearest(name, known) {
                    Some(near) => fault.fix(span, near, format!("did you mean `{near}`?")),
                    None => fault.note("name it as the `name` of the value says"),
                });
            }
        }
    }
}

/// Nothing follows what is final.
pub(super) fn check_final(draft: &Draft<'_>, faults: &mut Faults) {
    for (ty, shape) in enums(draft) {
        for (value, part) in values(ty, shape) {
            let then = ENUM_VALUE.then.entry(part.place.node);
            if let Some(then) = then.filter(|_| value.is_final) {
                let message = format!("`{}` is final, so nothing follows it", value.name);
                let fault = Diagnostic::error(FaultCode::FollowedFinal, then.key.span(), message);
                faults.push(fault.also(part.place.at(ENUM_VALUE.r#final), "said here"));
            }
        }
    }
}

/// A process comes to each of its states: it begins there, or another leads there. Failing may happen anywhere.
pub(super) fn check_reached(draft: &Draft<'_>, faults: &mut Faults) {
    for (ty, shape) in enums(draft) {
        if shape.values.iter().all(|value| value.then.is_empty()) {
            continue;
        }
        let others = shape.values.iter().flat_map(|value| {
            let then = value.then.iter();
            then.filter(|next| **next != value.name)
        });
        let reached: HashSet<&str> = others.map(String::as_str).collect();
        for (value, part) in values(ty, shape) {
            let is_state = value.is_final || !value.then.is_empty();
            let begins = value.start || value.is_error;
            if is_state && !begins && !reached.contains(value.name.as_str()) {
                let message = format!("no value leads to `{}`", value.name);
                faults.push(
                    Diagnostic::error(FaultCode::UnreachedState, part.place.name(), message)
                        .note("write `start: true` where the process begins with it, or name it in a `then:`"),
                );
            }
        }
    }
}
