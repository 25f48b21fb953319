//! `Operations`: every command and report as a value, with the facts that the runtime needs.

use super::group::{heading, part_name, part_of, parts};
use super::text::literal;
use crate::package::context::{Context, page_of};
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::group::Group;
use crate::package::items::Call;
use crate::package::joined::Joined;
use crate::package::process::{has_states, state};
use crate::package::source::Source;
use fc_spec::model::{AcceptedIn, Cadence, Exchange, Kind, Operation, StructRef};

/// Generates `Operations.kt`.
pub fn operations_file(context: &Context<'_>, groups: &[Group<'_, '_>]) -> Source {
    let mut out = context.source();
    let parts = parts(groups, "Operations", has_calls);
    let heading = heading("public object Operations", &parts);
    out.template("operations", &[("heading", &heading)]);
    out
}

fn has_calls(group: &Group<'_, '_>) -> bool {
    !(group.commands.is_empty() && group.reports.is_empty())
}

/// Writes the commands and reports of a group, as constants and as properties.
///
/// Java reads constants from an interface, Kotlin reads properties, and neither can read the other form.
pub fn part(out: &mut Source, context: &Context<'_>, group: &Group<'_, '_>) {
    if !has_calls(group) {
        return;
    }
    let name = part_name(group, "Operations");
    part_of(out, group, "Operations", &name, |out| {
        for call in group.commands.iter().chain(&group.reports) {
            out.documented(&facts::constant_docs(context, call.operation));
            deprecated(out, call.operation);
            let (method, ty) = (call.method, type_of(call));
            let head = format!("public val {method}: {ty}");
            let getter = format!("get() = Companion.{method}");
            out.line_or([&head, " ", &getter], |out| {
                out.enclose(&head, "", |out| out.line(&getter));
            });
        }
        out.template("constants", &[]);
        out.block("public companion object", |out| {
            for command in &group.commands {
                command_value(out, context, command);
            }
            for report in &group.reports {
                report_value(out, context, report);
            }
            list(out, "commands", "Command<*, *>", &group.commands);
            list(out, "reports", "Report<*>", &group.reports);
        });
    });
}

