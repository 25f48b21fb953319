//! `robot.rs`: the robot's stub.
//!
//! The file contains a trait with one method per command, a robot that responds with the spec's examples, and a typed
//! sender of reports.

use super::context::{Context, message};
use super::source::Source;
use super::streams;
use crate::package::about;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::items::Call;
use crate::package::ranges::{UNKNOWN, pass_through};
use fc_spec::model::{CodeRange, Side};

/// Generates `robot.rs`.
pub fn robot_file(context: &Context<'_>) -> String {
    let protocol = &context.package.name;
    let commands = context.commands();
    let ranges = pass_through(context);

    let mut out = context.source();
    out.inner_docs(&Docs::said([
        "机器人端：每条指令一个方法的 trait，按示例响应的示例机器人，以及上报的发送端。每种上报的方法与它的消息类型在同一个文件里。",
        "The robot's side: a trait with one method per command, a robot that responds with the examples of \
         the spec, and the sender of reports. The method of each report is in the file of its messages.",
]));
    out.blank();
    imports(&mut out, context, protocol, &commands);
    out.blank();
    robot(&mut out, context, protocol, &commands, &ranges);
    out.blank();
    example(&mut out, protocol, &commands);
    out.blank();
    reporter(&mut out, context, protocol);
    if streams::are_any(context) {
        out.blank();
        streams::robot(&mut out, context, protocol);
    }
    out.finish()
}

fn imports(out: &mut Source, context: &Context<'_>, protocol: &str, commands: &[Call<'_>]) {
    if !commands.is_empty() || streams::has_type(context, &[Side::Robot]) {
        out.import("super", &["messages"]);
    }
    out.import("super::protocol", &[protocol]);
    out.import("fc_derive", &["dispatch"]);
    let mut runtime = vec![
        "Context",
        "RawAnswer",
        "RawRequest",
        "Refusal",
        "ServerHandle",
    ];
    if !commands.is_empty() {
        runtime.push("Message");
    }
    runtime.extend(streams::imports_of_robot(context));
    out.import("fc_runtime", &runtime);
}

/// Returns the start, the parameters and the end of a method's signature.
pub fn signature(
    name: &str,
    context: &str,
    request: &str,
    response: &str,
    refusal: &str,
) -> (String, [String; 3], String) {
    (
        format!("async fn {name}("),
        ["&self".to_owned(), context.to_owned(), request.to_owned()],
        format!(") -> Result<{response}, {refusal}>"),
    )
}

