//! When reports are sent.

use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::load::draft::{Draft, Part, TypeDraft};
use crate::load::grammar::{CADENCE, REPORT, STEP};
use crate::model::{Field, Kind, Number, Operation, Text, Type, TypeShape};
use crate::syntax::Node;
use crate::text;
use std::collections::HashSet;

/// Each report that says when it is sent, and where it does.
fn cadences<'d, 'a>(draft: &'d Draft<'a>) -> impl Iterator<Item = (&'d Operation, Node<'a>)> {
    draft.operations.iter().filter_map(|operation| {
        let node = REPORT.cadence.of(operation.place.node)?;
        let is_report = operation.item.kind() == Kind::Report;
        (is_report && node.as_mapping().is_some()).then_some((&operation.item, node))
    })
}

/// A cadence is one rule.
pub(super) fn check_one_rule(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, node) in cadences(draft) {
        let rules = [
            CADENCE.on_change.entry(node),
            CADENCE.step.entry(node),
            CADENCE.every_ms.entry(node),
            CADENCE.within_ms.entry(node),
        ];
        let mut rules = rules.into_iter().flatten();
        let fault = match (rules.next(), rules.next()) {
            (Some(_), None) => continue,
            (Some(first), Some(second)) => {
                let message = text!(
                    "一个上报只能有一种上报时机，这里已经有一种",
                    "a report is sent by one rule, and there is one already"
                );
                Diagnostic::error(FaultCode::CadenceRules, second.key.span(), message)
                    .also(first.key.span(), text!("在这里", "here"))
            }
            (None, _) => {
                let message = text!(
                    "没有写明什么时候上报",
                    "this does not say when the report is sent"
                );
                Diagnostic::error(FaultCode::CadenceRules, node.span(), message).note(text!(
                    "不清楚时不写 `cadence`",
                    "leave `cadence` out where it is not known"
                ))
            }
        };
        faults.push(fault);
    }
}

/// A deadline runs from a command that sets the report off.
pub(super) fn check_deadlines(draft: &Draft<'_>, faults: &mut Faults) {
    // Most specs have none.
    let mut set_off = None;
    for (report, node) in cadences(draft) {
        let Some(entry) = CADENCE.within_ms.entry(node) else {
            continue;
        };
        let set_off: &HashSet<&str> = set_off.get_or_insert_with(|| {
            let commands = draft.operations.iter();
            let names = commands.flat_map(|command| command.item.sets_off());
            names.map(|set_off| set_off.report.as_str()).collect()
        });
        if !set_off.contains(report.name.as_str()) {
            let message = text!(
                "没有指令会引起 `{report}`，时限无从算起",
                "no command sets `{report}` off, so the time runs from nothing",
                report = report.name
            );
            faults.push(
                Diagnostic::error(FaultCode::DeadlineOfNothing, entry.key.span(), message).note(
                    text!(
                        "在某条指令的 `sets_off:` 中写上这个上报",
                        "name the report in `sets_off:` of a command"
                    ),
                ),
            );
        }
    }
}

/// A rule goes by a field of the report, and steps are those of a number.
pub(super) fn check_fields(draft: &Draft<'_>, faults: &mut Faults) {
    for (report, node) in cadences(draft) {
        let Some(body) = report.messages().map(|messages| messages.request.ty.name()) else {
            continue;
        };
        if let Some(path) = CADENCE.on_change.of(node) {
            find(draft, body, path, faults);
        }
        let Some(step) = CADENCE.step.of(node) else {
            continue;
        };
        let Some(path) = STEP.field.of(step) else {
            continue;
        };
        let Some((field, part)) = find(draft, body, path, faults) else {
            continue;
        };
        check_step(field, part, step, path, faults);
    }
}