/// Writes the list of a group's commands or reports, for the protocol.
fn list(out: &mut Source, name: &str, ty: &str, calls: &[Call<'_>]) {
    if calls.is_empty() {
        return;
    }
    let methods: Vec<&str> = calls.iter().map(|it| it.method).collect();
    out.blank();
    out.enclose(&format!("internal fun {name}(): List<{ty}> ="), "", |out| {
        out.lines("listOf(", &methods, ")");
    });
}

fn type_of(call: &Call<'_>) -> String {
    let (request, response) = (&call.request.ty.name, &call.response.ty.name);
    match call.operation.kind() {
        Kind::Report => format!("Report<{request}>"),
        Kind::Command | Kind::Stream => format!("Command<{request}, {response}>"),
    }
}

/// Writes the comment on a constant, and returns its head.
fn constant(out: &mut Source, context: &Context<'_>, call: &Call<'_>) -> String {
    let operation = call.operation;
    let mut docs = Docs::titled(&operation.title);
    docs.paragraph(context.links(&operation.location, &page_of(operation)));
    out.documented(&docs);
    deprecated(out, operation);
    out.line("@JvmField");
    format!("public val {}: {} =", call.method, type_of(call))
}

/// Writes the annotation of a deprecated operation.
pub fn deprecated(out: &mut Source, operation: &Operation) {
    if let Some(deprecation) = &operation.deprecated {
        let note = literal(&facts::withdrawn_note(deprecation));
        out.line(format!("@Deprecated({note})"));
    }
}

fn command_value(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let operation = command.operation;
    let Exchange::Command { effect, .. } = &operation.exchange else {
        return;
    };
    let head = constant(out, context, command);
    let (request, response) = (&command.request.ty.name, &command.response.ty.name);
    let mut made = vec![format!(
        "Command({}, {}, Effect.{}, {request}, {response})",
        literal(&operation.name),
        operation.code.spelling,
        effect.name().to_uppercase()
    )];
    made.push(titled(operation));
    let errors = context.package.errors(operation).map(|(error, result)| {
        let (name, text) = (literal(&result.of.name), literal(&result.text.zh));
        format!("DeclaredError({name}, {}, {text})", error.code)
    });
    let errors = errors.joined(", ");
    if !errors.is_empty() {
        made.push(format!("    .declares({errors})"));
    }
    made.extend(preconditions(context, operation));
    out.enclose(&head, "", |out| made.iter().for_each(|line| out.line(line)));
}

/// Returns the titles of an operation in both languages.
fn titled(operation: &Operation) -> String {
    let title = &operation.title;
    format!(
        "    .titled({}, {})",
        literal(&title.zh),
        literal(&title.en)
    )
}

/// Returns the calls that set the conditions under which a command is accepted.
fn preconditions(context: &Context<'_>, operation: &Operation) -> Vec<String> {
    let Some(accepted) = operation.accepted() else {
        return Vec::new();
    };
    let mut calls = Vec::new();
    let states = context.accepted_states(operation);
    let states = states.iter().flat_map(|states| {
        let values = states.values.iter();
        values.map(|value| format!("{}.{}", states.item.ty.name, value.name))
    });
    let states: Vec<String> = states.collect();
    if !states.is_empty() {
        calls.push(format!("    .accepted({})", states.join(", ")));
    }
    if matches!(accepted.states, Some(AcceptedIn::Any)) {
        calls.push("    .acceptedAlways()".to_owned());
    }
    if !accepted.after.is_empty() {
        let after = accepted.after.iter().map(|name| literal(name)).joined(", ");
        calls.push(format!("    .after({after})"));
    }
    calls
}

/// Returns the call that sets the time at which a report is sent.
fn sent_at(cadence: &Cadence) -> String {
    let made = match cadence {
        Cadence::OnChange(field) => format!("OnChange({})", literal(field)),
        Cadence::Step(step) => format!("Step({}, {:?})", literal(&step.field), step.by.to_f64()),
        Cadence::EveryMs(ms) => format!("Every({ms})"),
        Cadence::WithinMs(ms) => format!("Within({ms})"),
    };
    format!("    .cadence(Cadence.{made})")
}

fn report_value(out: &mut Source, context: &Context<'_>, report: &Call<'_>) {
    let operation = report.operation;
    let Exchange::Report {
        ack,
        cadence,
        failures,
        messages,
        ..
    } = &operation.exchange
    else {
        return;
    };
    let head = constant(out, context, report);
    let (request, response) = (&report.request.ty.name, &report.response.ty.name);
    let (name, code) = (literal(&operation.name), &operation.code.spelling);
    let mut made = vec![
        format!("Report({name}, {code}, {request}, {response})"),
        titled(operation),
        format!("    .ack(AckPolicy({}, {}))", ack.timeout_ms, ack.retries),
    ];
    made.extend(cadence.as_ref().map(sent_at));
    let body = &messages.request.ty;
    let state = state(context, operation).filter(|(_, _, shape)| has_states(shape));
    // An enum without states has no failures either.
    let failing = failures.iter().filter(|keys| is_state(context, body, keys));
    let failing = failing.map(|keys| way(context, body, keys, "report"));
    let mut failing: Vec<String> = failing.collect();
    if let Some((keys, ..)) = state {
        let state = way(context, body, keys, "report");
        made.push(format!("    .state {{ report -> {state} }}"));
        if !failing.is_empty() {
            failing.insert(0, state);
        }
    }
    if !failing.is_empty() {
        let failing = failing.iter();
        let failing = failing.map(|it| format!("({it} as State?)?.isError == true"));
        let failing = failing.joined(" || ");
        made.push(format!("    .failure {{ report -> {failing} }}"));
    }
    out.enclose(&head, "", |out| made.iter().for_each(|line| out.line(line)));
}

fn is_state(context: &Context<'_>, body: &StructRef, keys: &[String]) -> bool {
    let at = context.model().enum_at(body, keys);
    at.is_some_and(|(_, shape)| has_states(shape))
}

/// Returns the path to a field: `report.data?.status`.
pub fn way(context: &Context<'_>, body: &StructRef, keys: &[String], from: &str) -> String {
    let mut out = from.to_owned();
    let mut dot = ".";
    for step in context.steps(body, keys) {
        out.extend([dot, step.name]);
        if step.optional {
            dot = "?.";
        }
    }
    out
}