/// A handler that stops early.
const STOPPED_EARLY: &str = "\
```ignore
tokio::select! {
    arrived = self.motors.drive(&request) => arrived,
    () = context.abandoned() => self.motors.stop().await,
}
```";

fn robot(
    out: &mut Source,
    context: &Context<'_>,
    protocol: &str,
    commands: &[Call<'_>],
    ranges: &[(String, &CodeRange)],
) {
    let mut docs = Docs::two_lines([
        "完整的机器人：处理规范中的全部指令。规范新增一条指令，这里就缺少一个方法，编译器会指出。",
        "A complete robot, which handles all commands of the spec. When the spec gains a command, the compiler\n\
         reports a missing method.",
    ]);
    docs.raw_both([
        "只实现了一部分指令的机器人，先写 `impl PartialRobot for …`：方法相同，都可以不写；没有写的指令以“未实现”\n\
         拒绝。[`RobotService`] 可以使用任意一种；指令齐全之后，把 `PartialRobot` 改为 `Robot`。",
        "A robot with some of the commands starts with `impl PartialRobot for …`. The methods are the same,\n\
         and each is optional; a missing one is refused as not implemented. [`RobotService`] serves either.\n\
         Once the robot has all commands, change `PartialRobot` to `Robot`.",
    ]);
    docs.raw_both([
        "处理超时后，机器人替处理程序返回超时；连接也可能先断开。此后调用方不再等待响应。运动指令和影响不详的指令，\n\
         处理程序仍运行到结束；其他指令的处理程序在下一个 `.await` 处被丢弃。处理程序用 [`Context::is_abandoned`]\n\
         和 [`Context::abandoned`] 得知这一点，可以提前停止：",
        "After a handler timeout, the robot responds with a timeout; the connection can also break first. From\n\
         then on the caller does not wait for the response. The handler of a command that moves the robot, or\n\
         with an unknown effect, runs to its end. The handler of any other command is dropped at its next\n\
         `.await`. A handler can check [`Context::is_abandoned`] or await [`Context::abandoned`], and stop early:",
    ]);
    docs.raw(STOPPED_EARLY);
    out.docs(&docs);
    out.line(format!(
        "#[dispatch(protocol = {protocol}, service = RobotService, partial = PartialRobot)]"
    ));
    out.block("pub trait Robot: Send + Sync + 'static", |out| {
        let cx = format!("context: Context<{protocol}>");
        for command in commands {
            let docs = facts::command_docs(context, command.operation, |error| {
                format!("Convert a [`messages::{error}`] to refuse the command with it.")
            });
            out.documented(&docs);
            let request = format!("request: {}", message(command.request));
            let (open, params, close) = signature(
                command.method,
                &cx,
                &request,
                &message(command.response),
                "Refusal",
            );
            out.list(&open, &params, &format!("{close};"));
        }
        for (name, range) in ranges {
            out.documented(&about::range(range));
            out.line(format!(
                "#[fc(range = {}..={})]",
                range.first_spelling, range.last_spelling
            ));
            raw(out, protocol, name);
        }
        out.documented(&about::unknown());
        out.line("#[fc(unknown)]");
        raw(out, protocol, UNKNOWN);
    });
}

/// Writes a method for requests without a type, which refuses them.
fn raw(out: &mut Source, protocol: &str, name: &str) {
    let cx = format!("context: Context<{protocol}>");
    let (open, params, close) = signature(name, &cx, "request: RawRequest", "RawAnswer", "Refusal");
    out.list(&open, &params, &format!("{close} {{"));
    out.line("    let _ = (context, request);");
    out.line(format!("    Err(Refusal::unknown::<{protocol}>())"));
    out.line("}");
}

fn example(out: &mut Source, protocol: &str, commands: &[Call<'_>]) {
    let mut docs = Docs::two_lines([
        "用规范中的示例响应指令，只用于演示和测试；自己的机器人从 `impl PartialRobot for …` 开始。",
        "Responds with the examples of the spec, only for demos and tests. Your own robot starts with\n\
         `impl PartialRobot for …`.",
    ]);
    docs.raw_both([
        "它不执行运动指令和影响不详的指令，以“未实现”拒绝；`pretend_motion` 为真时假装成功。",
        "It does not execute commands that move the robot or have an unknown effect, and refuses them as not\n\
         implemented. With `pretend_motion`, it pretends success.",
    ]);
    out.docs(&docs);
    out.line("#[derive(Clone, Copy, Debug, Default)]");
    out.block("pub struct ExampleRobot", |out| {
        out.docs(&Docs::two_lines([
            "对这些指令也返回成功，但什么都不会动；只在没有真机时使用。",
            "Responds to these with success as well, although no robot moves. Use it only without a real robot.",
        ]));
        out.line("pub pretend_motion: bool,");
    });
    out.blank();
    out.block("impl Robot for ExampleRobot", |out| {
        for command in commands {
            let request = format!("_: {}", message(command.request));
            let response = message(command.response);
            let name = if command.may_move() { "context" } else { "_" };
            let (open, params, close) = signature(
                command.method,
                &format!("{name}: Context<{protocol}>"),
                &request,
                &response,
                "Refusal",
            );
            out.blank();
            out.list(&open, &params, &format!("{close} {{"));
            if command.may_move() {
                out.line("    if !self.pretend_motion {");
                out.line("        return Err(context.not_implemented());");
                out.line("    }");
            }
            out.line(format!("    Ok({response}::example())"));
            out.line("}");
        }
    });
}

fn reporter(out: &mut Source, context: &Context<'_>, protocol: &str) {
    let allowed = if context.reports().is_empty() {
        "    #[allow(dead_code, reason = \"the spec has no reports\")]\n"
    } else {
        ""
    };
    out.docs(&Docs::written([
        "发送上报：每种上报一个方法。",
        "Pushes reports: one method per report. Cheap to clone.",
    ]));
    out.line(format!(
        "\
#[derive(Clone, Debug)]
pub struct Reporter {{
{allowed}    pub(crate) handle: ServerHandle<{protocol}>,
}}"
    ));
    out.blank();
    out.block("impl Reporter", |out| {
        out.docs(&Docs::written([
            "向服务端的各个连接上报。",
            "Reports to the connections of a server.",
        ]));
        out.line(format!(
            "\
#[must_use]
pub fn new(handle: ServerHandle<{protocol}>) -> Self {{
    Self {{ handle }}
}}"
        ));
    });
}
