//! `commands.ts`, `reports.ts` and `streams.ts`: a constant for each operation with all that the runtime has to know of
//! it; `operations.ts`: the protocol that they belong to.

use super::constants::constant;
use super::context::{Context, page_of};
use super::source::{Layout, file, float, import_types, literal};
use super::stubs::pass_through;
use crate::emit::stub::docs::Docs;
use crate::emit::stub::process::{self, set_off};
use crate::emit::stub::source::{Source, join};
use crate::sample::{Profile, Samples};
use crate::surface::expr::{Expr, Expressions};
use crate::surface::language::{Role, TYPESCRIPT};
use crate::surface::package::{Call, Shape};
use fc_spec::model::{
    AcceptedIn, Cadence, Direction, Exchange, Operation, SetOff, StructRef, Type, TypeRef,
};

/// Members of an object.
type Members = Vec<(String, Layout)>;

/// The head of one of these files.
pub fn head(zh: &str, en: &str) -> Source {
    let mut out = file();
    let mut docs = Docs::default();
    docs.raw(zh);
    docs.raw(en);
    docs.raw("@module");
    out.docs(&docs);
    out.blank();
    out
}

/// Says that a file is a module, also where there is nothing to export.
pub fn nothing(mut out: Source) -> String {
    out.line("export {}");
    out.finish()
}

/// `commands.ts`.
pub fn commands(context: &Context<'_>, samples: &Samples<'_>) -> String {
    let mut out = head(
        "每条指令的说明数据。",
        "What there is to know of each command.",
    );
    let commands = context.commands();
    if commands.is_empty() {
        return nothing(out);
    }
    let follows = |call: &Call<'_>| process::is_followed(context, call.operation);
    let mut names = Vec::new();
    names.extend(commands.iter().any(|it| !follows(it)).then_some("Command"));
    names.extend(commands.iter().any(follows).then_some("FollowedCommand"));
    import_types(&mut out, &names, "../src/runtime.ts");
    out.line("import * as messages from './messages/index.ts'");
    if names.contains(&"FollowedCommand") {
        out.line("import * as reports from './reports.ts'");
    }
    out.line("import * as schemas from './schemas/index.ts'");
    for call in &commands {
        command(&mut out, context, samples, call);
    }
    out.finish()
}

fn command(out: &mut Source, context: &Context<'_>, samples: &Samples<'_>, call: &Call<'_>) {
    let operation = call.operation;
    let [request, response] = [call.request, call.response].map(|it| &it.ty.name);
    let followed = set_off(context, operation).next();
    let mut types = vec![
        format!("messages.{request}"),
        format!("messages.{response}"),
    ];
    types.extend(
        followed.map(|(_, _, report)| format!("messages.{}", context.name_of(&report.request.ty))),
    );
    types.extend(
        context
            .package
            .error_type(operation)
            .map(|name| format!("messages.{name}")),
    );
    let ty = if followed.is_some() {
        "FollowedCommand"
    } else {
        "Command"
    };

    let mut members = facts_of(operation, "command");
    let mut add = |key: &str, value| members.push((key.to_owned(), value));
    if let Some(effect) = operation.effect() {
        add("effect", Layout::text(effect.name()));
    }
    add("request", Layout::word(format!("schemas.{request}")));
    add("response", Layout::word(format!("schemas.{response}")));
    add(
        "requestExample",
        example(context, samples, operation, Direction::Request),
    );
    add(
        "responseExample",
        example(context, samples, operation, Direction::Response),
    );
    let errors = context.package.errors(operation).map(|(_, result)| {
        let code = Layout::Number(result.code.to_string());
        let text = Layout::text(&result.text.zh);
        (
            result.name.to_string(),
            Layout::Object(vec![("code".to_owned(), code), ("text".to_owned(), text)]),
        )
    });
    add("errors", Layout::Object(errors.collect()));
    if let Some(preconditions) = preconditions(context, operation) {
        add("preconditions", preconditions);
    }
    if let Some((set_off, report, messages)) = followed
        && let Some(report) = context.package.call(report)
    {
        let tied = ties(context, set_off, operation, &messages.request.ty);
        add(
            "setsOff",
            Layout::Object(vec![
                (
                    "report".to_owned(),
                    Layout::word(format!("reports.{}", report.method)),
                ),
                ("tied".to_owned(), Layout::List(tied)),
            ]),
        );
    }
    out.blank();
    out.docs(&operation_docs(context, operation));
    write(out, call.method, ty, &types, members);
}

