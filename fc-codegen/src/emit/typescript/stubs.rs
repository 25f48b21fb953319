//! `client.ts` and `robot.ts`: the app's side and the robot's side.

use super::context::{Context, page_of};
use super::messages::deprecated;
use super::operations::{head, stream_name};
use super::source::{alternatives, file, import_types};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::emit::stub::process::{self, set_off};
use crate::emit::stub::source::Source;
use crate::surface::language::{Role, TYPESCRIPT};
use crate::surface::name::free;
use crate::surface::package::{Call, Spelled};
use fc_spec::model::{CodeRange, Direction, Effect, Operation, RangeUse, Side};

/// `client.ts`.
pub fn client(context: &Context<'_>) -> String {
    let commands = context.commands();
    let reports = context.reports();
    let streams = &context.package.streams;
    let mut out = head(
        "app 端：每条指令一个方法。",
        "The app's side: one method per command.",
    );
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
    out.line(format!(
        "import {{ {} }} from './operations.ts'",
        context.package.name
    ));
    if !streams.is_empty() {
        out.line("import * as streams from './streams.ts'");
    }
    any_report(&mut out, &reports);
    out.blank();
    client_class(&mut out, context, &commands);
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

fn client_class(out: &mut Source, context: &Context<'_>, commands: &[Call<'_>]) {
    let protocol = &context.package.name;
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
    let mut docs = facts::operation_docs(operation);
    facts::operation_end(context.style, &mut docs, operation);
    if let Some(error) = context.package.error_type(operation) {
        docs.raw(format!(
            "`CallError.declared` says which {{@link messages.{error}}} it was."
        ));
    }
    process::docs(&mut docs, context, operation);
    docs.paragraph(context.links(&operation.location, &page_of(operation)));
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
fn method_of(out: &mut Source, name: &str, parameters: &[String], result: &str, body: &str) {
    out.list(&format!("{name}("), parameters, &format!("): {result} {{"));
    out.line(format!("  {body}\n}}"));
}

/// What a stream's frame holds.
fn content(context: &Context<'_>, stream: &Operation) -> String {
    let body = stream.body(Direction::Request);
    body.map_or("Uint8Array".to_owned(), |body| {
        format!("messages.{}", context.name_of(&body.ty))
    })
}

fn stream_docs<'m>(context: &Context<'_>, stream: &'m Operation) -> Docs<'m> {
    let mut docs = facts::operation_docs(stream);
    facts::operation_end(context.style, &mut docs, stream);
    docs.paragraph(context.links(&stream.location, &page_of(stream)));
    deprecated(&mut docs, stream.deprecated.as_ref());
    docs
}

/// The members that keep what a class of this file stands on.
fn constructor(out: &mut Source, field: &str, ty: &str, about: &str) {
    out.line(format!(
        "private readonly {field}: {ty}\n\n{about}\nconstructor({field}: {ty}) {{\n  this.{field} = {field}\n}}"
    ));
}

fn app_streams(out: &mut Source, context: &Context<'_>) {
    out.blank();
    out.line("/** 数据端口上的数据流。The streams of the data port: those of the robot to be subscribed to, the app's own to be sent. */");
    out.block("export class Streams", |out| {
        let about = "/** 数据连接上的数据流，见 `client.data()`。Those of a data connection; see `client.data()`. */";
        constructor(out, "data", "DataConnection", about);
        for stream in &context.package.streams {
            let (name, constant) = (&stream.name, stream_name(stream));
            let content = content(context, stream);
            out.blank();
            out.docs(&stream_docs(context, stream));
            if stream.sender == Side::Robot {
                let body = format!("return this.data.subscribe(streams.{constant})");
                method_of(out, &format!("subscribe{name}"), &[], &format!("Subscription<{content}>"), &body);
            } else {
                let parameters = ["id: number".to_owned(), format!("content: {content}")];
                let body = format!("return this.data.sendStream(streams.{constant}, id, content)");
                method_of(out, &format!("send{name}"), &parameters, "Promise<void>", &body);
            }
        }
    });
}

/// Ranges of codes that are handed on as they come, each with the name of its method.
pub fn pass_through<'m>(context: &Context<'m>) -> Vec<(String, &'m CodeRange)> {
    let ranges = context.model().ranges.iter();
    let ranges = ranges.filter(|range| range.usage == RangeUse::PassThrough);
    let mut named: Vec<(String, &CodeRange)> = Vec::new();
    for range in ranges {
        let with_code = format!("pass_through_{:04x}", range.first);
        let words = free(&["pass_through", &with_code], |words| {
            let spelled = TYPESCRIPT.spelling(Role::Method, words);
            context.package.has_call(words)
                || named
                    .iter()
                    .any(|(taken, _)| spelled.as_deref() == Ok(taken))
        });
        let name = TYPESCRIPT
            .spelling(Role::Method, &words)
            .unwrap_or_else(|name| name);
        named.push((name.into_owned(), range));
    }
    named
}

