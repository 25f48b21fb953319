//! Reports that a command sets off, the state of its process, and the comments about them.

use super::context::Context;
use super::docs::Docs;
use crate::package::items::Spelled;
use crate::package::joined::Joined;
use fc_spec::model::{
    EnumType, EnumValue, Exchange, KeyPath, Messages, Operation, SetOff, TypeRef,
};

/// Returns the reports that a command sets off and that have a code, with their ties and messages.
pub fn set_off<'m>(
    context: &'m Context<'_>,
    command: &'m Operation,
) -> impl Iterator<Item = (&'m SetOff, &'m Operation, &'m Messages)> {
    command.sets_off().iter().filter_map(|set_off| {
        let report = context.model().operation(&set_off.report)?;
        report.code.value?;
        Some((set_off, report, report.messages()?))
    })
}

/// Returns `true` if a command sets off a report that can be followed.
pub fn is_followed(context: &Context<'_>, command: &Operation) -> bool {
    set_off(context, command).next().is_some()
}

/// Returns `true` if the values of an enum are states of a process.
pub fn has_states(shape: &EnumType) -> bool {
    let mut values = shape.values.iter();
    shape.order.is_some() || values.any(|value| value.is_final || value.is_error)
}

/// Returns the values that may follow `value`, in the order of the spec.
pub fn next_values<'v, 'm>(
    value: &EnumValue,
    values: &'v [Spelled<'m, EnumValue>],
) -> impl Iterator<Item = &'v Spelled<'m, EnumValue>> {
    let next = value.then.iter();
    next.filter_map(|next| values.iter().find(|known| known.of.name == *next))
}

/// Returns the key of a report's state, and its type.
pub fn state<'m>(
    context: &'m Context<'_>,
    report: &'m Operation,
) -> Option<(&'m KeyPath, &'m TypeRef, &'m EnumType)> {
    let Exchange::Report {
        state: Some(keys),
        messages,
        ..
    } = &report.exchange
    else {
        return None;
    };
    let (ty, shape) = context.model().enum_at(&messages.request.ty, keys)?;
    Some((keys, ty, shape))
}

/// Adds the paragraphs about following a command.
pub fn docs(docs: &mut Docs<'_>, context: &Context<'_>, command: &Operation) {
    for (set_off, report, messages) in set_off(context, command) {
        let ty = (context.style.link)(context.name_of(&messages.request.ty));
        docs.raw_lines([
            format!("`.follow()`：先返回响应，再逐个返回它引起的 {ty}。"),
            format!(
                "`.follow()` returns the response, and then each {ty} that the command sets off."
            ),
        ]);
        ending(docs, context, set_off, report);
    }
}

/// Adds the paragraphs about the end of following, and about the reports that arrive.
pub fn ending(docs: &mut Docs<'_>, context: &Context<'_>, set_off: &SetOff, report: &Operation) {
    let state = state(context, report).map(|(keys, _, shape)| (keys.join("."), shape));
    let ends = state.as_ref().is_some_and(|(_, shape)| {
        let mut values = shape.values.iter();
        values.any(|value| value.is_final)
    });
    let Exchange::Report { failures, .. } = &report.exchange else {
        return;
    };
    let own = state.iter().filter(|(_, shape)| shape.has_failures());
    let own = own.map(|(keys, _)| keys.clone());
    let failing = own.chain(failures.iter().map(|keys| keys.join(".")));
    let failing: Vec<String> = failing.map(|keys| format!("`{keys}`")).collect();
    let (zh, en) = match (state.filter(|_| ends), failing.is_empty()) {
        (Some((keys, _)), true) => (
            format!("`{keys}` 到达终态时结束。"),
            format!("It ends at a final state in `{keys}`."),
        ),
        (Some((keys, _)), false) => (
            format!(
                "`{keys}` 到达终态，或 {} 表示失败时结束。",
                failing.join("、")
            ),
            format!(
                "It ends at a final state in `{keys}`, or when {} reports a failure.",
                failing.join(" or ")
            ),
        ),
        (None, false) => (
            format!(
                "规范没有写明终态：{} 表示失败时结束，否则由 app 停止。",
                failing.join("、")
            ),
            format!(
                "The spec marks no state as final. It ends when {} reports a failure, or when the app stops it.",
                failing.join(" or ")
            ),
        ),
        (None, true) => (
            "规范没有写明终态：由 app 停止。".to_owned(),
            "The spec marks no state as final. The app stops it.".to_owned(),
        ),
    };
    docs.both([zh, en]);
    if set_off.tied.is_empty() {
        docs.both([
            "报文中没有字段把上报与调用对应起来：由别的调用引起的同类上报也会收到。",
            "No key ties a report to a call: reports of this kind from other calls arrive as well.",
        ]);
    } else {
        let ties = set_off.tied.iter().map(|tie| {
            let (command, report) = (tie.command.join("."), tie.report.join("."));
            format!("`{}.{command}` = `{report}`", tie.side.name())
        });
        let ties = ties.joined(", ");
        docs.both([
            format!("只收到属于这次调用的上报：{ties}。"),
            format!("Only reports of this call arrive: {ties}."),
        ]);
    }
}