/// `export const name: Type<A, B> = { … }`.
fn write(out: &mut Source, name: &str, ty: &str, types: &[String], members: Members) {
    let head = format!("export const {name}: {ty}<{}> = ", join(types));
    let value = Layout::Lines(members);
    if out.has_room([&head, "{"]) {
        return value.write(out, &head, "");
    }
    out.enclose(&format!("export const {name}: {ty}<"), "", |out| {
        let (last, others) = types.split_last().unwrap_or((&types[0], &[]));
        others.iter().for_each(|ty| out.line([ty, ","].concat()));
        out.line(last);
    });
    value.write(out, "> = ", "");
}

/// The comment on an operation.
fn operation_docs<'m>(context: &Context<'_>, operation: &'m Operation) -> Docs<'m> {
    let mut docs = Docs::of(&operation.title);
    docs.paragraph(context.links(&operation.location, &page_of(operation)));
    super::messages::deprecated(&mut docs, operation.deprecated.as_ref());
    docs
}

/// What every operation says of itself.
fn facts_of(operation: &Operation, is: &str) -> Members {
    let title = ["zh", "en"].map(str::to_owned);
    let title = title
        .into_iter()
        .zip([&operation.title.zh, &operation.title.en].map(|it| Layout::text(it)));
    let code = operation
        .code
        .value
        .map(|_| operation.code.spelling.to_lowercase());
    let mut members = vec![
        ("is", Layout::text(is)),
        ("name", Layout::text(&operation.name)),
        (
            "code",
            Layout::word(code.unwrap_or_else(|| "null".to_owned())),
        ),
        ("title", Layout::Object(title.collect())),
    ];
    members.extend(
        operation
            .since
            .as_ref()
            .map(|since| ("since", Layout::text(since))),
    );
    members.extend(
        operation
            .deprecated
            .as_ref()
            .map(|_| ("deprecated", Layout::word(true))),
    );
    members.push(("docs", Layout::text(&page_of(operation))));
    members.push(("spec", Layout::text(&operation.location.file)));
    members
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value))
        .collect()
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
    Layout::Around(
        "() => (",
        Box::new(constant(context, &Expr::Record(record), false)),
        ")",
    )
}

/// What has to hold before a command is accepted, if the spec says anything of that.
fn preconditions(context: &Context<'_>, operation: &Operation) -> Option<Layout> {
    let accepted = operation.accepted()?;
    let mut members = Vec::new();
    match &accepted.states {
        None => {}
        Some(AcceptedIn::Any) => members.push(("states".to_owned(), Layout::text("any"))),
        Some(AcceptedIn::States(sets)) => {
            let sets = sets.iter().map(|set| {
                let item = context.package.item(&set.ty);
                let ty = &item.ty.name;
                let values = match &item.shape {
                    Shape::Enum(_, known) => known.as_slice(),
                    _ => &[],
                };
                let values = values
                    .iter()
                    .filter(|value| set.values.contains(&value.wire));
                let values =
                    values.map(|value| Layout::word(format!("messages.{ty}.{}", value.name)));
                Layout::Object(vec![
                    ("of".to_owned(), Layout::word(format!("schemas.{ty}"))),
                    ("values".to_owned(), Layout::List(values.collect())),
                ])
            });
            members.push(("states".to_owned(), Layout::List(sets.collect())));
        }
    }
    members.push(("after".to_owned(), Layout::texts(&accepted.after)));
    Some(Layout::Object(members))
}

