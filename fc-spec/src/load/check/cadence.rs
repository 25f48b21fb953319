//! Checks the cadence of reports.

use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::grammar::{CADENCE, REPORT, STEP};
use crate::load::draft::{Draft, Part, TypeDraft};
use crate::model::{Field, Kind, Number, Operation, Text, Type, TypeShape};
use crate::syntax::Node;
use crate::text;
use std::collections::HashSet;

/// Returns each report that has a cadence, with the node of the cadence.
fn cadences<'d, 'a>(draft: &'d Draft<'a>) -> impl Iterator<Item = (&'d Operation, Node<'a>)> {
    draft.operations.iter().filter_map(|operation| {
        let node = REPORT.cadence.of(operation.origin.node)?;
        let is_report = operation.item.kind() == Kind::Report;
        (is_report && node.as_mapping().is_some()).then_some((&operation.item, node))
    })
}

/// Checks that a cadence has exactly one rule.
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
                    "`cadence` 只能有一条规则，这是第二条",
                    "`cadence` takes one rule, and this is the second"
                );
                Diagnostic::error(FaultCode::CadenceRules, second.key.span(), message)
                    .also(first.key.span(), text!("第一条", "the first one"))
            }
            (None, _) => {
                let message = text!("`cadence` 没有规则", "`cadence` has no rule");
                Diagnostic::error(FaultCode::CadenceRules, node.span(), message).note(text!(
                    "写 `on_change`、`step`、`every_ms` 或 `within_ms`；不清楚时不写 `cadence`",
                    "write `on_change`, `step`, `every_ms` or `within_ms`, or leave `cadence` out if the rule is unknown"
                ))
            }
        };
        faults.push(fault);
    }
}

/// Checks that a command sets off each report that has a deadline. The deadline starts with that command.
pub(super) fn check_deadlines(draft: &Draft<'_>, faults: &mut Faults) {
    // Computed on demand, because most specs have no deadlines.
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
                "没有指令会引起 `{report}`，`within_ms` 没有起点",
                "no command sets off `{report}`, so `within_ms` has no start",
                report = report.name
            );
            let fault = Diagnostic::error(FaultCode::DeadlineOfNothing, entry.key.span(), message);
            faults.push(fault.note(text!(
                "在某条指令的 `sets_off:` 中写上这个上报",
                "name the report in `sets_off:` of a command"
            )));
        }
    }
}

/// Checks that a rule names a field of the report, and that a step refers to a number.
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
            "`step` 应为数值字段，而 `{field}` 不是数值",
            "`step` needs a number, but `{field}` is not one",
            field = field.wire
        );
        let fault = Diagnostic::error(FaultCode::StepOnWrongType, path.span(), message);
        faults.push(fault.also_type(part.ty));
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
            "步长不适用于 `{field}` 的类型",
            "this step does not fit the type of `{field}`",
            field = field.wire
        );
        let fault = Diagnostic::error(FaultCode::StepOfNothing, node.span(), message);
        faults.push(fault.also_type(part.ty));
    }
}

/// Returns the field at a path. Reports an absent field, unless an earlier error may explain its absence.
fn find<'d, 'a>(
    draft: &'d Draft<'a>,
    body: &str,
    path: Node<'_>,
    faults: &mut Faults,
) -> Option<(&'d Field, Part<'a>)> {
    let mut holder = draft.type_named(body)?;
    let mut keys = path.as_str()?.split('.').peekable();
    while let Some(key) = keys.next() {
        let structs = structs(draft, holder).into_iter();
        let fields: Vec<_> = structs.flat_map(TypeDraft::fields).collect();
        let mut named = fields.iter().filter(|(field, _)| field.wire == key);
        let Some(&(field, part)) = named.next() else {
            if fields.iter().all(|(_, part)| !part.broken) {
                faults.push(unknown(&fields, key, path));
            }
            return None;
        };
        if keys.peek().is_none() {
            return Some((field, part));
        }
        let Type::Named(named) = field.ty.item() else {
            let message = text!(
                "`{key}` 不是对象，里面没有字段",
                "`{key}` is not an object and has no fields"
            );
            let fault = Diagnostic::error(FaultCode::UnknownField, path.span(), message);
            faults.push(fault.also_type(part.ty));
            return None;
        };
        holder = draft.type_named(named.name())?;
    }
    None
}

/// Returns the structs that a type may be: the type itself, or the variants of a choice.
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

fn unknown(fields: &[(&Field, Part<'_>)], key: &str, path: Node<'_>) -> Diagnostic {
    let message = text!("没有字段 `{key}`", "there is no field `{key}`");
    let fault = Diagnostic::error(FaultCode::UnknownField, path.span(), message);
    let keys = fields.iter().map(|(field, _)| field.wire.as_str());
    match nearest(key, keys.clone()) {
        Some(near) => fault.note(text!("是否想写 `{near}`？", "did you mean `{near}`?")),
        None if fields.is_empty() => {
            fault.note(text!("那里没有已知的字段", "no fields are known there"))
        }
        None => fault.note(text!(
            "可以写：{keys}",
            "expected one of {keys}",
            keys = Text::listed(keys)
        )),
    }
}