/// `robot.ts`.
pub fn robot(context: &Context<'_>) -> String {
    let commands = context.commands();
    let reports = context.reports();
    let own: Vec<_> = context
        .package
        .streams
        .iter()
        .filter(|it| it.sender == Side::Robot)
        .collect();
    let mut out = head(
        "机器人端：每条指令一个方法，以及带类型的主动上报。",
        "The robot's side: one method per command, and typed reports.",
    );
    out.line("import { serveRobot } from '../src/runtime.ts'");
    let mut names = vec![
        "Answer",
        "Context",
        "RawRequest",
        "Server",
        "ServerConfig",
        "ServerPlatform",
    ];
    names.extend((!reports.is_empty()).then_some("Acknowledgement"));
    names.extend((!reports.is_empty() || !own.is_empty()).then_some("Audience"));
    import_types(&mut out, &names, "../src/runtime.ts");
    if !commands.is_empty() {
        out.line("import * as commands from './commands.ts'");
    }
    let json = own.iter().any(|it| it.body(Direction::Request).is_some());
    if !commands.is_empty() || !reports.is_empty() || json {
        out.line("import type * as messages from './messages/index.ts'");
    }
    let protocol = &context.package.name;
    out.line(format!(
        "import {{ {protocol}, service }} from './operations.ts'"
    ));
    if !reports.is_empty() {
        out.line("import * as reports from './reports.ts'");
    }
    if !own.is_empty() {
        out.line("import * as streams from './streams.ts'");
    }
    out.blank();
    robot_interface(&mut out, context, &commands);
    out.blank();
    out.line(format!(
        "\
/**
 * 只有一部分指令的机器人：没有写的指令以“未实现”拒绝。
 * A robot that has some of the commands so far: what is left out is refused as not implemented.
 */
export type PartialRobot = Partial<Robot>

/**
 * 为 app 提供服务；`config` 中没有设置的项使用规范的默认值。
 * Serves apps; what `config` does not set has the default of the spec.
 */
export function serve(platform: ServerPlatform, robot: PartialRobot, config: ServerConfig = {{}}): Promise<Server> {{
  return serveRobot({protocol}, service, platform, robot, config)
}}"
    ));
    example(&mut out, &commands);
    reporter(&mut out, context, &reports);
    if !own.is_empty() {
        streamer(&mut out, context, &own);
    }
    out.finish()
}

fn robot_interface(out: &mut Source, context: &Context<'_>, commands: &[Call<'_>]) {
    out.line(
        "\
/**
 * 完整的机器人：处理规范中的全部指令。规范新增一条指令，这里就缺少一个方法，编译器会指出。
 * A complete robot: it handles all commands of the spec. When the spec gains one, a method is missing here, and the
 * compiler says so.
 *
 * 做不到的事，抛出 `Refusal` 拒绝。处理超时或连接断开后，`context.signal` 会中止：不再有人等待应答。
 *
 * What it cannot do, it refuses by throwing a `Refusal`. `context.signal` is aborted when nobody waits for the answer any
 * more: the handler took too long, or the connection broke.
 */",
    );
    out.block("export interface Robot", |out| {
        for command in commands {
            let mut docs = facts::operation_docs(command.operation);
            facts::operation_end(context.style, &mut docs, command.operation);
            if context.package.error_type(command.operation).is_some() {
                docs.raw(format!(
                    "`Refusal.declared(commands.{}, …)` makes one of its errors.",
                    command.method
                ));
            }
            docs.paragraph(context.links(&command.operation.location, &page_of(command.operation)));
            deprecated(&mut docs, command.operation.deprecated.as_ref());
            out.blank();
            out.docs(&docs);
            let [request, response] = [command.request, command.response].map(|it| &it.ty.name);
            let parameters = [
                format!("request: messages.{request}"),
                "context: Context".to_owned(),
            ];
            out.list(
                &format!("{}(", command.method),
                &parameters,
                &format!("): Answer<messages.{response}>"),
            );
        }
        for (name, range) in pass_through(context) {
            let mut docs = Docs::of(&range.text);
            let (first, last) = (&range.first_spelling, &range.last_spelling);
            docs.paragraph(format!(
                "Codes {first} to {last} that have no method of their own."
            ));
            raw(out, docs, &name);
        }
        let mut docs = Docs::default();
        docs.paragraph("功能码不在规范中的指令。");
        docs.paragraph("Commands whose code is not in the spec.");
        raw(out, docs, "unknown");
    });
}

