//! Derive attributes for processes: the reports that a command sets off, and the state of a report.

use super::context::Context;
use crate::package::joined::Joined;
use crate::package::process::{set_off, state};
use fc_spec::model::{Exchange, Operation, StructRef, TypeRef};

/// Returns the other types that the attribute of an operation names.
pub fn types<'m>(context: &'m Context<'_>, operation: &'m Operation) -> Vec<&'m TypeRef> {
    let reports = set_off(context, operation);
    let mut types: Vec<&TypeRef> = reports.map(|(_, _, it)| &*it.request.ty).collect();
    types.extend(state(context, operation).map(|(_, ty, _)| ty));
    types
}

/// Returns `sets_off(…)` of a command.
pub fn sets_off(context: &Context<'_>, command: &Operation) -> Option<String> {
    let messages = command.messages()?;
    let reports = set_off(context, command).map(|(set_off, _, report)| {
        let ties = set_off.tied.iter().map(|tie| {
            let ours = steps(context, &messages.body(tie.side).ty, &tie.command);
            let theirs = steps(context, &report.request.ty, &tie.report);
            format!("{}.{ours} = {theirs}", tie.side.name())
        });
        let (name, ties) = (context.name_of(&report.request.ty), ties.joined(", "));
        match ties.as_str() {
            "" => name.to_owned(),
            ties => format!("{name}({ties})"),
        }
    });
    let reports = reports.joined(", ");
    (!reports.is_empty()).then(|| format!("sets_off({reports})"))
}

/// Returns `state(…)` and `failure(…)` of a report.
pub fn stage(context: &Context<'_>, report: &Operation) -> Vec<String> {
    let (Exchange::Report { failures, .. }, Some(messages)) = (&report.exchange, report.messages())
    else {
        return Vec::new();
    };
    let body = &messages.request.ty;
    let mut items = Vec::new();
    items.extend(state(context, report).map(|(keys, ty, _)| {
        let steps = steps(context, body, keys);
        format!("state({steps}: {})", context.name_of(ty))
    }));
    if !failures.is_empty() {
        let failures = failures.iter().map(|keys| steps(context, body, keys));
        items.push(format!("failure({})", failures.joined(", ")));
    }
    items
}

/// Returns the path to a field for the derives: the field names, with `?` after each `Option`.
fn steps(context: &Context<'_>, body: &StructRef, keys: &[String]) -> String {
    let steps = context.steps(body, keys).into_iter().map(|step| {
        let optional = if step.optional { "?" } else { "" };
        [step.name, optional].concat()
    });
    steps.joined(".")
}
