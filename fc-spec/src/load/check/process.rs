//! By which keys a report belongs to what has set it off, and which of its keys has the state.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::{Draft, Placed};
use crate::load::grammar::{COMMAND, REPORT, SET_OFF};
use crate::load::process::{body, path, side, states, way};
use crate::model::{Direction, Exchange, Operation, Text, Type, TypeShape};
use crate::syntax::{Node, Span};
use crate::text;
use std::collections::{HashMap, HashSet};

/// Both ends of a tie are there, and hold ids of the same type.
pub(super) fn check_ties(draft: &Draft<'_>, faults: &mut Faults) {
    for command in &draft.operations {
        let mut seen: HashMap<&str, Span> = HashMap::new();
        for node in COMMAND.sets_off.items(command.place.node) {
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
    (command, left): (&Placed<'_, Operation>, Node<'_>),
    (report, right): (&Placed<'_, Operation>, Node<'_>),
    faults: &mut Faults,
) {
    let (Some(from), Some(to)) = (left.as_str(), right.as_str()) else {
        return;
    };
    let Some((from_side, from)) = side(from) else {
        let message = text!(
            "`{from}` 没有写明在指令的哪条消息中",
            "`{from}` does not say which message of the command it is in"
        );
        let fault = Diagnostic::error(FaultCode::UnknownBodyKey, left.span(), message);
        faults.push(fault.note(text!(
            "以 `request.` 或 `response.` 开头",
            "begin with `request.` or `response.`"
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
            "`{keys}` 的类型是 `{found}`，ID 不会是这种类型",
            "`{keys}` has the type `{found}`, which no ID has",
            keys = keys.join(".")
        );
        let fault = Diagnostic::error(FaultCode::TieType, span, message);
        faults.push(fault.note(text!(
            "上报与指令靠整数或字符串相对应",
            "an integer or a string ties a report to a command"
        )));
        None
    });
    if let (Some((from, here)), Some((to, there))) = (from, to)
        && from != to
    {
        let message = text!(
            "`{from}` 和 `{to}` 不可能是同一个值",
            "`{from}` and `{to}` are never the same value"
        );
        let fault = Diagnostic::error(FaultCode::TieType, there, message);
        faults.push(fault.also(here, text!("这是 `{from}`", "this is `{from}`")));
    }
}

/// The type of the field that keys lead to; a fault where they lead nowhere.
fn end<'d>(
    draft: &'d Draft<'_>,
    operation: &'d Placed<'_, Operation>,
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
        "路径只能经过对象，不能经过列表",
        "the way goes through objects, not through lists"
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

/// What a report names as its state is one; a report that a command sets off has one, or says which.
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
        let said = REPORT.state_in.of(report.place.node);
        if let (Some(said), Some(keys)) = (said, state) {
            let found = end(draft, report, Direction::Request, keys, said.span(), faults);
            let named = found.map(|ty| match ty {
                Type::Named(named) => draft.type_named(named.name()),
                _ => None,
            });
            let Some(ty) = named else { continue };
            let is_process = ty.is_some_and(|ty| match &ty.def.shape {
                TypeShape::Enum(shape) => shape.is_process(),
                TypeShape::Struct(_) | TypeShape::OneOf(_) => false,
            });
            if !is_process {
                let message = text!(
                    "`{keys}` 没有过程的状态",
                    "`{keys}` has no states of a process",
                    keys = keys.join(".")
                );
                let fault = Diagnostic::error(FaultCode::NotAState, said.span(), message);
                faults.push(fault.note(text!(
                    "状态是一个枚举，带有 `order:`，或有取值写了 `final: true`",
                    "a state is an enum with `order:`, or with a value that is `final: true`"
                )));
            }
        } else if said.is_none() && set_off.contains(report.item.name.as_str()) {
            let states = body(draft, &report.item, Direction::Request)
                .map(|body| states(draft, body))
                .unwrap_or_default();
            let names: Vec<String> = states.iter().map(|keys| keys.join(".")).collect();
            if let [first, second, ..] = names.as_slice() {
                let message = text!(
                    "`{first}` 和 `{second}` 都有状态：过程的状态是哪一个？",
                    "`{first}` and `{second}` both have states: which is that of the process?"
                );
                let span = report.place.name();
                let fault = Diagnostic::error(FaultCode::AmbiguousState, span, message);
                faults.push(fault.note(text!(
                    "例如写 `state_in: {first}`",
                    "write `state_in: {first}`, say"
                )));
            }
        }
    }
}