/// A method for requests without a type: a range that the spec gains breaks no robot.
fn raw(out: &mut Source, mut docs: Docs<'_>, name: &str) {
    docs.paragraph("报文是 JSON 文本。不实现此方法时，按未知指令拒绝。");
    docs.paragraph(
        "Messages are JSON texts. Refused as an unknown command unless the robot has this method.",
    );
    out.blank();
    out.docs(&docs);
    out.line(format!(
        "{name}?(request: RawRequest, context: Context): Answer<string>"
    ));
}

/// Whether a command sets something in motion, as far as anybody knows.
fn may_move(command: &Call<'_>) -> bool {
    !matches!(
        command.operation.effect(),
        Some(Effect::Read | Effect::Config)
    )
}

fn example(out: &mut Source, commands: &[Call<'_>]) {
    out.blank();
    out.line(
        "\
/**
 * 用规范中的示例回答指令，只用于演示和测试；自己的机器人从 `implements PartialRobot` 开始。
 * Answers with the spec's examples, for demos and tests alone; a robot of your own starts with `implements PartialRobot`.
 *
 * 会引起动作的指令，以及作用不详的指令，它并不执行，因此以“未实现”拒绝，除非要求它假装。
 *
 * It does not carry out what sets something in motion, or may do so: such commands are refused as not implemented, unless
 * it is told to pretend.
 */",
    );
    out.block("export class ExampleRobot implements Robot", |out| {
        out.line(
            "\
/**
 * 对会引起动作的指令也回答成功，尽管什么都不会动；只用于没有真机的地方。
 * Whether to answer what sets something in motion with success as well, though nothing moves; only where there is no
 * real robot.
 */
readonly pretendMotion: boolean

/** 默认不假装。It does not pretend unless told to. */
constructor({ pretendMotion = false }: { pretendMotion?: boolean } = {}) {
  this.pretendMotion = pretendMotion
}",
        );
        for command in commands {
            let [request, response] = [command.request, command.response].map(|it| &it.ty.name);
            let mut docs = Docs::default();
            docs.raw(format!("{{@inheritDoc Robot.{}}}", command.method));
            out.blank();
            out.docs(&docs);
            let parameters = [format!("_request: messages.{request}"), "context: Context".to_owned()];
            let parameters: &[String] = if may_move(command) { &parameters } else { &[] };
            out.list(&format!("{}(", command.method), parameters, &format!("): messages.{response} {{"));
            if may_move(command) {
                out.line("  if (!this.pretendMotion) throw context.notImplemented()");
            }
            out.line(format!("  return commands.{}.responseExample()\n}}", command.method));
        }
    });
}

fn reporter(out: &mut Source, context: &Context<'_>, reports: &[Call<'_>]) {
    if reports.is_empty() {
        return;
    }
    out.blank();
    out.line("/** 主动上报：每种上报一个方法。Pushes reports: one method per report. */");
    out.block("export class Reporter", |out| {
        constructor(
            out,
            "server",
            "Server",
            "/** 向一个服务端的各个 app 上报。Reports to the apps of a server. */",
        );
        for report in reports {
            let mut docs = facts::operation_docs(report.operation);
            facts::operation_end(context.style, &mut docs, report.operation);
            docs.paragraph("Resolves to what became of it at each app.");
            docs.paragraph(context.links(&report.operation.location, &page_of(report.operation)));
            deprecated(&mut docs, report.operation.deprecated.as_ref());
            out.blank();
            out.docs(&docs);
            let parameters = [
                format!("report: messages.{}", report.request.ty.name),
                "audience: Audience = 'all'".to_owned(),
            ];
            let body = format!(
                "return this.server.push(audience, reports.{}, report)",
                report.method
            );
            method_of(
                out,
                report.method,
                &parameters,
                "Promise<Acknowledgement[]>",
                &body,
            );
        }
    });
}