fn check_step(field: &Field, part: Part<'_>, step: Node<'_>, path: Node<'_>, faults: &mut Faults) {
    let Some((node, by)) = STEP.by.of(step).zip(STEP.by.read(step)) else {
        return;
    };
    let ty = field.ty.item();
    if !matches!(ty, Type::Int(_) | Type::Float(_)) {
        let message = text!(
            "只有数值才有变化幅度，而 `{field}` 不是数值",
            "a step is one of a number, which `{field}` is not",
            field = field.wire
        );
        let fault = Diagnostic::error(FaultCode::StepOnWrongType, path.span(), message);
        faults.push(fault.also(part.ty, text!("类型", "the type")));
        return;
    }
    let fits = match (ty, &by) {
        (Type::Int(kind), Number::Int(by)) => {
            let (least, most) = kind.range();
            (1..=most.saturating_sub(least)).contains(by)
        }
        (Type::Float(_), by) => by.to_f64() > 0.0,
        _ => false,
    };
    if !fits {
        let message = text!(
            "`{field}` 的变化不可能是这个幅度",
            "`{field}` does not move by such a step",
            field = field.wire
        );
        let fault = Diagnostic::error(FaultCode::StepOfNothing, node.span(), message);
        faults.push(fault.also(part.ty, text!("类型", "the type")));
    }
}

/// The field at a path. Where there is none, that is reported, unless what is missing may be what has been reported.
fn find<'d, 'a>(
    draft: &'d Draft<'a>,
    body: &str,
    path: Node<'_>,
    faults: &mut Faults,
) -> Option<(&'d Field, Part<'a>)> {
    let mut holder = draft.type_named(body)?;
    let mut keys = path.as_str()?.split('.').peekable();
    while let Some(key) = keys.next() {
        let Some((field, part)) = field_of(draft, holder, key) else {
            if !has_broken(draft, holder) {
                faults.push(unknown(draft, holder, key, path));
            }
            return None;
        };
        if keys.peek().is_none() {
            return Some((field, part));
        }
        let Type::Named(named) = field.ty.item() else {
            let message = text!(
                "`{key}` 不是对象，里面没有内容",
                "`{key}` is no object, so nothing is in it"
            );
            let fault = Diagnostic::error(FaultCode::UnknownField, path.span(), message);
            faults.push(fault.also(part.ty, text!("类型", "the type")));
            return None;
        };
        holder = draft.type_named(named.name())?;
    }
    None
}

/// The structs that a type may be: itself, or the variants of a choice.
fn structs<'d, 'a>(draft: &'d Draft<'a>, ty: &'d TypeDraft<'a>) -> Vec<&'d TypeDraft<'a>> {
    match &ty.def.shape {
        TypeShape::OneOf(choice) => {
            let variants = choice.variants.iter();
            variants
                .filter_map(|variant| draft.type_named(variant.ty.name()))
                .collect()
        }
        TypeShape::Struct(_) | TypeShape::Enum(_) => vec![ty],
    }
}

fn fields_of<'d, 'a>(ty: &'d TypeDraft<'a>) -> impl Iterator<Item = (&'d Field, Part<'a>)> {
    let fields = match &ty.def.shape {
        TypeShape::Struct(shape) => shape.fields.as_slice(),
        TypeShape::Enum(_) | TypeShape::OneOf(_) => &[],
    };
    fields.iter().zip(ty.parts.iter().copied())
}

fn field_of<'d, 'a>(
    draft: &'d Draft<'a>,
    holder: &'d TypeDraft<'a>,
    key: &str,
) -> Option<(&'d Field, Part<'a>)> {
    let mut fields = structs(draft, holder).into_iter().flat_map(fields_of);
    fields.find(|(field, _)| field.wire == key)
}

fn has_broken(draft: &Draft<'_>, holder: &TypeDraft<'_>) -> bool {
    let mut fields = structs(draft, holder).into_iter().flat_map(fields_of);
    fields.any(|(_, part)| part.broken)
}

fn unknown(draft: &Draft<'_>, holder: &TypeDraft<'_>, key: &str, path: Node<'_>) -> Diagnostic {
    let message = text!("没有字段 `{key}`", "there is no field `{key}`");
    let fault = Diagnostic::error(FaultCode::UnknownField, path.span(), message);
    let structs = structs(draft, holder);
    let keys = structs.into_iter().flat_map(fields_of);
    let keys: Vec<&str> = keys.map(|(field, _)| field.wire.as_str()).collect();
    match nearest(key, keys.iter().copied()) {
        Some(near) => fault.note(text!("是否想写 `{near}`？", "did you mean `{near}`?")),
        None if keys.is_empty() => {
            fault.note(text!("那里没有已知的字段", "no field is known there"))
        }
        None => fault.note(text!(
            "那里的字段有：{keys}",
            "the fields there are {keys}",
            keys = Text::listed(keys)
        )),
    }
}