/// What ties a report to a call, as functions that take both values.
fn ties(
    context: &Context<'_>,
    set_off: &SetOff,
    command: &Operation,
    report: &StructRef,
) -> Vec<Layout> {
    let ties = set_off.tied.iter().filter_map(|tie| {
        let body = &command.messages()?.body(tie.side).ty;
        let parameters = match tie.side {
            Direction::Request => "(request)",
            Direction::Response => "(_request, response)",
        };
        let ours = [tie.side.name(), &path(context, body, &tie.command)].concat();
        let theirs = ["report", &path(context, report, &tie.report)].concat();
        Some(Layout::Object(vec![
            (
                "call".to_owned(),
                Layout::word(format!("{parameters} => {ours}")),
            ),
            (
                "report".to_owned(),
                Layout::word(format!("(report) => {theirs}")),
            ),
        ]))
    });
    ties.collect()
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

/// `reports.ts`.
pub fn reports(context: &Context<'_>, samples: &Samples<'_>) -> String {
    let mut out = head(
        "每种主动上报的说明数据。",
        "What there is to know of each report.",
    );
    let reports = context.reports();
    if reports.is_empty() {
        return nothing(out);
    }
    import_types(&mut out, &["Report"], "../src/runtime.ts");
    out.line("import * as messages from './messages/index.ts'");
    out.line("import * as schemas from './schemas/index.ts'");
    for call in &reports {
        report(&mut out, context, samples, call);
    }
    out.finish()
}

fn report(out: &mut Source, context: &Context<'_>, samples: &Samples<'_>, call: &Call<'_>) {
    let operation = call.operation;
    let body = &call.request.ty.name;
    let mut members = facts_of(operation, "report");
    members.insert(2, ("case".to_owned(), Layout::text(body)));
    let mut add = |key: &str, value| members.push((key.to_owned(), value));
    add("body", Layout::word(format!("schemas.{body}")));
    add(
        "example",
        example(context, samples, operation, Direction::Request),
    );
    if let Some(cadence) = operation.cadence() {
        add("cadence", self::cadence(cadence));
    }
    if let Exchange::Report {
        ack,
        state,
        failures,
        messages,
        ..
    } = &operation.exchange
    {
        let number = |key: &str, value: u32| (key.to_owned(), Layout::Number(value.to_string()));
        add(
            "ack",
            Layout::Object(vec![
                number("timeout", ack.timeout_ms),
                number("retries", ack.retries.into()),
            ]),
        );
        let state_of = |keys: &[String]| {
            let (ty, _) = context.model().enum_at(&messages.request.ty, keys)?;
            let of = format!(
                "(report) => report{}",
                path(context, &messages.request.ty, keys)
            );
            Some(Layout::Object(vec![
                (
                    "schema".to_owned(),
                    Layout::word(format!("schemas.{}", context.name_of(ty))),
                ),
                ("of".to_owned(), Layout::word(of)),
            ]))
        };
        if let Some(state) = state.as_deref().and_then(state_of) {
            add("state", state);
        }
        if !failures.is_empty() {
            add(
                "failures",
                Layout::List(failures.iter().filter_map(|keys| state_of(keys)).collect()),
            );
        }
    }
    out.blank();
    out.docs(&operation_docs(context, operation));
    let types = [format!("messages.{body}"), literal(body)];
    write(out, call.method, "Report", &types, members);
}

fn cadence(cadence: &Cadence) -> Layout {
    let (is, facts) = match cadence {
        Cadence::OnChange(field) => ("on_change", vec![("field", Layout::text(field))]),
        Cadence::Step(step) => {
            let by = Layout::Number(float(step.by.to_f64()));
            (
                "step",
                vec![("field", Layout::text(&step.field)), ("by", by)],
            )
        }
        Cadence::EveryMs(ms) => ("every", vec![("ms", Layout::Number(ms.to_string()))]),
        Cadence::WithinMs(ms) => ("within", vec![("ms", Layout::Number(ms.to_string()))]),
    };
    let members = [("is", Layout::text(is))].into_iter().chain(facts);
    Layout::Object(
        members
            .map(|(key, value)| (key.to_owned(), value))
            .collect(),
    )
}

/// `streams.ts`.
pub fn streams(context: &Context<'_>) -> String {
    let mut out = head(
        "每个数据流的说明数据。",
        "What there is to know of each stream.",
    );
    let streams = &context.package.streams;
    if streams.is_empty() {
        return nothing(out);
    }
    import_types(&mut out, &["Stream"], "../src/runtime.ts");
    if streams
        .iter()
        .any(|stream| stream.body(Direction::Request).is_some())
    {
        out.line("import type * as messages from './messages/index.ts'");
        out.line("import * as schemas from './schemas/index.ts'");
    }
    for stream in streams {
        let mut members = facts_of(stream, "stream");
        let mut add = |key: &str, value| members.push((key.to_owned(), value));
        add("from", Layout::text(stream.sender.name()));
        let (ty, content) = match stream.body(Direction::Request) {
            Some(body) => {
                let name = context.name_of(&body.ty);
                (format!("messages.{name}"), format!("schemas.{name}"))
            }
            None => ("Uint8Array".to_owned(), "null".to_owned()),
        };
        add("content", Layout::word(&content));
        if let Some(facts) = stream.stream() {
            let media = facts.content.media_type().filter(|_| content == "null");
            for (key, value) in [
                ("mediaType", media),
                ("startedBy", facts.started_by.as_deref()),
                ("stoppedBy", facts.stopped_by.as_deref()),
            ] {
                if let Some(value) = value {
                    add(key, Layout::text(value));
                }
            }
        }
        out.blank();
        out.docs(&operation_docs(context, stream));
        write(&mut out, &stream_name(stream), "Stream", &[ty], members);
    }
    out.finish()
}

/// What a stream's constant is called.
pub fn stream_name(stream: &Operation) -> String {
    let name = TYPESCRIPT.spelling(Role::Method, &stream.name);
    name.unwrap_or_else(|name| name).into_owned()
}

/// `operations.ts`.
pub fn protocol(context: &Context<'_>) -> String {
    let mut out = head(
        "协议：数值和全部操作。",
        "The protocol: its numbers and all of its operations.",
    );
    import_types(&mut out, &["ProtocolOf", "ServiceOf"], "../src/runtime.ts");
    let of = |word: &str, names: Vec<&str>| {
        Layout::List(
            names
                .into_iter()
                .map(|name| Layout::word(format!("{word}.{name}")))
                .collect(),
        )
    };
    let commands: Vec<&str> = context.commands().iter().map(|it| it.method).collect();
    let reports: Vec<&str> = context.reports().iter().map(|it| it.method).collect();
    let streams: Vec<String> = context
        .package
        .streams
        .iter()
        .map(|it| stream_name(it))
        .collect();
    let streams: Vec<&str> = streams.iter().map(String::as_str).collect();
    for (word, names) in [
        ("commands", &commands),
        ("reports", &reports),
        ("streams", &streams),
    ] {
        if !names.is_empty() {
            out.line(format!("import * as {word} from './{word}.ts'"));
        }
    }
    out.line("import { wire } from './wire.ts'");
    let protocol = &context.model().protocol;
    let mut docs = Docs::of(&protocol.title);
    docs.text(&protocol.about);
    docs.paragraph(format!("Version {} of the spec.", protocol.version));
    out.blank();
    out.docs(&docs);
    let methods = commands.iter();
    let methods =
        methods.map(|name| ((*name).to_owned(), Layout::word(format!("commands.{name}"))));
    let methods = Layout::Lines(methods.collect());
    Layout::Lines(vec![
        ("wire".to_owned(), Layout::word("wire")),
        ("commands".to_owned(), of("commands", commands.clone())),
        ("reports".to_owned(), of("reports", reports)),
        ("streams".to_owned(), of("streams", streams)),
    ])
    .write(
        &mut out,
        &format!("export const {}: ProtocolOf = ", context.package.name),
        "",
    );
    let ranges = pass_through(context).into_iter().map(|(method, range)| {
        let number =
            |key: &str, value: &str| (key.to_owned(), Layout::Number(value.to_lowercase()));
        Layout::Object(vec![
            number("first", &range.first_spelling),
            number("last", &range.last_spelling),
            ("method".to_owned(), Layout::text(&method)),
        ])
    });
    out.blank();
    out.line("/** 机器人的每个方法处理哪条指令。Which command each method of a robot handles. */");
    Layout::Lines(vec![
        ("methods".to_owned(), methods),
        ("ranges".to_owned(), Layout::List(ranges.collect())),
        ("unknown".to_owned(), Layout::text("unknown")),
    ])
    .write(&mut out, "export const service: ServiceOf = ", "");
    out.finish()
}
