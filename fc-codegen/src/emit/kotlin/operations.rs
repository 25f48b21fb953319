//! `Operations`: every command and report as a value, with what the runtime needs of it.

use super::text::{STYLE, literal};
use crate::emit::stub::context::{Context, page_of};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::emit::stub::process::state;
use crate::emit::stub::source::Source;
use crate::surface::package::{Call, Shape};
use fc_spec::model::{Accepted, Cadence, Exchange, Field, Operation, StructRef, Type, TypeRef};

/// The file.
pub fn file(context: &Context<'_>) -> Source {
    let mut out = Source::new(&STYLE);
    out.docs(&Docs::said(&[
        "每条指令和每个主动上报。",
        "Every command and every report.",
    ]));
    out.block("public object Operations", |out| {
        for command in context.commands() {
            command_value(out, context, &command);
        }
        for report in context.reports() {
            report_value(out, context, &report);
        }
    });
    out
}

fn docs(out: &mut Source, context: &Context<'_>, operation: &Operation) {
    let mut docs = facts::operation_docs(operation);
    facts::operation_end(&STYLE, &mut docs, operation);
    docs.paragraph(context.links(&operation.location, &page_of(operation)));
    out.blank();
    out.docs(&docs);
    deprecated(out, operation);
    out.line("@JvmField");
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
    docs(out, context, operation);
    let (request, response) = (&command.request.ty.name, &command.response.ty.name);
    let head = format!(
        "public val {}: Command<{request}, {response}> =",
        command.method
    );
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
    docs(out, context, operation);
    let (request, response) = (&report.request.ty.name, &report.response.ty.name);
    let head = format!("public val {}: Report<{request}> =", report.method);
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
