//! `robot.ts`: the robot's side, whose methods the groups declare.

use super::client::{constructor, method, stream_docs};
use super::context::{Context, own};
use super::group::{Group, What, extending, merged, parts};
use super::messages::end;
use super::operations::carried;
use super::protocol::{imported, ranges};
use super::source::{head, named};
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::items::Call;
use crate::package::ranges::UNKNOWN;
use crate::package::source::Source;
use fc_spec::model::{Effect, Side};

/// The word of a group's part of `PartialRobot`.
const PARTIAL: &str = "partial_robot";

pub fn file(context: &Context<'_>, groups: &[Group<'_, '_>]) -> String {
    let has_commands = groups.iter().any(|it| it.has(What::Commands));
    let has_reports = groups.iter().any(|it| it.has(What::Reports));
    let has_streams = groups.iter().any(|it| it.has(What::RobotStreams));
    let mut out = head(
        context,
        [
            "机器人端：每条指令一个方法，以及上报的发送端。",
            "The robot's side: one method per command, and the sender of reports.",
        ],
    );
    let mut names = vec!["serveRobot"];
    names.extend(has_commands.then_some("addExamples"));
    names.extend(has_reports.then_some("addReports"));
    names.extend(has_streams.then_some("addRobotStreams"));
    named(&mut out, "import", names, "../src/runtime.ts");
    let names = [
        "Answer",
        "Context",
        "RawRequest",
        "Server",
        "ServerConfig",
        "ServerPlatform",
    ];
    named(&mut out, "import type", names, "../src/runtime.ts");
    if has_commands || has_reports || has_streams {
        out.line("import type * as messages from './messages.ts'");
    }
    let (protocol, name) = imported(context);
    let mut names = vec![name, "service".to_owned()];
    names.extend(has_reports.then(|| "reports".to_owned()));
    names.extend(has_streams.then(|| "streams".to_owned()));
    named(&mut out, "import", names, "./operations.ts");
    out.blank();
    robot(
        &mut out,
        context,
        parts(context, groups, Side::Robot.name(), What::Commands),
    );
    partial_robot(
        &mut out,
        context,
        &parts(context, groups, PARTIAL, What::Commands),
    );
    out.documented(&Docs::said([
        "为 app 提供服务；`config` 中没有设置的项使用规范的默认值。",
        "Serves apps. Settings missing from `config` have the defaults of the spec.",
    ]));
    out.line(format!(
        "\
export function serve(platform: ServerPlatform, robot: PartialRobot, config: ServerConfig = {{}}): Promise<Server> {{
  return serveRobot({protocol}, service, platform, robot, config)
}}"
    ));
    if has_commands {
        example(
            &mut out,
            &parts(context, groups, "examples", What::Commands),
        );
    }
    if has_reports {
        let about = [
            "发送上报：每种上报一个方法。",
            "Pushes reports: one method per report.",
        ];
        let parts = parts(context, groups, "reporter", What::Reports);
        let constructor = [
            "向一个服务端的各个 app 上报。",
            "Reports to the apps of a server.",
        ];
        pushing(
            &mut out,
            "Reporter",
            &parts,
            about,
            "addReports(Reporter, reports)",
            constructor,
        );
    }
    if has_streams {
        let about = [
            "机器人发送的数据流：每个数据流一个方法。",
            "Sends the streams of the robot: one method per stream.",
        ];
        let parts = parts(context, groups, "streamer", What::RobotStreams);
        let constructor = [
            "向一个服务端的各个数据连接发送。",
            "Sends to the data connections of a server.",
        ];
        pushing(
            &mut out,
            "Streamer",
            &parts,
            about,
            "addRobotStreams(Streamer, streams)",
            constructor,
        );
    }
    out.finish()
}

fn robot(out: &mut Source, context: &Context<'_>, mut parts: Vec<String>) {
    let mut docs = Docs::two_lines([
        "完整的机器人：处理规范中的全部指令。规范新增一条指令，这里就缺少一个方法，编译器会指出。",
        "A complete robot, which handles all commands of the spec. When the spec gains a command, the compiler reports a missing\n\
             method.",
    ]);
    docs.raw_both([
        "抛出 `Refusal` 可以拒绝指令。处理超时或连接断开后，`context.signal` 会中止：调用方不再等待响应。",
        "Throw a `Refusal` to refuse a command. `context.signal` is aborted after a handler timeout or a loss of the connection:\n\
         the caller does not wait for the response any more.",
    ]);
    out.docs(&docs);
    let ranges = ranges(context).into_iter().map(|(name, _)| name);
    let raw: Vec<String> = ranges.chain([UNKNOWN.to_owned()]).collect();
    parts.push(format!("Pick<PartialRobot, '{}'>", raw.join("' | '")));
    out.line([&extending(out, "Robot", &parts), " {}"].concat());
}

