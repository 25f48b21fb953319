//! Enums whose values are the states of a process.

use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::load::draft::{Draft, Part, TypeDraft};
use crate::load::grammar::{ENUM, ENUM_VALUE};
use crate::model::{EnumType, EnumValue, TypeShape};
use crate::text;
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
                text!(
                    "写明了顺序，却没有取值写明下一步",
                    "an order is claimed, but no value says what follows it"
                ),
            )
            .note(text!(
                "用 `then:` 写明，例如 `then: [running]`",
                "say it with `then:`, such as `then: [running]`"
            )),
            (None, Some(entry)) => Diagnostic::error(
                FaultCode::OrderWithoutStates,
                entry.key.span(),
                text!(
                    "这是正常顺序，还是全部的切换？",
                    "is this the normal order, or every change there is?"
                ),
            )
            .also(
                ty.place.name(),
                text!("这个枚举没有 `order`", "this enum has no `order`"),
            )
            .note(text!(
                "在 `values:` 旁边写 `order: normal` 或 `order: complete`",
                "write `order: normal` or `order: complete` beside `values:`"
            )),
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
                let message = text!(
                    "`{ty}` 没有取值 `{name}`",
                    "`{ty}` has no value `{name}`",
                    ty = ty.def.name
                );
                let span = node.span();
                let fault = Diagnostic::error(FaultCode::UnknownValue, span, message);
                let known = shape.values.iter().map(|value| value.name.as_str());
                faults.push(match nearest(name, known) {
                    Some(near) => fault.fix(
                        span,
                        near,
                        text!("是否想写 `{near}`？", "did you mean `{near}`?"),
                    ),
                    None => fault.note(text!(
                        "写取值的 `name`",
                        "name it as the `name` of the value says"
                    )),
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
                let message = text!(
                    "`{value}` 是终态，后面不会再有状态",
                    "`{value}` is final, so nothing follows it",
                    value = value.name
                );
                let fault = Diagnostic::error(FaultCode::FollowedFinal, then.key.span(), message);
                faults.push(fault.also(
                    part.place.at(ENUM_VALUE.r#final),
                    text!("写在这里", "said here"),
                ));
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
                let message = text!(
                    "没有取值通向 `{value}`",
                    "no value leads to `{value}`",
                    value = value.name
                );
                faults.push(
                    Diagnostic::error(FaultCode::UnreachedState, part.place.name(), message)
                        .note(text!("过程由它开始时写 `start: true`，否则在某个 `then:` 中写上它", "write `start: true` where the process begins with it, or name it in a `then:`")),
                );
            }
        }
    }
}
