//! `robot.ts`: the robot's side.

use super::client::{constructor, method_of, stream_docs};
use super::context::{Context, page_of};
use super::messages::deprecated;
use super::operations::{carried, stream_name};
use super::protocol::{imported, ranges};
use super::source::{head, import_types};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::emit::stub::ranges::UNKNOWN;
use crate::emit::stub::source::Source;
use crate::surface::package::{Call, Spelled};
use fc_spec::model::{Direction, Effect, Operation, Side};

/// The file.
pub fn file(context: &Context<'_>) -> String {
    let commands = context.commands();
    let reports = context.reports();
    let own: Vec<_> = context
        .package
        .streams
        .iter()
        .filter(|it| it.sender == Side::Robot)
        .collect();
    let mut out = head([
        "机器人端：每条指令一个方法，以及带类型的主动上报。",
        "The robot's side: one method per command, and typed reports.",
    ]);
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
    let (protocol, import) = imported(context);
    out.line(format!(
        "import {{ {import}, service }} from './operations.ts'"
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
        for (name, range) in ranges(context) {
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
        raw(out, docs, UNKNOWN);
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
    if commands.is_empty() {
        return;
    }
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
constructor({ pretendMotion = false }: Partial<Pick<ExampleRobot, 'pretendMotion'>> = {}) {
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
                format!("content: {}", carried(context, stream)),
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