fn partial_robot(out: &mut Source, context: &Context<'_>, parts: &[String]) {
    out.documented(&Docs::line([
        "各组指令的方法，都可以不写。",
        "The methods of each group of commands. Each is optional.",
    ]));
    let open = extending(out, "PartialRobot", parts);
    out.block(open, |out| {
        for (name, range) in ranges(context) {
            let mut docs = Docs::titled(&range.text);
            let (first, last) = (&range.first_spelling, &range.last_spelling);
            docs.paragraph(format!(
                "Codes {first} to {last} without a separate method."
            ));
            raw(out, docs, &name);
        }
        let docs = Docs::said([
            "功能码不在规范中的指令。",
            "Commands with a code that is not in the spec.",
        ]);
        raw(out, docs, UNKNOWN);
    });
    out.documented(&Docs::said([
        "只实现了一部分指令的机器人：没有写的指令以“未实现”拒绝。继承它，并给每个方法写上 `override`，编译器会指出写错的名称。",
        "A robot with some of the commands. It refuses the others as not implemented. Extend it and mark each method with `override`: the compiler then finds misspelt names.",
    ]));
    out.line("export abstract class PartialRobot {}");
}

/// Writes an optional method for requests without a type. A new range in the spec therefore breaks no robot.
fn raw(out: &mut Source, mut docs: Docs<'_>, name: &str) {
    docs.both([
        "报文是 JSON 文本。不实现此方法时，按未知指令拒绝。",
        "Messages are JSON texts. Without this method, the robot refuses them as unknown commands.",
    ]);
    out.blank();
    out.docs(&docs);
    out.line(format!(
        "{name}?(request: RawRequest, context: Context): Answer<string>"
    ));
}

fn example(out: &mut Source, parts: &[String]) {
    let about = ["每组指令的方法。", "The methods of each group of commands."];
    merged(out, "ExampleRobot", about, parts);
    let mut docs = Docs::two_lines([
        "用规范中的示例响应指令，只用于演示和测试；自己的机器人从 `extends PartialRobot` 开始。",
        "Responds with the examples of the spec, only for demos and tests. Your own robot starts with `extends PartialRobot`.",
    ]);
    docs.both([
        "它不执行运动指令和影响不详的指令，以“未实现”拒绝；`pretendMotion` 为真时假装成功。",
        "It does not execute commands that move the robot or have an unknown effect, and refuses them as not implemented. With `pretendMotion`, it pretends success.",
    ]);
    out.docs(&docs);
    out.block("export class ExampleRobot implements Robot", |out| {
        out.line(
            "\
static {
  addExamples(ExampleRobot, service.methods)
}",
        );
        out.documented(&Docs::two_lines([
            "对运动指令也返回成功，但什么都不会动；只在没有真机时使用。",
            "Responds to commands that may move the robot with success as well, although no robot moves. Use it only without a real\n\
             robot.",
        ]));
        out.line("readonly pretendMotion: boolean");
        out.documented(&Docs::line([
            "默认不假装成功。",
            "By default it does not pretend success.",
        ]));
        out.line(
            "\
constructor({ pretendMotion = false }: Partial<Pick<ExampleRobot, 'pretendMotion'>> = {}) {
  this.pretendMotion = pretendMotion
}",
        );
    });
}

/// Writes a class whose methods send something to the apps of a server.
fn pushing(
    out: &mut Source,
    name: &str,
    parts: &[String],
    about: [&str; 2],
    add: &str,
    made: [&str; 2],
) {
    let methods = ["每组的方法。", "The methods of each group."];
    merged(out, name, methods, parts);
    out.docs(&Docs::line(about));
    out.block(format!("export class {name}"), |out| {
        out.line(format!("static {{\n  {add}\n}}"));
        out.blank();
        let server = ["服务端。", "The server."];
        constructor(out, ["server", "Server"], server, made);
    });
}

/// Returns `true` unless the spec states that the command moves nothing.
fn may_move(command: &Call<'_>) -> bool {
    !matches!(
        command.operation.effect(),
        Some(Effect::Read | Effect::Config)
    )
}

