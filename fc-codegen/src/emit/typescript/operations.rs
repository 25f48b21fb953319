//! `commands.ts`, `reports.ts` and `streams.ts` of a group: a constant for each operation with all that the runtime has to know of it.

use super::constants::constant;
use super::context::{Context, page_of};
use super::group::Group;
use super::layout::Layout;
use super::source::{Source, float, head, import_types, literal};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::process::{is_followed, set_off};
use crate::emit::stub::source::join;
use crate::sample::{Profile, Samples};
use crate::surface::expr::{Expr, Expressions};
use crate::surface::language::{Role, TYPESCRIPT};
use crate::surface::package::{Call, Shape};
use fc_spec::model::{
    Accepted, AcceptedIn, Ack, Cadence, Direction, Exchange, Operation, SetOff, StructRef, Text,
    Type, TypeRef,
};

/// Members of an object.
type Members = Vec<(&'static str, Layout)>;

/// What `commands.ts` says of itself.
pub const COMMANDS: [&str; 2] = ["每条指令的描述数据。", "Every command as data."];

/// `commands.ts` of a group.
pub fn commands(context: &Context<'_>, samples: &Samples<'_>, group: &Group<'_, '_>) -> String {
    let commands = &group.commands;
    let mut out = head(COMMANDS);
    let mut names = vec!["AnyCommand"];
    for call in commands {
        names.push(command_type(context, call.operation));
    }
    import_types(&mut out, &names, "../../../src/runtime.ts");
    out.line("import * as messages from '../../messages.ts'");
    if names.contains(&"FollowedCommand") {
        out.line("import * as reports from '../../reports.ts'");
    }
    out.line("import * as schemas from '../../schemas.ts'");
    for call in commands {
        command(&mut out, context, samples, call);
    }
    let about =
        "/** 本组的指令，按方法名。The commands of the group, by the names of their methods. */";
    let methods: Vec<String> = commands.iter().map(|it| it.method.to_owned()).collect();
    all(&mut out, about, "AnyCommand", &methods);
    out.finish()
}

/// What the group has for the lists of the package, in the order of the spec; `export *` leaves it out.
fn all(out: &mut Source, about: &str, ty: &str, members: &[String]) {
    out.blank();
    out.line(about);
    // Each on a line of its own, so that one more changes no line of another.
    let close = format!("}} as Readonly<Record<string, {ty}>>");
    out.lines("export default {", members, &close);
}

/// What the runtime calls the type of a command's constant.
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
    let types = [Some(request), Some(response), report, failure]
        .into_iter()
        .flatten();
    let types: Vec<String> = types.map(|name| format!("messages.{name}")).collect();

    let example = |side| example(context, samples, operation, side);
    let errors = context.package.errors(operation).map(|(_, result)| {
        let parts = [
            ("code", Layout::number(result.code)),
            ("text", Layout::text(&result.text.zh)),
        ];
        (&*result.name, Layout::object(parts))
    });
    let mut members = facts_of(operation, "command");
    members.extend(
        operation
            .effect()
            .map(|effect| ("effect", Layout::text(effect.name()))),
    );
    members.extend([
        ("request", Layout::word(format!("schemas.{request}"))),
        ("response", Layout::word(format!("schemas.{response}"))),
        ("requestExample", example(Direction::Request)),
        ("responseExample", example(Direction::Response)),
        ("errors", Layout::object(errors)),
    ]);
    members.extend(
        operation
            .accepted()
            .map(|it| ("preconditions", preconditions(context, it))),
    );
    if let Some((set_off, report, messages)) = followed
        && let Some(report) = context.package.call(report)
    {
        let parts = [
            ("report", Layout::word(format!("reports.{}", report.method))),
            (
                "tied",
                ties(context, set_off, operation, &messages.request.ty),
            ),
        ];
        members.push(("setsOff", Layout::object(parts)));
    }
    write(
        out,
        context,
        operation,
        call.method,
        command_type(context, operation),
        &types,
        members,
    );
}

/// `export const name: Type<A, B> = { … }` and its comment.
fn write(
    out: &mut Source,
    context: &Context<'_>,
    operation: &Operation,
    name: &str,
    ty: &str,
    types: &[String],
    members: Members,
) {
    let mut docs = Docs::of(&operation.title);
    docs.paragraph(context.links(&operation.location, &page_of(operation)));
    super::messages::deprecated(&mut docs, operation.deprecated.as_ref());
    out.blank();
    out.docs(&docs);
    typed(out, name, ty, types, &Layout::lines(members));
}

