//! Checks the preconditions of commands.

use super::graph::{walk, walk_types};
use super::value::check_type;
use super::value_list::ValueList;
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::grammar::{ACCEPTED, COMMAND, Enum, Named};
use crate::load::draft::Draft;
use crate::model::{Kind, Text, Type, TypeRef, TypeShape};
use crate::syntax::{Entry, Node};
use crate::text;
use std::collections::{HashMap, HashSet};

/// Returns each command name with its preconditions, if it has any.
fn preconditions<'d, 'a>(draft: &'d Draft<'a>) -> impl Iterator<Item = (&'d str, Node<'a>)> {
    draft.operations.iter().filter_map(|operation| {
        let node = COMMAND.accepted.of(operation.origin.node)?;
        let is_command = operation.item.kind() == Kind::Command;
        is_command.then_some((operation.item.name.as_str(), node))
    })
}

/// Checks that preconditions are not empty.
pub(super) fn check_said(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, node) in preconditions(draft) {
        let is_empty = ACCEPTED.r#in.of(node).is_none() && ACCEPTED.after.of(node).is_none();
        if is_empty && node.as_mapping().is_some() {
            let message = text!(
                "`accepted` 没有 `in`，也没有 `after`",
                "`accepted` has neither `in` nor `after`"
            );
            let fault = Diagnostic::error(FaultCode::NoPrecondition, node.span(), message);
            faults.push(fault.note(text!(
                "任何状态都可以时写 `in: any`；不清楚时不写 `accepted`",
                "write `in: any` if every state will do; leave `accepted` out if that is unknown"
            )));
        }
    }
}

/// Checks that states are values of enums that messages of the robot carry, each once.
pub(super) fn check_states(draft: &Draft<'_>, faults: &mut Faults) {
    // Computed on demand, because most specs name no states.
    let mut carried = None;
    for (_, node) in preconditions(draft) {
        let enums = ACCEPTED.r#in.of(node).and_then(Node::as_mapping);
        for Entry { key, value } in enums.into_iter().flatten() {
            // The check of references reports an unknown enum.
            let Some(ty) = key.as_str().and_then(|name| draft.type_named(name)) else {
                continue;
            };
            let name = &ty.def.name;
            if !matches!(ty.def.shape, TypeShape::Enum(_)) {
                let message = text!(
                    "`in` 应为枚举，而 `{name}` 不是枚举",
                    "`in` needs an enum, but `{name}` is not one"
                );
                let fault = Diagnostic::error(FaultCode::NotAnEnum, key.span(), message);
                faults.push(fault.also_declared(ty.origin.name()));
                continue;
            }
            if !carried
                .get_or_insert_with(|| carried_types(draft))
                .contains(name.as_str())
            {
                let message = text!(
                    "没有上报或响应带有 `{name}`",
                    "no report and no response carries a `{name}`"
                );
                let fault = Diagnostic::error(FaultCode::UnseenState, key.span(), message);
                faults.push(fault.also_declared(ty.origin.name()));
            }
            check_values(draft, name, value, faults);
        }
    }
}

fn check_values(draft: &Draft<'_>, name: &str, values: Node<'_>, faults: &mut Faults) {
    let ty = Type::Named(TypeRef::named(name));
    let list = ValueList {
        wrong: FaultCode::StateValue,
        ty: None,
        repeated: FaultCode::DuplicateItem,
        message: text!("这个状态出现两次", "this state occurs twice"),
    };
    list.check(values.items(), |node| check_type(draft, &ty, node), faults);
}

/// Returns the names of all types that the robot sends in reports and responses.
fn carried_types<'d>(draft: &'d Draft<'_>) -> HashSet<&'d str> {
    let bodies = draft.operations.iter().filter_map(|operation| {
        let messages = operation.item.messages()?;
        Some(match operation.item.kind() {
            Kind::Report => messages.request.ty.name(),
            Kind::Command | Kind::Stream => messages.response.ty.name(),
        })
    });
    let bodies = bodies.filter_map(|name| draft.type_index.get(name).copied());
    let carried = walk_types(draft, bodies, |_| {}).into_iter();
    let carried = carried.filter_map(|index| draft.types.get(index));
    carried.map(|ty| ty.def.name.as_str()).collect()
}

/// Checks that the enums of states are declared.
pub(super) fn check_names(draft: &Draft<'_>, faults: &mut Faults) {
    for (occurrence, name) in draft.references_to(Enum::KINDS) {
        if draft.type_named(name).is_none() {
            let span = occurrence.node.span();
            let message = text!("没有类型 `{name}`", "there is no type `{name}`");
            let fault = Diagnostic::error(FaultCode::UnknownType, span, message);
            let types = draft.types.iter().filter(|ty| ty.def.body_of.is_none());
            let near = nearest(name, types.map(|ty| ty.def.name.as_str()));
            faults.push(fault.suggest(near, None));
        }
    }
}

/// Checks that no command precedes itself, directly or through others.
pub(super) fn check_circles(draft: &Draft<'_>, faults: &mut Faults) {
    let known: HashMap<&str, Node<'_>> = preconditions(draft).collect();
    let before = |name: &str| {
        let after = ACCEPTED.after.items(known.get(name).copied());
        let names = after.filter_map(|node| Some((node.as_str()?, node)));
        names.collect()
    };
    let commands = preconditions(draft).map(|(name, _)| name);
    walk(commands, before, |names, node| {
        faults.push(circle(node, names));
    });
}

fn circle(node: Node<'_>, names: &[&str]) -> Diagnostic {
    let message = match names {
        [only] => text!(
            "`{only}` 不能先于自己",
            "`{only}` cannot come before itself"
        ),
        several => {
            let names = several.iter().map(|name| format!("`{name}`"));
            text!(
                "这些指令的 `after` 形成循环：{names}",
                "these commands form a cycle of `after`: {names}",
                names = Text::listed(names)
            )
        }
    };
    Diagnostic::error(FaultCode::ComesBeforeItself, node.span(), message)
}
