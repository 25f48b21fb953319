//! `client.ts`: the app's side.

use super::context::{Context, page_of};
use super::messages::deprecated;
use super::operations::{carried, stream_name};
use super::protocol;
use super::source::{alternatives, head, import_types};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::emit::stub::process::{self, set_off};
use crate::emit::stub::source::Source;
use crate::surface::package::{Call, Spelled};
use fc_spec::model::{Direction, Operation, Side};

/// The file.
pub fn file(context: &Context<'_>) -> String {
    let commands = context.commands();
    let reports = context.reports();
    let streams = &context.package.streams;
    let mut out = head([
        "app 端：每条指令一个方法。",
        "The app's side: one method per command.",
    ]);
    out.line("import { Connection, dial, dialLater } from '../src/runtime.ts'");
    let mut names = vec!["ClientConfig", "Platform", "UnknownReport"];
    let follows = |call: &Call<'_>| process::is_followed(context, call.operation);
    names.extend((!commands.is_empty()).then_some("CallOptions"));
    names.extend((!reports.is_empty()).then_some("Reported"));
    names.extend(commands.iter().any(follows).then_some("FollowableCall"));
    names.extend((!streams.is_empty()).then_some("DataConnection"));
    let from_robot = |it: &Spelled<'_, Operation>| it.sender == Side::Robot;
    names.extend(streams.iter().any(from_robot).then_some("Subscription"));
    import_types(&mut out, &names, "../src/runtime.ts");
    if !commands.is_empty() {
        out.line("import * as commands from './commands.ts'");
    }
    let json = streams
        .iter()
        .any(|it| it.body(Direction::Request).is_some());
    if !commands.is_empty() || !reports.is_empty() || json {
        out.line("import type * as messages from './messages/index.ts'");
    }
    let (protocol, import) = protocol::imported(context);
    out.line(format!("import {{ {import} }} from './operations.ts'"));
    if !streams.is_empty() {
        out.line("import * as streams from './streams.ts'");
    }
    any_report(&mut out, &reports);
    out.blank();
    client_class(&mut out, context, &protocol, &commands);
    if !streams.is_empty() {
        app_streams(&mut out, context);
    }
    out.finish()
}

fn any_report(out: &mut Source, reports: &[Call<'_>]) {
    out.blank();
    out.line("/** 任意一个主动上报，`case` 说明是哪一种。Any report: `case` tells which. */");
    let known = reports.iter().map(|report| {
        let name = &report.request.ty.name;
        let docs = Docs::of(&report.operation.title);
        (docs, format!("Reported<'{name}', messages.{name}>"))
    });
    let mut other = Docs::default();
    other.raw("编码不在规范中的上报。One whose code the spec does not know.");
    let all = known.chain([(other, "UnknownReport".to_owned())]);
    alternatives(out, "AnyReport", &all.collect::<Vec<_>>());
}

fn client_class(out: &mut Source, context: &Context<'_>, protocol: &str, commands: &[Call<'_>]) {
    out.line("/** 一个机器人，从 app 一侧看：每条指令一个方法。A robot as seen from the app: one method per command. */");
    out.block("export class Client extends Connection<AnyReport>", |out| {
        out.line(format!(
            "\
/**
 * 连接机器人；`config` 中没有设置的项使用规范的默认值。
 * Connects to a robot; what `config` does not set has the default of the spec.
 */
static async connect(platform: Platform, config: ClientConfig = {{}}): Promise<Client> {{
  return new Client(await dial({protocol}, platform, config))
}}

/**
 * 立即返回，在后台连接机器人；其间发起的调用在各自的时限内等待连接。
 * Returns at once and connects in the background; calls made meanwhile wait for the connection within their timeout.
 */
static connectLazy(platform: Platform, config: ClientConfig = {{}}): Client {{
  return new Client(dialLater({protocol}, platform, config))
}}"
        ));
        for command in commands {
            out.blank();
            call(out, context, command);
        }
    });
}

fn call(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let operation = command.operation;
    let mut docs = facts::call_docs(context, operation, |error| {
        format!("`CallError.declared` says which {{@link messages.{error}}} it was.")
    });
    deprecated(&mut docs, operation.deprecated.as_ref());
    out.docs(&docs);
    let [request, response] = [command.request, command.response].map(|it| &it.ty.name);
    let is_optional = command.request.fields().iter().all(|field| field.optional);
    let unless_given = if is_optional { " = {}" } else { "" };
    let answer = match set_off(context, operation).next() {
        Some((_, _, report)) => {
            let report = context.name_of(&report.request.ty);
            format!("FollowableCall<messages.{response}, messages.{report}>")
        }
        None => format!("Promise<messages.{response}>"),
    };
    let parameters = [
        format!("request: messages.{request}{unless_given}"),
        "options?: CallOptions".to_owned(),
    ];
    let method = command.method;
    method_of(
        out,
        method,
        &parameters,
        &answer,
        &format!("return this.call(commands.{method}, request, options)"),
    );
}

/// A method with a body of one line.
pub fn method_of(out: &mut Source, name: &str, parameters: &[String], result: &str, body: &str) {
    out.list(&format!("{name}("), parameters, &format!("): {result} {{"));
    out.line(format!("  {body}\n}}"));
}

/// The comment on the method of a stream.
pub fn stream_docs<'m>(context: &Context<'_>, stream: &'m Operation) -> Docs<'m> {
    let mut docs = facts::operation_docs(stream);
    facts::operation_end(context.style, &mut docs, stream);
    docs.paragraph(context.links(&stream.location, &page_of(stream)));
    deprecated(&mut docs, stream.deprecated.as_ref());
    docs
}

/// The members that keep what a class of this file stands on.
pub fn constructor(out: &mut Source, field: &str, ty: &str, about: &str) {
    out.line(format!(
        "private readonly {field}: {ty}\n\n{about}\nconstructor({field}: {ty}) {{\n  this.{field} = {field}\n}}"
    ));
}

fn app_streams(out: &mut Source, context: &Context<'_>) {
    out.blank();
    out.line(
        "\
/**
 * 数据端口上的数据流：机器人发来的可以逐个订阅，app 自己的可以发送。
 * The streams of the data port: each that the robot sends can be subscribed to, each of the app's own can be sent.
 */",
    );
    out.block("export class Streams", |out| {
        let about = "/** 数据连接上的数据流，见 `client.data()`。Those of a data connection; see `client.data()`. */";
        constructor(out, "data", "DataConnection", about);
        for stream in &context.package.streams {
            let (name, constant) = (&stream.name, stream_name(stream));
            let held = carried(context, stream);
            out.blank();
            out.docs(&stream_docs(context, stream));
            if stream.sender == Side::Robot {
                let body = format!("return this.data.subscribe(streams.{constant})");
                method_of(out, &format!("subscribe{name}"), &[], &format!("Subscription<{held}>"), &body);
            } else {
                let parameters = ["id: number".to_owned(), format!("content: {held}")];
                let body = format!("return this.data.sendStream(streams.{constant}, id, content)");
                method_of(out, &format!("send{name}"), &parameters, "Promise<void>", &body);
            }
        }
    });
}