/// Returns the runtime types that a group's part of the robot's side names.
pub fn runtime_types(group: &Group<'_, '_>) -> Vec<&'static str> {
    let mut names = Vec::new();
    if group.has(What::Commands) {
        names.extend(["Answer", "Context"]);
    }
    names.extend(group.has(What::Reports).then_some("Acknowledgement"));
    let pushes = group.has(What::Reports) || group.has(What::RobotStreams);
    names.extend(pushes.then_some("Audience"));
    names
}

/// Writes a group's part of the robot's side.
pub fn group(out: &mut Source, context: &Context<'_>, group: &Group<'_, '_>) {
    let handlers = (
        PARTIAL,
        [
            "本组的指令，都可以不写：`PartialRobot` 的方法。",
            "The commands of the group, each optional: methods of `PartialRobot`.",
        ],
    );
    group.interface(out, context, handlers, &group.commands, |out, command| {
        handler(out, context, command);
    });
    let partial = group.part(context, PARTIAL);
    if group.has(What::Commands) {
        out.documented(&Docs::line([
            "本组的指令，`Robot` 的方法。",
            "The commands of the group: methods of `Robot`.",
        ]));
        let name = group.part(context, Side::Robot.name());
        out.line(format!(
            "export interface {name} extends Required<{partial}> {{}}"
        ));
    }
    let examples = (
        "examples",
        [
            "本组指令的示例：`ExampleRobot` 的方法。",
            "The examples of the group: methods of `ExampleRobot`.",
        ],
    );
    group.interface(out, context, examples, &group.commands, |out, command| {
        let mut docs = Docs::default();
        docs.raw(format!("{{@inheritDoc {partial}.{}}}", command.method));
        out.docs(&docs);
        let parameters = parameters(context, command);
        let parameters: &[String] = if may_move(command) { &parameters } else { &[] };
        method(out, command.method, parameters, &command.response.ty.name);
    });
    let audience = format!("audience?: {}", own(context, "Audience"));
    let reporter = (
        "reporter",
        [
            "本组的上报，`Reporter` 的方法。",
            "The reports of the group: methods of `Reporter`.",
        ],
    );
    group.interface(out, context, reporter, &group.reports, |out, report| {
        let operation = report.operation;
        let mut docs = facts::operation_docs(operation);
        facts::operation_end(context.style, &mut docs, operation);
        docs.paragraph("Resolves to the outcome at each app.");
        end(&mut docs, context, operation);
        out.docs(&docs);
        let parameters = [
            format!("report: {}", report.request.ty.name),
            audience.clone(),
        ];
        let result = format!("Promise<{}[]>", own(context, "Acknowledgement"));
        method(out, report.method, &parameters, &result);
    });
    let streamer = (
        "streamer",
        [
            "本组由机器人发送的数据流，`Streamer` 的方法。",
            "The streams of the group that a robot sends: methods of `Streamer`.",
        ],
    );
    group.interface(
        out,
        context,
        streamer,
        &group.subscribed().collect::<Vec<_>>(),
        |out, stream| {
            let mut docs = stream_docs(context, stream);
            docs.paragraph("Resolves to the number of data connections that took it.");
            out.docs(&docs);
            let held = carried(context, stream, "");
            let parameters = [
                "id: number".to_owned(),
                format!("content: {held}"),
                audience.clone(),
            ];
            let name = format!("send{}", stream.name);
            method(out, &name, &parameters, "Promise<number>");
        },
    );
}

fn handler(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let operation = command.operation;
    let mut docs = facts::operation_docs(operation);
    facts::operation_end(context.style, &mut docs, operation);
    if context.package.error_type(operation).is_some() {
        let method = command.method;
        docs.raw(format!(
            "`Refusal.declared(commands.{method}, …)` makes one of its errors."
        ));
    }
    end(&mut docs, context, operation);
    out.docs(&docs);
    let result = format!("{}<{}>", own(context, "Answer"), command.response.ty.name);
    let name = [command.method, "?"].concat();
    method(out, &name, &parameters(context, command), &result);
}

/// Returns the parameters of a robot's method.
fn parameters(context: &Context<'_>, command: &Call<'_>) -> [String; 2] {
    let request = format!("request: {}", command.request.ty.name);
    [request, format!("context: {}", own(context, "Context"))]
}
