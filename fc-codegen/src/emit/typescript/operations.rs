//! `commands.ts`, `reports.ts` and `streams.ts` of a group: a constant for each operation.
//!
//! The constants contain all facts that the runtime needs.

use super::constants::constant;
use super::context::{Context, page_of, spelled};
use super::group::Group;
use super::layout::{Layout, Members};
use super::messages::end;
use super::source::{Source, float, head, literal, named};
use crate::package::docs::Docs;
use crate::package::expr::Expr;
use crate::package::items::Call;
use crate::package::language::Role;
use crate::package::process::{is_followed, set_off};
use crate::package::source::join;
use crate::sample::{Profile, Samples};
use fc_spec::model::{
    AcceptedIn, Ack, Cadence, Direction, Exchange, Operation, SetOff, StructRef, Text,
};

pub const COMMANDS: [&str; 2] = ["每条指令的描述数据。", "Every command as data."];

pub fn commands(context: &Context<'_>, samples: &Samples<'_>, group: &Group<'_, '_>) -> String {
    let commands = &group.commands;
    let mut out = head(context, COMMANDS);
    let mut names = vec!["AnyCommand"];
    for call in commands {
        names.push(command_type(context, call.operation));
    }
    named(&mut out, "import type", &names, "../../../src/runtime.ts");
    out.line("import * as messages from '../../messages.ts'");
    if names.contains(&"FollowedCommand") {
        out.line("import * as reports from '../../reports.ts'");
    }
    out.line("import * as schemas from '../../schemas.ts'");
    for call in commands {
        command(&mut out, context, samples, call);
    }
    let methods: Vec<String> = commands.iter().map(|it| it.method.to_owned()).collect();
    all(&mut out, "commands_of_group", "AnyCommand", &methods);
    out.finish()
}

/// Writes the group's entry for the lists of the package, in the order of the spec.
///
/// The entry is a default export, which `export *` skips.
fn all(out: &mut Source, about: &str, ty: &str, members: &[String]) {
    out.template(about, &[]);
    // Each member has a separate line, so that a new member changes no other line.
    let close = format!("}} as Readonly<Record<string, {ty}>>");
    out.lines("export default {", members, &close);
}