/// `export const name: Type<A, B> = value`.
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

/// How an acknowledgement is awaited.
pub fn ack_policy(ack: Ack) -> Layout {
    let (timeout, retries) = (Layout::number(ack.timeout_ms), Layout::number(ack.retries));
    Layout::object([("timeout", timeout), ("retries", retries)])
}

/// The command code; `null` while none is assigned.
pub fn code(operation: &Operation) -> Layout {
    let code = operation.code.value.map(|_| &operation.code.spelling);
    Layout::word(code.map_or_else(|| "null".to_owned(), |it| it.to_lowercase()))
}

/// A text in both languages.
pub fn languages(text: &Text) -> [(&'static str, Layout); 2] {
    [
        ("zh", Layout::text(&text.zh)),
        ("en", Layout::text(&text.en)),
    ]
}

/// What every operation says of itself.
fn facts_of(operation: &Operation, is: &str) -> Members {
    let mut members = vec![
        ("is", Layout::text(is)),
        ("name", Layout::text(&operation.name)),
        ("code", code(operation)),
        ("title", Layout::object(languages(&operation.title))),
    ];
    members.extend(
        operation
            .since
            .as_ref()
            .map(|since| ("since", Layout::text(since))),
    );
    members.extend(Layout::flag("deprecated", operation.deprecated.is_some()));
    members.push(("docs", Layout::text(&page_of(operation))));
    members.push(("spec", Layout::text(&operation.location.file)));
    members
}

/// A function that gives the spec's example of a body.
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
    let record = Expressions::new(&context.package, samples).record(&body.ty, &value);
    let value = constant(context, &Expr::Record(record), false);
    Layout::Around("() => (", Box::new(value), ")")
}

/// What has to hold before a command is accepted.
fn preconditions(context: &Context<'_>, accepted: &Accepted) -> Layout {
    let sets = accepted.state_sets().iter().map(|set| {
        let item = context.package.item(&set.ty);
        let ty = &item.ty.name;
        let known = match &item.shape {
            Shape::Enum(_, values) => values.as_slice(),
            _ => &[],
        };
        let values = known
            .iter()
            .filter(|value| set.values.contains(&value.wire));
        let values = values.map(|value| Layout::word(format!("messages.{ty}.{}", value.name)));
        Layout::object([
            ("of", Layout::word(format!("schemas.{ty}"))),
            ("values", Layout::list(values)),
        ])
    });
    let states = match &accepted.states {
        None => None,
        Some(AcceptedIn::Any) => Some(Layout::text("any")),
        Some(AcceptedIn::States(_)) => Some(Layout::list(sets)),
    };
    let states = states.map(|states| ("states", states));
    Layout::object(
        states
            .into_iter()
            .chain([("after", Layout::texts(&accepted.after))]),
    )
}

/// What ties a report to a call, as functions that take both values.
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

/// The way to a field: `.data?.state`.
fn path(context: &Context<'_>, body: &StructRef, keys: &[String]) -> String {
    let mut holder: Option<&TypeRef> = Some(body);
    let mut out = String::new();
    let mut dot = ".";
    for field in context.model().way(body, keys) {
        let name = holder.map_or(field.name.as_str(), |ty| context.field_name(ty, field));
        out.extend([dot, name]);
        dot = if field.optional { "?." } else { "." };
        holder = match &field.ty {
            Type::Named(named) => Some(named),
            _ => None,
        };
    }
    out
}

/// What `reports.ts` says of itself.
pub const REPORTS: [&str; 2] = ["每种上报的描述数据。", "Every report as data."];

