//! `client.py` and `sync.py`: the app's stub, with and without `async`.

use super::literal::literal;
use super::operations::{message, qualified};
use super::protocol;
use super::source::{Code, PYTHON, Python, method};
use crate::emit::stub::context::{Context, page_of};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::emit::stub::process;
use crate::emit::stub::source::Source;
use crate::surface::name::free;
use crate::surface::package::Call;
use fc_spec::model::{Direction, Operation, Side};

/// The head of a file with a stub: what it is, and what it imports.
pub fn head(
    out: &mut Source,
    about: [&'static str; 2],
    standard: &[(&str, &[&str])],
    own: &[&str],
) {
    out.docstring(&Docs::said(&about));
    out.blank();
    out.line("from __future__ import annotations");
    out.blank();
    for (module, names) in standard {
        out.import_from(module, names);
    }
    out.blank();
    out.line("import fc_runtime as rt");
    out.blank();
    out.import_from(".", own);
}

/// The modules of the package that a stub names, if it needs them.
pub fn own(messages: bool, operations: bool) -> Vec<&'static str> {
    let messages = messages.then_some("messages");
    messages
        .into_iter()
        .chain(operations.then_some("operations"))
        .collect()
}

/// The options of a call.
const OPTIONS: [&str; 2] = ["timeout", "repeat"];

/// What the protocol of a stub is.
pub fn speaks(out: &mut Source, context: &Context<'_>) {
    out.blank();
    out.line(format!(
        "protocol: ClassVar[rt.Protocol] = {}",
        protocol::name(context)
    ));
}

/// `client.py`.
pub fn file(context: &Context<'_>) -> String {
    let commands = context.commands();
    let reports = context.reports();
    let streams: Vec<&Operation> = context.package.streams.iter().map(|it| it.of).collect();
    let of_robot = |it: &&&Operation| it.sender == Side::Robot;
    let json = streams
        .iter()
        .any(|it| it.body(Direction::Request).is_some());
    let mut out = Source::new(&PYTHON);
    head(
        &mut out,
        [
            "app 端：每条指令一个方法，全部主动上报汇成一个类型。",
            "The app's side: one method per command, one type for any report.",
        ],
        &[("typing", &["ClassVar", "TypeAlias"])],
        &own(
            !commands.is_empty() || !reports.is_empty() || json,
            !commands.is_empty() || !streams.is_empty(),
        ),
    );
    out.import_from(".protocol", &[&protocol::name(context)]);
    out.blank();
    any_report(&mut out, &reports);
    out.gap();
    out.suite("class Client(rt.Client[AnyReport])", |out| {
        out.docstring(&Docs::said(&[
            "一个机器人，从 app 一侧看：每条指令一个方法。",
            "A robot as seen from the app: one method per command.",
        ]));
        speaks(out, context);
        for command in &commands {
            out.blank();
            call(out, context, command);
        }
    });
    if !streams.is_empty() {
        out.gap();
        out.suite("class Streams(rt.Streams)", |out| {
            out.docstring(&Docs::said(&["数据端口上的数据流：机器人发来的可以逐个订阅，app 自己的可以发送。", "The streams of the data port: each that the robot sends can be subscribed to, each of the app's own can be sent."]));
            for stream in streams.iter().filter(of_robot) {
                out.blank();
                subscribe(out, context, stream);
            }
            for stream in streams.iter().filter(|it| !of_robot(it)) {
                out.blank();
                let name = &stream.name;
                let parameters = ["self".to_owned(), "message_id: int".to_owned(), content(context, stream)];
                let parameters = parameters.map(Code::Text).to_vec();
                method(out, &format!("async def send_{name}("), parameters, "None", |out| {
                    out.docstring(&stream_docs(context, stream));
                    let arguments = vec![qualified(stream).into(), "message_id".into(), "content".into()];
                    Code::call("self.data.send_stream", arguments).write(out, "await ", "");
                });
            }
        });
    }
    out.finish()
}

fn any_report(out: &mut Source, reports: &[Call<'_>]) {
    let reports = reports
        .iter()
        .map(|it| format!("messages.{}", it.request.ty.name));
    let union = Code::Union(reports.chain(["rt.RawReport".to_owned()]).collect());
    union.write_in_parentheses(out, "AnyReport: TypeAlias = ");
    out.docstring(&Docs::said(&[
        "任意一个主动上报；编码不在规范中的为 `RawReport`，原样保留。",
        "Any report; a `RawReport`, kept unchanged, where the spec does not know the code.",
    ]));
}

/// `self`, the request and the options of a call.
fn parameters(command: &Call<'_>) -> Vec<Code> {
    let request = &command.request.ty.name;
    let is_empty = command.request.fields().iter().all(|field| field.optional);
    let request = if is_empty {
        format!("request: messages.{request} | None = None")
    } else {
        format!("request: messages.{request}")
    };
    [
        "self",
        &request,
        "*",
        "timeout: float | None = None",
        "repeat: bool | None = None",
    ]
    .map(Code::from)
    .to_vec()
}

fn deprecated(out: &mut Source, command: &Call<'_>) {
    if let Some(deprecation) = &command.operation.deprecated {
        let note = literal(&facts::withdrawn_note(deprecation));
        Code::call("rt.deprecated", vec![note.into()]).write(out, "@", "");
    }
}

/// The reports that a command sets off, and their type.
fn followed<'c>(context: &'c Context<'_>, command: &'c Operation) -> (Vec<&'c Operation>, String) {
    let reports = process::set_off(context, command);
    let (reports, types): (Vec<_>, Vec<_>) = reports
        .map(|(_, report, messages)| (report, message(context, &messages.request.ty)))
        .unzip();
    (reports, types.join(" | "))
}