/// Returns the runtime type of a command's constant.
fn command_type(context: &Context<'_>, command: &Operation) -> &'static str {
    if is_followed(context, command) {
        "FollowedCommand"
    } else {
        "Command"
    }
}

fn command(out: &mut Source, context: &Context<'_>, samples: &Samples<'_>, call: &Call<'_>) {
    let operation = call.operation;
    let [request, response] = [call.request, call.response].map(|it| &*it.ty.name);
    let followed = set_off(context, operation).next();
    let report = followed.map(|(_, _, messages)| context.name_of(&messages.request.ty));
    let failure = context.package.error_type(operation);
    let types = [Some(request), Some(response), report, failure];
    let types = types.into_iter().flatten();
    let types: Vec<String> = types.map(|name| format!("messages.{name}")).collect();

    let example = |side| example(context, samples, operation, side);
    let errors = context.package.errors(operation).map(|(_, result)| {
        let parts = [
            ("code", Layout::number(result.code)),
            ("text", Layout::text(&result.text.zh)),
        ];
        (&*result.name, Layout::object(parts))
    });
    let sets_off = followed.and_then(|(set_off, report, messages)| {
        let method = context.package.call(report)?.method;
        let tied = ties(context, set_off, operation, &messages.request.ty);
        let report = Layout::path(["reports", method]);
        Some(Layout::object([("report", report), ("tied", tied)]))
    });
    let members = facts_of(operation, None)
        .with(
            "effect",
            operation.effect().map(|it| Layout::text(it.name())),
        )
        .with("request", Layout::path(["schemas", request]))
        .with("response", Layout::path(["schemas", response]))
        .with("requestExample", example(Direction::Request))
        .with("responseExample", example(Direction::Response))
        .with("errors", Layout::object(errors))
        .with("preconditions", preconditions(context, operation))
        .with("setsOff", sets_off);
    let ty = command_type(context, operation);
    write(out, context, operation, [call.method, ty], &types, members);
}

/// Writes `export const name: Type<A, B> = { … }` and its comment.
fn write(
    out: &mut Source,
    context: &Context<'_>,
    operation: &Operation,
    [name, ty]: [&str; 2],
    types: &[String],
    members: Members,
) {
    let mut docs = Docs::titled(&operation.title);
    end(&mut docs, context, operation);
    out.blank();
    out.docs(&docs);
    typed(out, name, ty, types, &members.lines());
}

/// Writes `export const name: Type<A, B> = value`.
pub fn typed(out: &mut Source, name: &str, ty: &str, types: &[String], value: &Layout) {
    let head = format!("export const {name}: {ty}<{}> = ", join(types));
    if out.has_room([&head, "{"]) {
        return value.write(out, &head, "");
    }
    out.enclose(&format!("export const {name}: {ty}<"), "", |out| {
        // The last type has no comma.
        out.line(types.join(",\n"));
    });
    value.write(out, "> = ", "");
}

/// Returns the timeout and the retries of an acknowledgement.
pub fn ack_policy(ack: Ack) -> Layout {
    let (timeout, retries) = (Layout::number(ack.timeout_ms), Layout::number(ack.retries));
    Layout::object([("timeout", timeout), ("retries", retries)])
}

/// Returns the command code; `null` if none is assigned.
pub fn code(operation: &Operation) -> Layout {
    let code = operation.code.value.map(|_| &operation.code.spelling);
    Layout::word(code.map_or_else(|| "null".to_owned(), |it| it.to_lowercase()))
}

/// Returns a text in both languages.
pub fn languages(text: &Text) -> [(&'static str, Layout); 2] {
    [
        ("zh", Layout::text(&text.zh)),
        ("en", Layout::text(&text.en)),
    ]
}

/// Returns the members of every operation. `case` is the name of a report among those of `reports()`.
fn facts_of(operation: &Operation, case: Option<&str>) -> Members {
    Members::default()
        .with("is", Layout::text(operation.kind().name()))
        .with("name", Layout::text(&operation.name))
        .with("case", case.map(Layout::text))
        .with("code", code(operation))
        .with("title", Layout::object(languages(&operation.title)))
        .with("since", operation.since.as_deref().map(Layout::text))
        .with("deprecated", Layout::flag(operation.deprecated.is_some()))
        .with("docs", Layout::text(&page_of(operation)))
        .with("spec", Layout::text(&operation.location.file))
}

/// Returns a function that returns the spec's example of a body.
fn example(
    context: &Context<'_>,
    samples: &Samples<'_>,
    operation: &Operation,
    direction: Direction,
) -> Layout {
    let Some(body) = operation.body(direction) else {
        return Layout::word("() => ({})");
    };
    let value = samples.body(operation, direction, Profile::Example);
    let record = context.package.record(&body.ty, &value);
    let value = constant(context, &Expr::Record(record), false);
    Layout::Around("() => (".into(), Box::new(value), ")")
}

/// Returns the conditions under which a command is accepted.
fn preconditions(context: &Context<'_>, command: &Operation) -> Option<Layout> {
    let accepted = command.accepted()?;
    let sets = context.accepted_states(command).into_iter().map(|set| {
        let ty = &*set.item.ty.name;
        let values = set.values.iter();
        let values = values.map(|value| Layout::path(["messages", ty, &value.name]));
        Layout::object([
            ("of", Layout::path(["schemas", ty])),
            ("values", Layout::list(values)),
        ])
    });
    let states = accepted.states.as_ref().map(|states| match states {
        AcceptedIn::Any => Layout::text("any"),
        AcceptedIn::States(_) => Layout::list(sets),
    });
    let members = Members::default().with("states", states);
    let after = Layout::texts(&accepted.after);
    Some(members.with("after", after).object())
}

/// Returns the ties between a report and a call, as functions that select both values.
fn ties(
    context: &Context<'_>,
    set_off: &SetOff,
    command: &Operation,
    report: &StructRef,
) -> Layout {
    let ties = set_off.tied.iter().filter_map(|tie| {
        let body = &command.messages()?.body(tie.side).ty;
        let parameters = match tie.side {
            Direction::Request => "(request)",
            Direction::Response => "(_request, response)",
        };
        let ours = path(context, body, &tie.command);
        let call = format!("{parameters} => {}{ours}", tie.side.name());
        let theirs = format!("(report) => report{}", path(context, report, &tie.report));
        Some(Layout::object([
            ("call", Layout::word(call)),
            ("report", Layout::word(theirs)),
        ]))
    });
    Layout::list(ties)
}

/// Returns the path to a field: `.data?.state`.
fn path(context: &Context<'_>, body: &StructRef, keys: &[String]) -> String {
    let mut out = String::new();
    let mut dot = ".";
    for step in context.steps(body, keys) {
        out.extend([dot, step.name]);
        dot = if step.optional { "?." } else { "." };
    }
    out
}

pub const REPORTS: [&str; 2] = ["每种上报的描述数据。", "Every report as data."];

pub fn reports(context: &Context<'_>, samples: &Samples<'_>, group: &Group<'_, '_>) -> String {
    let reports = &group.reports;
    let mut out = head(context, REPORTS);
    let names = ["AnyReportOf", "Report"];
    named(&mut out, "import type", names, "../../../src/runtime.ts");
    out.line("import * as messages from '../../messages.ts'");
    out.line("import * as schemas from '../../schemas.ts'");
    for call in reports {
        let operation = call.operation;
        let [body, acknowledgement] = [call.request, call.response].map(|it| &*it.ty.name);
        let members = facts_of(operation, Some(body))
            .with("body", Layout::path(["schemas", body]))
            .with(
                "acknowledgement",
                Layout::path(["schemas", acknowledgement]),
            )
            .with(
                "example",
                example(context, samples, operation, Direction::Request),
            )
            .with("cadence", operation.cadence().map(cadence));
        let members = process(members, context, &operation.exchange);
        let types = [format!("messages.{body}"), literal(body)];
        let names = [call.method, "Report"];
        write(&mut out, context, operation, names, &types, members);
    }
    let methods: Vec<String> = reports.iter().map(|it| it.method.to_owned()).collect();
    all(&mut out, "reports_of_group", "AnyReportOf", &methods);
    out.finish()
}

/// Adds the acknowledgement of a report, and the keys that show the progress of a process.
fn process(members: Members, context: &Context<'_>, exchange: &Exchange) -> Members {
    let Exchange::Report {
        ack,
        state,
        failures,
        messages,
        ..
    } = exchange
    else {
        return members;
    };
    let body = &messages.request.ty;
    let state_of = |keys: &[String]| {
        let (ty, _) = context.model().enum_at(body, keys)?;
        let of = format!("(report) => report{}", path(context, body, keys));
        Some(Layout::object([
            ("schema", Layout::path(["schemas", context.name_of(ty)])),
            ("of", Layout::word(of)),
        ]))
    };
    let failing = || Layout::list(failures.iter().filter_map(|keys| state_of(keys)));
    members
        .with("ack", ack_policy(*ack))
        .with("state", state.as_deref().and_then(state_of))
        .with("failures", (!failures.is_empty()).then(failing))
}

fn cadence(cadence: &Cadence) -> Layout {
    let is = |word| ("is", Layout::text(word));
    match cadence {
        Cadence::OnChange(field) => {
            Layout::object([is("on_change"), ("field", Layout::text(field))])
        }
        Cadence::Step(step) => {
            let by = Layout::Number(float(step.by.to_f64()));
            Layout::object([is("step"), ("field", Layout::text(&step.field)), ("by", by)])
        }
        Cadence::EveryMs(ms) => Layout::object([is("every"), ("ms", Layout::number(*ms))]),
        Cadence::WithinMs(ms) => Layout::object([is("within"), ("ms", Layout::number(*ms))]),
    }
}

pub const STREAMS: [&str; 2] = ["每个数据流的描述数据。", "Every stream as data."];

pub fn streams(context: &Context<'_>, _: &Samples<'_>, group: &Group<'_, '_>) -> String {
    let streams = &group.streams;
    let mut out = head(context, STREAMS);
    let names = ["AnyStream", "Stream"];
    named(&mut out, "import type", names, "../../../src/runtime.ts");
    if streams
        .iter()
        .any(|stream| stream.body(Direction::Request).is_some())
    {
        out.line("import type * as messages from '../../messages.ts'");
        out.line("import * as schemas from '../../schemas.ts'");
    }
    for stream in streams {
        let body = stream
            .body(Direction::Request)
            .map(|body| context.name_of(&body.ty));
        let facts = stream.stream();
        let media = facts.and_then(|it| it.content.media_type());
        let started = facts.and_then(|it| it.started_by.as_deref());
        let stopped = facts.and_then(|it| it.stopped_by.as_deref());
        let schema = body.map(|body| Layout::path(["schemas", body]));
        let members = facts_of(stream, None)
            .with("from", Layout::text(stream.sender.name()))
            .with("content", schema.unwrap_or_else(|| Layout::word("null")))
            .with(
                "mediaType",
                media.filter(|_| body.is_none()).map(Layout::text),
            )
            .with("startedBy", started.map(Layout::text))
            .with("stoppedBy", stopped.map(Layout::text));
        let name = spelled(Role::Method, &stream.of.name);
        let types = [carried(context, stream, "messages.")];
        write(
            &mut out,
            context,
            stream,
            [&name, "Stream"],
            &types,
            members,
        );
    }
    let members = streams
        .iter()
        .map(|it| format!("{}: {}", it.name, spelled(Role::Method, &it.of.name)));
    all(
        &mut out,
        "streams_of_group",
        "AnyStream",
        &members.collect::<Vec<_>>(),
    );
    out.finish()
}

/// Returns the content type of a stream. `prefix` precedes the name of a message.
pub fn carried(context: &Context<'_>, stream: &Operation, prefix: &str) -> String {
    let body = stream.body(Direction::Request);
    body.map_or_else(
        || "Uint8Array".to_owned(),
        |body| [prefix, context.name_of(&body.ty)].concat(),
    )
}
