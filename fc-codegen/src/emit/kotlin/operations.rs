//! `Operations`: every command and report as a value, with what the runtime needs of it.

use super::group::{Group, heading, parts};
use super::messages::both;
use super::text::{STYLE, literal};
use crate::emit::stub::context::{Context, page_of};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::emit::stub::process::state;
use crate::emit::stub::source::Source;
use crate::surface::package::{Call, Shape};
use fc_spec::model::{
    Accepted, Cadence, Exchange, Field, Kind, Operation, StructRef, Type, TypeRef,
};

/// The file.
pub fn file(groups: &[Group<'_>]) -> Source {
    let mut out = Source::new(&STYLE);
    out.docs(&Docs::said(&[
        "每条指令和每个上报。",
        "Every command and every report.",
    ]));
    let parts = parts(groups, "Operations", has_calls);
    out.line(heading("public object Operations", &parts));
    out
}

fn has_calls(group: &Group<'_>) -> bool {
    !(group.commands.is_empty() && group.reports.is_empty())
}

/// The commands and reports of a group. Java has constants from an interface, and Kotlin has properties: neither has the other's.
pub fn part(out: &mut Source, context: &Context<'_>, group: &Group<'_>) {
    if !has_calls(group) {
        return;
    }
    out.blank();
    out.docs(&group.docs("Operations"));
    let head = format!("public interface {}", group.part("Operations"));
    out.block(head, |out| {
        for call in group.commands.iter().chain(&group.reports) {
            let mut docs = facts::operation_docs(call.operation);
            facts::operation_end(&STYLE, &mut docs, call.operation);
            docs.paragraph(links(context, call.operation));
            out.blank();
            out.docs(&docs);
            deprecated(out, call.operation);
            let (method, ty) = (call.method, type_of(call));
            let head = format!("public val {method}: {ty}");
            let getter = format!("get() = Companion.{method}");
            if out.has_room([&head, " ", &getter]) {
                out.line([&head, " ", &getter].concat());
            } else {
                out.enclose(&head, "", |out| out.line(getter));
            }
        }
        out.blank();
        out.docs(&both(
            "这些常量供 Java 使用。",
            "The same as constants, for Java.",
        ));
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

/// What the protocol knows of the group.
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

fn links(context: &Context<'_>, operation: &Operation) -> String {
    context.links(&operation.location, &page_of(operation))
}

/// The head of a constant.
fn constant(out: &mut Source, context: &Context<'_>, call: &Call<'_>) -> String {
    let mut docs = Docs::of(&call.operation.title);
    docs.paragraph(links(context, call.operation));
    out.blank();
    out.docs(&docs);
    deprecated(out, call.operation);
    out.line("@JvmField");
    format!("public val {}: {} =", call.method, type_of(call))
}

/// The mark of what is withdrawn.
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
    let errors = context.package.errors(operation);
    let errors: Vec<String> = errors
        .map(|(error, result)| {
            let (name, text) = (literal(&result.of.name), literal(&result.text.zh));
            format!("DeclaredError({name}, {}, {text})", error.code)
        })
        .collect();
    if !errors.is_empty() {
        made.push(format!("    .declares({})", errors.join(", ")));
    }
    let states = accepted(context, operation);
    if !states.is_empty() {
        made.push(format!("    .accepted({})", states.join(", ")));
    }
    out.enclose(&head, "", |out| made.iter().for_each(|line| out.line(line)));
}

/// What people call an operation.
fn titled(operation: &Operation) -> String {
    let title = &operation.title;
    format!(
        "    .titled({}, {})",
        literal(&title.zh),
        literal(&title.en)
    )
}

/// The states in which a command is accepted.
fn accepted(context: &Context<'_>, operation: &Operation) -> Vec<String> {
    let mut states = Vec::new();
    let sets = operation
        .accepted()
        .map(Accepted::state_sets)
        .unwrap_or_default();
    for set in sets {
        let item = context.package.item(&set.ty);
        if let Shape::Enum(_, known) = &item.shape {
            let known = known
                .iter()
                .filter(|value| set.values.contains(&value.wire));
            states.extend(known.map(|value| format!("{}.{}", item.ty.name, value.name)));
        }
    }
    states
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
    if let Some(Cadence::EveryMs(every)) = cadence {
        made.push(format!("    .every({every})"));
    }
    let body = &messages.request.ty;
    let state = state(context, operation).map(|(keys, _)| way(context, body, keys, "report"));
    // An enum of which nothing is said as a state tells nothing of failures either.
    let failing = failures.iter().filter(|keys| is_state(context, body, keys));
    let failing = failing.map(|keys| way(context, body, keys, "report"));
    let mut failing: Vec<String> = failing.collect();
    if let Some(state) = state.filter(|_| has_state(context, operation)) {
        made.push(format!("    .state {{ report -> {state} }}"));
        if !failing.is_empty() {
            failing.insert(0, state);
        }
    }
    if !failing.is_empty() {
        let failing: Vec<String> = failing
            .iter()
            .map(|it| format!("({it} as State?)?.isError == true"))
            .collect();
        made.push(format!(
            "    .failure {{ report -> {} }}",
            failing.join(" || ")
        ));
    }
    out.enclose(&head, "", |out| made.iter().for_each(|line| out.line(line)));
}

fn has_state(context: &Context<'_>, report: &Operation) -> bool {
    let shape = state(context, report).map(|(_, ty)| &context.package.item(ty).shape);
    matches!(shape, Some(Shape::Enum(shape, _)) if says(shape))
}

fn is_state(context: &Context<'_>, body: &StructRef, keys: &[String]) -> bool {
    let at = context.model().enum_at(body, keys);
    at.is_some_and(|(_, shape)| says(shape))
}

fn says(shape: &fc_spec::model::EnumType) -> bool {
    let mut values = shape.values.iter();
    shape.order.is_some() || values.any(|it| it.is_final || it.is_error || !it.then.is_empty())
}

/// The way to a field: `report.data?.status`.
pub fn way(context: &Context<'_>, body: &StructRef, keys: &[String], from: &str) -> String {
    let mut out = from.to_owned();
    let mut holder: Option<&TypeRef> = Some(body);
    let mut dot = ".";
    for field in context.model().way(body, keys) {
        let field: &Field = field;
        let name = holder.map_or(field.name.as_str(), |ty| context.field_name(ty, field));
        out.push_str(dot);
        out.push_str(name);
        if field.optional {
            dot = "?.";
        }
        holder = match &field.ty {
            Type::Named(named) => Some(named),
            _ => None,
        };
    }
    out
}
