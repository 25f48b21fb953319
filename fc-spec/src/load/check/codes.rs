//! Checks codes of operations and their ranges.

use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::grammar::{CODE, FILE, Group, Named, OPERATION, RANGE, RETIRED, SOURCE};
use crate::load::draft::{Draft, Sourced};
use crate::model::{CodeRange, Kind, Operation, RangeUse, Text, next_code};
use crate::source::Span;
use crate::syntax::Node;
use crate::text;
use std::collections::HashMap;

/// Checks that ranges ascend and do not overlap. Returns `false` if they do not.
pub(super) fn check_ranges(draft: &Draft<'_>, faults: &mut Faults) -> bool {
    let before = faults.errors();
    let mut reached: Option<&Sourced<'_, CodeRange>> = None;
    for range in &draft.ranges {
        let item = &range.item;
        if item.first > item.last {
            let message = text!(
                "号段的终点 {last} 早于起点",
                "the range ends at {last}, before it starts",
                last = item.last_spelling
            );
            let span = range.origin.at(RANGE.to);
            let fault = Diagnostic::error(FaultCode::RangeInverted, span, message);
            faults.push(fault.also(
                range.origin.at(RANGE.from),
                text!("起点在这里", "it starts here"),
            ));
            continue;
        }
        if let Some(earlier) = reached
            && item.first <= earlier.item.last
        {
            let message = text!(
                "{first} 也在号段 {from} 到 {to} 之内",
                "{first} is also in the range {from} to {to}",
                first = item.first_spelling,
                from = earlier.item.first_spelling,
                to = earlier.item.last_spelling
            );
            let span = range.origin.at(RANGE.from);
            let fault = Diagnostic::error(FaultCode::RangesOverlap, span, message);
            faults.push(fault.also(
                earlier.origin.at(RANGE.to),
                text!("另一个号段到这里为止", "the other range ends here"),
            ));
        }
        if reached.is_none_or(|earlier| earlier.item.last < item.last) {
            reached = Some(range);
        }
    }
    faults.errors() == before
}

/// Checks that no code is retired twice.
pub(super) fn check_retired(draft: &Draft<'_>, faults: &mut Faults) {
    let mut first: HashMap<u16, Span> = HashMap::new();
    for retired in &draft.retired {
        let span = retired.origin.at(RETIRED.code);
        if let Some(earlier) = first.insert(retired.item.code, span) {
            let message = text!(
                "{code} 退役了两次",
                "{code} is retired twice",
                code = retired.item.spelling
            );
            let fault = Diagnostic::error(FaultCode::DuplicateRetired, span, message);
            faults.push(fault.also(earlier, text!("第一次在这里", "first here")));
        }
    }
}

/// Checks that operations have different codes, and that none uses a retired one. A stream may share the code of the
/// command that starts it.
pub(super) fn check_unique(draft: &Draft<'_>, faults: &mut Faults) {
    let retired: HashMap<u16, Span> = draft
        .retired
        .iter()
        .map(|retired| (retired.item.code, retired.origin.at(RETIRED.code)))
        .collect();
    // Holds at most a command and its stream.
    let mut first: HashMap<u16, Vec<&Sourced<'_, Operation>>> = HashMap::new();
    for operation in &draft.operations {
        let Some(code) = operation.item.code.value else {
            continue;
        };
        let spelling = &operation.item.code.spelling;
        let span = code_span(operation);
        let users = first.entry(code).or_default();
        let other = users
            .iter()
            .find(|user| !belong_together(&user.item, &operation.item));
        if let Some(earlier) = other {
            let message = text!(
                "{spelling} 已经是 `{name}` 的功能码",
                "{spelling} is already the code of `{name}`",
                name = earlier.item.name
            );
            let kinds = [earlier.item.kind(), operation.item.kind()];
            let remedy = if kinds.contains(&Kind::Stream) && kinds.contains(&Kind::Command) {
                text!(
                    "只有数据流可以共用功能码，即与 `started_by:` 所写的指令共用",
                    "only a stream may share a code, with the command in its `started_by:`"
                )
            } else {
                text!(
                    "在有自己的功能码之前写 `unassigned`",
                    "write `unassigned` until it has its own code"
                )
            };
            let fault = Diagnostic::error(FaultCode::DuplicateCode, span, message);
            faults.push(fault.also_first(code_span(earlier)).note(remedy));
        } else {
            users.push(operation);
        }
        if let Some(retired) = retired.get(&code) {
            let message = text!(
                "{spelling} 已退役，不能再用",
                "{spelling} is retired and must not be used again"
            );
            let fault = Diagnostic::error(FaultCode::RetiredCode, span, message);
            faults.push(fault.also(*retired, text!("在这里退役", "retired here")));
        }
    }
}

/// Returns `true` if one is a stream and the other the command that starts it. The frame kind distinguishes the two.
fn belong_together(one: &Operation, other: &Operation) -> bool {
    let starts = |command: &Operation, stream: &Operation| {
        let started_by = stream.stream().and_then(|it| it.started_by.as_deref());
        command.kind() == Kind::Command && started_by == Some(command.name.as_str())
    };
    starts(one, other) || starts(other, one)
}

