//! Checks enums whose values are the states of a process.

use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::grammar::{ENUM, ENUM_VALUE};
use crate::load::draft::{Draft, Part, TypeDraft};
use crate::model::{EnumType, EnumValue, TypeShape};
use crate::text;
use std::collections::HashSet;

/// Returns the enums with their drafts.
fn enums<'d, 'a>(draft: &'d Draft<'a>) -> impl Iterator<Item = (&'d TypeDraft<'a>, &'d EnumType)> {
    draft.types.iter().filter_map(|ty| match &ty.def.shape {
        TypeShape::Enum(shape) => Some((ty, shape)),
        TypeShape::Struct(_) | TypeShape::OneOf(_) => None,
    })
}

/// Returns the values with their places.
fn values<'d, 'a>(
    ty: &'d TypeDraft<'a>,
    shape: &'d EnumType,
) -> impl Iterator<Item = (&'d EnumValue, &'d Part<'a>)> {
    shape.values.iter().zip(&ty.parts)
}

/// Checks that an enum has `order` exactly if a value has `then` or `start`.
pub(super) fn check_order(draft: &Draft<'_>, faults: &mut Faults) {
    for (ty, shape) in enums(draft) {
        let node = ENUM.order.of(ty.origin.node);
        let mut following = values(ty, shape).filter_map(|(value, part)| {
            let then = ENUM_VALUE.then.entry(part.origin.node);
            let start = ENUM_VALUE.start.entry(part.origin.node);
            then.or(start.filter(|_| value.start))
        });
        let first = following.next();
        let code = FaultCode::OrderWithoutStates;
        let fault = match (node, first) {
            (Some(order), None) => {
                let message = text!(
                    "枚举有 `order`，但没有取值写 `then`",
                    "the enum has `order`, but none of its values has `then`"
                );
                let fault = Diagnostic::error(code, order.span(), message);
                fault.note(text!(
                    "在取值上写 `then:`，例如 `then: [running]`",
                    "write `then:` on a value, such as `then: [running]`"
                ))
            }
            (None, Some(entry)) => {
                let message = text!(
                    "取值写了 `then` 或 `start`，但枚举没有 `order`",
                    "a value has `then` or `start`, but the enum has no `order`"
                );
                let fault = Diagnostic::error(code, entry.key.span(), message);
                let fault = fault.also(ty.origin.name(), text!("这个枚举", "this enum"));
                fault.note(text!(
                    "在枚举上写 `order: normal`（正常顺序）或 `order: complete`（全部切换）",
                    "write `order: normal` (the normal order) or `order: complete` (all changes) on the enum"
                ))
            }
            _ => continue,
        };
        faults.push(fault);
    }
}

/// Checks that `then` names values of the same enum.
pub(super) fn check_names(draft: &Draft<'_>, faults: &mut Faults) {
    for (ty, shape) in enums(draft) {
        let names: HashSet<&str> = shape.values.iter().map(|it| it.name.as_str()).collect();
        for (_, part) in values(ty, shape) {
            for node in ENUM_VALUE.then.items(part.origin.node) {
                let Some(name) = node.as_str().filter(|name| !names.contains(name)) else {
                    continue;
                };
                let message = text!(
                    "`{ty}` 没有取值 `{name}`",
                    "`{ty}` has no value `{name}`",
                    ty = ty.def.name
                );
                let fault = Diagnostic::error(FaultCode::UnknownValue, node.span(), message);
                let known = shape.values.iter().map(|value| value.name.as_str());
                let note = text!("写取值的 `name`", "write the `name` of a value");
                faults.push(fault.suggest(nearest(name, known), Some(note)));
            }
        }
    }
}

/// Checks that a final value has no `then`.
pub(super) fn check_final(draft: &Draft<'_>, faults: &mut Faults) {
    for (ty, shape) in enums(draft) {
        for (value, part) in values(ty, shape) {
            let then = ENUM_VALUE.then.entry(part.origin.node);
            if let Some(then) = then.filter(|_| value.is_final) {
                let message = text!(
                    "`{value}` 是终态，不能有 `then`",
                    "`{value}` is final, so it cannot have `then`",
                    value = value.name
                );
                let fault = Diagnostic::error(FaultCode::FollowedFinal, then.key.span(), message);
                faults.push(fault.also(
                    part.origin.at(ENUM_VALUE.r#final),
                    text!("在这里写为终态", "marked as final here"),
                ));
            }
        }
    }
}

/// Checks that each state is reachable: it is a start, or another state leads to it. An error state needs no
/// predecessor.
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
                let message = text!(
                    "没有取值通向 `{value}`",
                    "no value leads to `{value}`",
                    value = value.name
                );
                let span = part.origin.name();
                let note = text!(
                    "过程由它开始时写 `start: true`，否则在某个取值的 `then:` 中写上它",
                    "write `start: true` if the process begins with it, or name it in the `then:` of another value"
                );
                let fault = Diagnostic::error(FaultCode::UnreachedState, span, message);
                faults.push(fault.note(note));
            }
        }
    }
}