/// What says which of its errors a command was refused with.
fn declared(error: &str) -> String {
    format!("`CallError.declared(messages.{error})` says which of its errors it was.")
}

fn call(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let operation = command.operation;
    let docs = facts::call_docs(context, operation, declared);
    deprecated(out, command);
    let response = format!("messages.{}", command.response.ty.name);
    let (reports, types) = followed(context, operation);
    let mut arguments = vec![Code::Text(qualified(operation))];
    arguments.extend(reports.iter().map(|report| Code::Text(qualified(report))));
    let options = OPTIONS.map(|name| Code::named(name, name));
    let (word, returns, function) = if reports.is_empty() {
        arguments.push("request".into());
        ("async def", response, "await self.connection.call")
    } else {
        arguments.push(Code::named("request", "request"));
        let followable = format!("rt.Followable[{response}, {types}]");
        ("def", followable, "self._followable")
    };
    arguments.extend(options);
    let open = format!("{word} {}(", command.method);
    method(out, &open, parameters(command), &returns, |out| {
        out.docstring(&docs);
        Code::call(function, arguments).write(out, "return ", "");
    });
}

/// A stream's docs.
pub fn stream_docs<'c>(context: &Context<'_>, stream: &'c Operation) -> Docs<'c> {
    let mut docs = facts::operation_docs(stream);
    facts::operation_end(context.style, &mut docs, stream);
    docs.paragraph(context.links(&stream.location, &page_of(stream)));
    docs
}

/// What a frame of a stream holds.
fn held(context: &Context<'_>, stream: &Operation) -> String {
    let body = stream.body(Direction::Request);
    body.map_or_else(|| "bytes".to_owned(), |body| message(context, &body.ty))
}

/// The parameter with what is sent.
pub fn content(context: &Context<'_>, stream: &Operation) -> String {
    format!("content: {}", held(context, stream))
}

fn subscribe(out: &mut Source, context: &Context<'_>, stream: &Operation) {
    let returns = format!("rt.Subscription[{}]", held(context, stream));
    let open = format!("def subscribe_{}(", stream.name);
    method(out, &open, vec!["self".into()], &returns, |out| {
        out.docstring(&stream_docs(context, stream));
        let arguments = vec![qualified(stream).into()];
        Code::call("self.data.subscribe", arguments).write(out, "return ", "");
    });
}

/// What a method says that calls a command and follows one of its reports, whose type is `followed`.
fn follow_docs<'c>(
    context: &Context<'_>,
    command: &'c Operation,
    report: &Operation,
    followed: &str,
) -> Docs<'c> {
    let mut docs = Docs::of(&command.title);
    docs.raw(format!(
        "先取得响应，再逐个取得它引起的 `{followed}`。\n\
         Gives the response, and then each `{followed}` that it sets off.",
    ));
    let mut all = process::set_off(context, command);
    if let Some((set_off, _, messages)) = all.find(|(_, it, _)| it.name == report.name) {
        process::ending(&mut docs, context, set_off, report, messages);
    }
    docs.paragraph(context.links(&command.location, &page_of(command)));
    docs
}

/// `sync.py`.
pub fn sync(context: &Context<'_>) -> String {
    let commands = context.commands();
    let mut out = Source::new(&PYTHON);
    head(
        &mut out,
        [
            "不用 `async` 的 app 端。",
            "The app's side without `async`.",
        ],
        &[("typing", &["ClassVar"])],
        &own(!commands.is_empty(), !commands.is_empty()),
    );
    out.import_from(".client", &["AnyReport"]);
    out.import_from(".protocol", &[&protocol::name(context)]);
    out.gap();
    out.suite("class Client(rt.SyncClient[AnyReport])", |out| {
        out.docstring(&Docs::said(&[
            "一个机器人，从 app 一侧看：每条指令一个方法，等到有响应才返回。",
            "A robot as seen from the app: one method per command, which waits for the response.",
        ]));
        speaks(out, context);
        for command in &commands {
            let method_name = command.method;
            let response = format!("messages.{}", command.response.ty.name);
            let options = ["request"].into_iter().chain(OPTIONS).map(Code::from);
            let told = |of: &[&Operation]| {
                let of = of.iter().map(|it| Code::Text(qualified(it)));
                of.chain(options.clone()).collect::<Vec<Code>>()
            };
            out.blank();
            deprecated(out, command);
            let open = format!("def {method_name}(");
            method(out, &open, parameters(command), &response, |out| {
                let operation = command.operation;
                let mut docs = facts::answered_docs(context, operation, declared);
                docs.paragraph(context.links(&operation.location, &page_of(operation)));
                out.docstring(&docs);
                Code::call("self._call", told(&[command.operation])).write(out, "return ", "");
            });
            let (reports, _) = followed(context, command.operation);
            for report in &reports {
                let short = format!("follow_{method_name}");
                let long = format!("{short}_{}", report.name);
                let wishes: &[&str] = if reports.len() > 1 {
                    &[&long]
                } else {
                    &[&short, &long]
                };
                let name = free(wishes, |name| context.package.has_call(name));
                let Some(messages) = report.messages() else {
                    continue;
                };
                let followed = message(context, &messages.request.ty);
                let returns = format!("rt.SyncFollowing[{response}, {followed}]");
                out.blank();
                deprecated(out, command);
                method(
                    out,
                    &format!("def {name}("),
                    parameters(command),
                    &returns,
                    |out| {
                        out.docstring(&follow_docs(context, command.operation, report, &followed));
                        let arguments = told(&[command.operation, report]);
                        Code::call("self._follow", arguments).write(out, "return ", "");
                    },
                );
            }
        }
    });
    out.finish()
}
