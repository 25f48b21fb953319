//! Checks the keys that tie a report to its command, and the key of its state.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{COMMAND, REPORT, SET_OFF};
use crate::load::draft::{Draft, Sourced};
use crate::load::process::{body, path, side, states, way};
use crate::model::{Direction, Exchange, Operation, Text, Type, TypeShape};
use crate::source::Span;
use crate::syntax::Node;
use crate::text;
use std::collections::{HashMap, HashSet};

/// Checks that both ends of a tie exist and hold ids of the same type.
pub(super) fn check_ties(draft: &Draft<'_>, faults: &mut Faults) {
    for command in &draft.operations {
        let mut seen: HashMap<&str, Span> = HashMap::new();
        for node in COMMAND.sets_off.items(command.origin.node) {
            let named = SET_OFF.report.of(node).unwrap_or(node);
            let Some(name) = named.as_str() else {
                continue;
            };
            let first = *seen.entry(name).or_insert(named.span());
            if first != named.span() {
                let message = text!(
                    "`{name}` 在这个列表中出现两次",
                    "`{name}` occurs twice in this list"
                );
                let fault = Diagnostic::error(FaultCode::DuplicateItem, named.span(), message);
                faults.push(fault.also(first, text!("首次列在这里", "first listed here")));
            }
            let mut operations = draft.operations.iter();
            let Some(report) = operations.find(|it| it.item.name == name) else {
                continue;
            };
            for tie in SET_OFF.tied.of(node).into_iter().flat_map(Node::entries) {
                check_tie(draft, (command, tie.key), (report, tie.value), faults);
            }
        }
    }
}

fn check_tie(
    draft: &Draft<'_>,
    (command, left): (&Sourced<'_, Operation>, Node<'_>),
    (report, right): (&Sourced<'_, Operation>, Node<'_>),
    faults: &mut Faults,
) {
    let (Some(from), Some(to)) = (left.as_str(), right.as_str()) else {
        return;
    };
    let Some((from_side, from)) = side(from) else {
        let message = text!(
            "`{from}` 应以 `request.` 或 `response.` 开头",
            "`{from}` must start with `request.` or `response.`"
        );
        let fault = Diagnostic::error(FaultCode::UnknownBodyKey, left.span(), message);
        faults.push(fault.note(text!(
            "写明字段在指令的哪条消息中",
            "name the message of the command that has the field"
        )));
        return;
    };
    let ends = [
        (command, from_side, path(from), left.span()),
        (report, Direction::Request, path(to), right.span()),
    ];
    let [from, to] = ends.map(|(operation, side, keys, span)| {
        let found = end(draft, operation, side, &keys, span, faults)?;
        if matches!(found, Type::Int(_) | Type::String) {
            return Some((found, span));
        }
        let message = text!(
            "`{keys}` 应为整数或字符串，实际为 `{found}`",
            "`{keys}` must be an integer or a string, found `{found}`",
            keys = keys.join(".")
        );
        let fault = Diagnostic::error(FaultCode::TieType, span, message);
        faults.push(fault.note(text!(
            "写一个在指令和上报中取值相同的 ID",
            "name an ID that is the same in the command and the report"
        )));
        None
    });
    if let (Some((from, here)), Some((to, there))) = (from, to)
        && from != to
    {
        let message = text!(
            "类型应为 `{from}`，实际为 `{to}`",
            "expected the type `{from}`, found `{to}`"
        );
        let fault = Diagnostic::error(FaultCode::TieType, there, message);
        faults.push(fault.also(here, text!("与这里的类型相同", "the type of this field")));
    }
}

/// Returns the type of the field at the keys. Reports an error if there is no such field.
fn end<'d>(
    draft: &'d Draft<'_>,
    operation: &'d Sourced<'_, Operation>,
    side: Direction,
    keys: &[String],
    span: Span,
    faults: &mut Faults,
) -> Option<&'d Type> {
    let body = body(draft, &operation.item, side)?;
    if let Some(field) = way(draft, body, keys).and_then(|fields| fields.last().copied()) {
        return Some(&field.ty);
    }
    let message = text!(
        "`{name}` 的{what}没有键 `{key}`",
        "the {what} of `{name}` has no key `{key}`",
        what = what(&operation.item, side),
        name = operation.item.name,
        key = keys.join(".")
    );
    let fault = Diagnostic::error(FaultCode::UnknownBodyKey, span, message);
    faults.push(fault.note(text!(
        "写一个只经过对象、不经过列表的路径",
        "write a path through objects; it cannot go through lists"
    )));
    None
}

fn what(operation: &Operation, side: Direction) -> Text {
    match (&operation.exchange, side) {
        (Exchange::Command { .. }, Direction::Request) => text!("请求", "request"),
        (Exchange::Command { .. }, Direction::Response) => text!("响应", "response"),
        _ => text!("消息体", "body"),
    }
}

/// Checks that `state_in` of a report names the state of a process. A report that a command sets off needs `state_in`
/// if several fields qualify.
pub(super) fn check_state(draft: &Draft<'_>, faults: &mut Faults) {
    let commands = draft.operations.iter();
    let set_off: HashSet<&str> = commands
        .flat_map(|command| command.item.sets_off())
        .map(|set_off| set_off.report.as_str())
        .collect();
    for report in &draft.operations {
        let Exchange::Report { state, .. } = &report.item.exchange else {
            continue;
        };
        let said = REPORT.state_in.of(report.origin.node);
        if let (Some(said), Some(keys)) = (said, state) {
            let found = end(draft, report, Direction::Request, keys, said.span(), faults);
            let Some(ty) = found else { continue };
            let shape = draft.shape(ty);
            if !matches!(shape, Some(TypeShape::Enum(shape)) if shape.is_process()) {
                let message = text!(
                    "`{keys}` 不是过程的状态",
                    "`{keys}` is not the state of a process",
                    keys = keys.join(".")
                );
                let fault = Diagnostic::error(FaultCode::NotAState, said.span(), message);
                faults.push(fault.note(text!(
                    "写一个枚举字段，枚举有 `order:`，或有取值写了 `final: true`",
                    "name a field whose enum has `order:`, or a value with `final: true`"
                )));
            }
        } else if said.is_none() && set_off.contains(report.item.name.as_str()) {
            let states = body(draft, &report.item, Direction::Request)
                .map(|body| states(draft, body))
                .unwrap_or_default();
            let names: Vec<String> = states.iter().map(|keys| keys.join(".")).collect();
            if let [first, second, ..] = names.as_slice() {
                let message = text!(
                    "`{first}` 和 `{second}` 都可能是过程的状态",
                    "`{first}` and `{second}` could both be the state of the process"
                );
                let span = report.origin.name();
                let fault = Diagnostic::error(FaultCode::AmbiguousState, span, message);
                faults.push(fault.note(text!(
                    "写明是哪一个，例如 `state_in: {first}`",
                    "name one of them, such as `state_in: {first}`"
                )));
            }
        }
    }
}