/// `reports.ts` of a group.
pub fn reports(context: &Context<'_>, samples: &Samples<'_>, group: &Group<'_, '_>) -> String {
    let reports = &group.reports;
    let mut out = head(REPORTS);
    import_types(
        &mut out,
        &["AnyReportOf", "Report"],
        "../../../src/runtime.ts",
    );
    out.line("import * as messages from '../../messages.ts'");
    out.line("import * as schemas from '../../schemas.ts'");
    for call in reports {
        let body = &*call.request.ty.name;
        let mut members = facts_of(call.operation, "report");
        members.insert(2, ("case", Layout::text(body)));
        members.push(("body", Layout::word(format!("schemas.{body}"))));
        let acknowledgement = format!("schemas.{}", call.response.ty.name);
        members.push(("acknowledgement", Layout::word(acknowledgement)));
        members.push((
            "example",
            example(context, samples, call.operation, Direction::Request),
        ));
        members.extend(call.operation.cadence().map(|it| ("cadence", cadence(it))));
        members.extend(process(context, &call.operation.exchange));
        let types = [format!("messages.{body}"), literal(body)];
        write(
            &mut out,
            context,
            call.operation,
            call.method,
            "Report",
            &types,
            members,
        );
    }
    let about =
        "/** 本组的上报，按方法名。The reports of the group, by the names of their methods. */";
    let methods: Vec<String> = reports.iter().map(|it| it.method.to_owned()).collect();
    all(&mut out, about, "AnyReportOf", &methods);
    out.finish()
}

/// How a report is acknowledged, and what it says of how far a process has come.
fn process(context: &Context<'_>, exchange: &Exchange) -> Members {
    let Exchange::Report {
        ack,
        state,
        failures,
        messages,
        ..
    } = exchange
    else {
        return Vec::new();
    };
    let state_of = |keys: &[String]| {
        let body = &messages.request.ty;
        let (ty, _) = context.model().enum_at(body, keys)?;
        let schema = Layout::word(format!("schemas.{}", context.name_of(ty)));
        let of = format!("(report) => report{}", path(context, body, keys));
        Some(Layout::object([
            ("schema", schema),
            ("of", Layout::word(of)),
        ]))
    };
    let mut members = vec![("ack", ack_policy(*ack))];
    members.extend(
        state
            .as_deref()
            .and_then(state_of)
            .map(|state| ("state", state)),
    );
    if !failures.is_empty() {
        members.push((
            "failures",
            Layout::list(failures.iter().filter_map(|keys| state_of(keys))),
        ));
    }
    members
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

/// What `streams.ts` says of itself.
pub const STREAMS: [&str; 2] = ["每个数据流的描述数据。", "Every stream as data."];

/// `streams.ts` of a group.
pub fn streams(context: &Context<'_>, _: &Samples<'_>, group: &Group<'_, '_>) -> String {
    let streams = &group.streams;
    let mut out = head(STREAMS);
    import_types(
        &mut out,
        &["AnyStream", "Stream"],
        "../../../src/runtime.ts",
    );
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
        let schema = body.map_or_else(|| "null".to_owned(), |name| format!("schemas.{name}"));
        let mut members = facts_of(stream, "stream");
        members.push(("from", Layout::text(stream.sender.name())));
        members.push(("content", Layout::word(schema)));
        if let Some(facts) = stream.stream() {
            let media = facts.content.media_type().filter(|_| body.is_none());
            let (started, stopped) = (facts.started_by.as_deref(), facts.stopped_by.as_deref());
            let said = [
                ("mediaType", media),
                ("startedBy", started),
                ("stoppedBy", stopped),
            ];
            members.extend(
                said.into_iter()
                    .filter_map(|(key, word)| Some((key, Layout::text(word?)))),
            );
        }
        write(
            &mut out,
            context,
            stream,
            &stream_name(stream),
            "Stream",
            &[carried(context, stream, "messages.")],
            members,
        );
    }
    let about = "/** 本组的数据流，按方法名中的名称。The streams of the group, by the names in their methods. */";
    let named = streams
        .iter()
        .map(|it| format!("{}: {}", it.name, stream_name(it)));
    all(&mut out, about, "AnyStream", &named.collect::<Vec<_>>());
    out.finish()
}

/// What a stream's constant is called.
pub fn stream_name(stream: &Operation) -> String {
    let name = TYPESCRIPT.spelling(Role::Method, &stream.name);
    name.unwrap_or_else(|name| name).into_owned()
}

/// The type of what a stream's frames carry, in a file that has `prefix` before the name of a message.
pub fn carried(context: &Context<'_>, stream: &Operation, prefix: &str) -> String {
    let body = stream.body(Direction::Request);
    body.map_or_else(
        || "Uint8Array".to_owned(),
        |body| [prefix, context.name_of(&body.ty)].concat(),
    )
}