fn streamer(out: &mut Source, context: &Context<'_>, streams: &[&Spelled<'_, Operation>]) {
    out.blank();
    out.line("/** 机器人发送的数据流：每个数据流一个方法。Sends the robot's streams: one method per stream. */");
    out.block("export class Streamer", |out| {
        let about =
            "/** 向一个服务端的各个数据连接发送。Sends to the data connections of a server. */";
        constructor(out, "server", "Server", about);
        for stream in streams {
            let mut docs = stream_docs(context, stream);
            docs.paragraph("Resolves to the number of data connections that took it.");
            out.blank();
            out.docs(&docs);
            let parameters = [
                "id: number".to_owned(),
                format!("content: {}", content(context, stream)),
                "audience: Audience = 'all'".to_owned(),
            ];
            let body = format!(
                "return this.server.sendStream(audience, streams.{}, id, content)",
                stream_name(stream)
            );
            method_of(
                out,
                &format!("send{}", stream.name),
                &parameters,
                "Promise<number>",
                &body,
            );
        }
    });
}

/// What an app needs of the runtime, beside what is generated.
const RUNTIME: &[&str] = &[
    "BodyError",
    "CallError",
    "ConnectError",
    "DataError",
    "FollowError",
    "Refusal",
    "acceptedIn",
];

/// Types that it needs.
const RUNTIME_TYPES: &[&str] = &[
    "Acknowledgement",
    "Answer",
    "Audience",
    "CallErrorKind",
    "CallOptions",
    "ClientConfig",
    "ConnectionId",
    "ConnectionState",
    "Context",
    "DataConnection",
    "Effect",
    "Extra",
    "ExtraKey",
    "FollowableCall",
    "Followed",
    "Following",
    "JsonText",
    "Loss",
    "MessageOf",
    "Platform",
    "RawRequest",
    "Reports",
    "Server",
    "ServerConfig",
    "ServerPlatform",
    "StreamItem",
    "Subscription",
    "UnknownReport",
];

/// `index.ts`: the package as a program imports it.
pub fn root(context: &Context<'_>) -> String {
    let mut out = file();
    let protocol = &context.model().protocol;
    let mut docs = Docs::of(&protocol.title);
    docs.text(&protocol.about);
    docs.paragraph(format!(
        "规范版本 {}。Version {} of the spec.",
        protocol.version, protocol.version
    ));
    docs.raw("An app starts at {@link Client}, a robot at {@link PartialRobot} or {@link Robot}, and at {@link serve}.");
    docs.raw("@module");
    out.docs(&docs);
    out.blank();
    // A type of the spec keeps its name here.
    let free = |names: &[&'static str]| -> Vec<&'static str> {
        let names = names.iter().filter(|name| !context.package.has_type(name));
        names.copied().collect()
    };
    let package = &context.package;
    let has_streams = !package.streams.is_empty();
    super::source::named(&mut out, "export", &free(RUNTIME), "../src/runtime.ts");
    super::source::named(
        &mut out,
        "export type",
        &free(RUNTIME_TYPES),
        "../src/runtime.ts",
    );
    let mut client = vec!["Client"];
    client.extend(has_streams.then_some("Streams"));
    super::source::named(&mut out, "export", &client, "./client.ts");
    out.line("export type { AnyReport } from './client.ts'");
    out.line("export * as commands from './commands.ts'");
    if !package.modules.is_empty() {
        out.line("export * from './messages/index.ts'");
    }
    out.line(format!(
        "export {{ {} }} from './operations.ts'",
        package.name
    ));
    out.line("export * as reports from './reports.ts'");
    let mut robot = vec!["ExampleRobot", "serve"];
    robot.extend((!context.reports().is_empty()).then_some("Reporter"));
    robot.extend(
        package
            .streams
            .iter()
            .any(|it| it.sender == Side::Robot)
            .then_some("Streamer"),
    );
    super::source::named(&mut out, "export", &robot, "./robot.ts");
    out.line("export type { PartialRobot, Robot } from './robot.ts'");
    if !package.modules.is_empty() {
        out.line("export * as schemas from './schemas/index.ts'");
    }
    out.line("export * as streams from './streams.ts'");
    out.line("export * as tables from './tables.ts'");
    super::source::named(&mut out, "export", &["ResultCode"], "./wire.ts");
    super::source::named(
        &mut out,
        "export type",
        &["RequestEnvelope", "ResponseEnvelope"],
        "./wire.ts",
    );
    out.finish()
}