/// Checks that every code lies in a range with a suitable purpose.
pub(super) fn check_ranges_of_codes(draft: &Draft<'_>, faults: &mut Faults) {
    if !draft.valid.contains_key(FILE.codes.name) {
        return;
    }
    for operation in &draft.operations {
        let Some(code) = operation.item.code.value else {
            continue;
        };
        let spelling = &operation.item.code.spelling;
        let span = code_span(operation);
        // Ranges are sorted by their first code and do not overlap.
        let at = draft
            .ranges
            .partition_point(|range| range.item.first <= code);
        let range = at.checked_sub(1).and_then(|at| draft.ranges.get(at));
        let Some(range) = range.filter(|range| code <= range.item.last) else {
            let message = text!(
                "{spelling} 不在任何号段内",
                "{spelling} is outside all code ranges"
            );
            let fault = Diagnostic::error(FaultCode::CodeOutsideRanges, span, message);
            faults.push(fault.note(text!(
                "使用 `codes.ranges` 中某个号段的功能码，或者声明新的号段",
                "use a code from a range in `codes.ranges`, or declare a range"
            )));
            continue;
        };
        // Without valid `sections` it is unknown whether the operation is new.
        let source = OPERATION.source.of(operation.origin.node);
        let sections = SOURCE.sections.of(source).and_then(Node::as_sequence);
        let is_new = operation.item.sections.is_empty() && sections.is_some();
        if let Some(reason) = objection(&operation.item, range.item.usage, is_new) {
            let message = text!(
                "{spelling} 所在的号段{reason}",
                "{spelling} is in a range {reason}",
                reason = reason
            );
            let fault = Diagnostic::error(FaultCode::CodeInWrongRange, span, message).also(
                range.origin.at(RANGE.r#use),
                text!("号段的用途", "the purpose of the range"),
            );
            let next = next(draft, &operation.item);
            // The code of an operation from the source is a fact; the code of a new operation is a choice.
            faults.push(match next.filter(|_| operation.item.sections.is_empty()) {
                Some(next) => fault.fix(
                    span,
                    format!("0x{next:04X}"),
                    text!("改用下一个空闲的功能码", "take the next free code"),
                ),
                None => fault,
            });
        }
    }
}

/// Returns the code for the next operation of the same kind and group.
fn next(draft: &Draft<'_>, operation: &Operation) -> Option<u16> {
    let usage = match operation.kind() {
        Kind::Command => RangeUse::Commands,
        Kind::Report => RangeUse::Reports,
        Kind::Stream => return None,
    };
    next_code(
        draft.operations.iter().map(|operation| &operation.item),
        draft.retired.iter().map(|retired| &retired.item),
        draft.ranges.iter().map(|range| &range.item),
        usage,
        Some(&operation.group),
    )
}

/// Checks that every group of a range exists.
pub(super) fn check_groups(draft: &Draft<'_>, faults: &mut Faults) {
    let known: Vec<&str> = draft
        .groups
        .iter()
        .map(|group| group.item.id.as_str())
        .collect();
    for (occurrence, id) in draft.references_to(Group::KINDS) {
        if !known.contains(&id) {
            let span = occurrence.node.span();
            let message = text!("没有分组 `{id}`", "there is no group `{id}`");
            let fault = Diagnostic::error(FaultCode::UnknownGroup, span, message);
            faults.push(match nearest(id, known.iter().copied()) {
                Some(near) => fault.fix(span, near, text!("改为 `{near}`", "write `{near}`")),
                None => fault,
            });
        }
    }
}

/// Returns the reason why an operation cannot have a code from such a range.
///
/// An operation that is not in the source is new. New operations get codes from the ranges that count up.
fn objection(operation: &Operation, usage: RangeUse, is_new: bool) -> Option<Text> {
    match (operation.kind(), usage) {
        (Kind::Command | Kind::Report, RangeUse::Historic) if is_new => Some(text!(
            "不再接受新接口，而这个接口并非出自源文档",
            "that is closed for new operations, and this one is not from the source"
        )),
        (_, RangeUse::Reserved) => Some(text!("是预留的", "that is reserved")),
        (Kind::Report, RangeUse::Commands) => Some(text!(
            "用于指令，而这是上报",
            "for commands, and this is a report"
        )),
        (Kind::Command, RangeUse::Reports) => Some(text!(
            "用于上报，而这是指令",
            "for reports, and this is a command"
        )),
        (Kind::Report | Kind::Stream, RangeUse::PassThrough) => Some(text!(
            "透传给上装，只能有指令",
            "that is passed through to the upper body and contains only commands"
        )),
        _ => None,
    }
}

fn code_span(operation: &Sourced<'_, Operation>) -> Span {
    let node = OPERATION.code.of(operation.origin.node);
    let node = CODE.value.of(node).or(node);
    node.map_or(operation.origin.name(), Node::span)
}
