//! `robot.py`: the robot's stub. A class with one method per command, complete or in part, and typed pushing of reports.

use super::client::{content, head, own, speaks, stream_docs};
use super::operations::qualified;
use super::protocol;
use super::source::{Code, PYTHON, Python, method};
use crate::emit::stub::context::{Context, page_of};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::emit::stub::ranges::pass_through;
use crate::emit::stub::source::Source;
use crate::surface::package::Call;
use fc_spec::model::{Direction, Operation, Side};

/// These ranges as the protocol's value has them.
pub fn ranges(context: &Context<'_>) -> Vec<Code> {
    let ranges = pass_through(context).into_iter().map(|(name, range)| {
        let items = vec![
            Code::named("first", range.first_spelling.as_str()),
            Code::named("last", range.last_spelling.as_str()),
            Code::named("method", format!("\"{name}\"")),
        ];
        Code::call("rt.PassThrough", items)
    });
    ranges.collect()
}

/// The file.
pub fn file(context: &Context<'_>) -> String {
    let commands = context.commands();
    let reports = context.reports();
    let streams = context.package.streams.iter().map(|it| it.of);
    let streams: Vec<&Operation> = streams.filter(|it| it.sender == Side::Robot).collect();
    let json = streams
        .iter()
        .any(|it| it.body(Direction::Request).is_some());
    let names: &[&str] = if commands.is_empty() {
        &["ABC"]
    } else {
        &["ABC", "abstractmethod"]
    };
    let mut out = Source::new(&PYTHON);
    head(
        &mut out,
        [
            "机器人端：每条指令一个方法，按示例应答的演示机器人，带类型的主动上报。",
            "The robot's side: one method per command, a robot that responds with the examples in the spec, and typed reports.",
        ],
        &[("abc", names), ("typing", &["ClassVar"])],
        &own(
            !commands.is_empty() || !reports.is_empty() || json,
            !reports.is_empty() || !streams.is_empty(),
        ),
    );
    out.import_from(".protocol", &[&protocol::name(context)]);
    complete(&mut out, context, &commands);
    partial(&mut out, &commands);
    example(&mut out, context);
    reporter(&mut out, context, &reports);
    if !context.package.streams.is_empty() {
        streamer(&mut out, context, &streams);
    }
    out.finish()
}

fn class(out: &mut Source, head: &str, about: &[&'static str], body: impl FnOnce(&mut Source)) {
    out.gap();
    out.suite(head, |out| {
        out.docstring(&Docs::said(about));
        body(out);
    });
}

/// A method that handles a command.
fn handler(out: &mut Source, command: &Call<'_>, body: impl FnOnce(&mut Source)) {
    let request = format!("request: messages.{}", command.request.ty.name);
    let parameters = ["self", "context: rt.Context", &request].map(Code::from);
    let returns = format!("messages.{}", command.response.ty.name);
    let open = format!("async def {}(", command.method);
    method(out, &open, parameters.to_vec(), &returns, body);
}

fn complete(out: &mut Source, context: &Context<'_>, commands: &[Call<'_>]) {
    let about = [
        "完整的机器人：处理规范中的全部指令。规范新增一条指令，这里就缺少一个方法，类型检查器会指出，创建对象时 Python 也会指出。",
        "A complete robot: it handles all commands of the spec. When the spec gains one, a method is missing here: the type checker says so, and Python when the robot is made.",
        "只实现了一部分指令的机器人，从 `PartialRobot` 继承：方法相同，都可以不写。指令齐全之后只改这一个词。",
        "A robot that has some of them so far inherits from `PartialRobot`: the methods are the same, and none has to be there. This one word is all that changes once nothing is missing.",
    ];
    class(out, "class Robot(rt.Robot, ABC)", &about, |out| {
        speaks(out, context);
        for command in commands {
            let operation = command.operation;
            let mut docs = facts::operation_docs(operation);
            facts::operation_end(context.style, &mut docs, operation);
            if let Some(error) = context.package.error_type(operation) {
                docs.raw(format!(
                    "To refuse it, raise the `refusal()` of a `messages.{error}`."
                ));
            }
            docs.paragraph(context.links(&operation.location, &page_of(operation)));
            out.blank();
            out.line("@abstractmethod");
            handler(out, command, |out| out.docstring(&docs));
        }
        for (name, range) in pass_through(context) {
            let mut docs = Docs::of(&range.text);
            docs.paragraph(format!(
                "Codes {} to {} that have no method of their own.",
                range.first_spelling, range.last_spelling
            ));
            docs.paragraph("不实现此方法时，按未知指令拒绝。");
            docs.paragraph("Refused as an unknown command unless the robot has this method.");
            let parameters = ["self", "context: rt.Context", "request: rt.RawRequest"];
            let parameters = parameters.map(Code::from).to_vec();
            out.blank();
            out.line("@rt.left_out");
            method(
                out,
                &format!("async def {name}("),
                parameters,
                "rt.Json",
                |out| {
                    out.docstring(&docs);
                    out.line("raise NotImplementedError");
                },
            );
        }
    });
}

fn partial(out: &mut Source, commands: &[Call<'_>]) {
    let about = [
        "有一部分指令的机器人：方法相同，都可以不写；没有写的指令以“未实现”拒绝。",
        "A robot that has some of the commands so far: what is left out is refused as not implemented.",
    ];
    class(out, "class PartialRobot(Robot)", &about, |out| {
        for command in commands {
            out.blank();
            out.line("@rt.left_out");
            handler(out, command, |out| {
                out.line(format!("\"\"\"See `Robot.{}`.\"\"\"", command.method));
                out.line("raise NotImplementedError");
            });
        }
    });
}

fn example(out: &mut Source, context: &Context<'_>) {
    let about = [
        "用规范中的示例回答指令，只用于演示和测试；自己的机器人从 `PartialRobot` 开始。",
        "Answers with the spec's examples, for demos and tests alone; a robot of your own starts with `PartialRobot`.",
        "会引起动作的指令，以及作用不详的指令，它并不执行，因此以“未实现”拒绝，除非要求它假装：`pretend_motion=True`。",
        "It does not carry out what sets something in motion, or may do so: such commands are refused as not implemented, unless it is told to pretend, with `pretend_motion=True`.",
    ];
    class(out, "class ExampleRobot(rt.ExampleRobot)", &about, |out| {
        speaks(out, context);
    });
}

fn reporter(out: &mut Source, context: &Context<'_>, reports: &[Call<'_>]) {
    let about = [
        "主动上报：每种上报一个方法。",
        "Pushes reports: one method per report.",
        "`to` 是某个连接的编号；不给出时，向全部连接上报。",
        "`to` is the number of a connection; without it a report goes to all of them.",
    ];
    class(out, "class Reporter(rt.Reporter)", &about, |out| {
        for report in reports {
            let operation = report.operation;
            let mut docs = facts::operation_docs(operation);
            facts::operation_end(context.style, &mut docs, operation);
            docs.paragraph("Returns what became of it at each connection.");
            docs.paragraph(context.links(&operation.location, &page_of(operation)));
            let message = format!("report: messages.{}", report.request.ty.name);
            let parameters = ["self", &message, "to: int | None = None"].map(Code::from);
            let open = format!("async def {}(", report.method);
            out.blank();
            method(
                out,
                &open,
                parameters.to_vec(),
                "list[rt.Acknowledgement]",
                |out| {
                    out.docstring(&docs);
                    let arguments = vec![qualified(operation).into(), "report".into(), "to".into()];
                    Code::call("await self.server.push", arguments).write(out, "return ", "");
                },
            );
        }
    });
}

fn streamer(out: &mut Source, context: &Context<'_>, streams: &[&Operation]) {
    let about = [
        "机器人发送的数据流：每个数据流一个方法。",
        "Sends the robot's streams: one method per stream.",
    ];
    class(out, "class Streamer(rt.Streamer)", &about, |out| {
        for stream in streams {
            let mut docs = stream_docs(context, stream);
            docs.paragraph("Returns how many data connections took it.");
            let parameter = content(context, stream);
            let parameters = [
                "self",
                "message_id: int",
                &parameter,
                "to: int | None = None",
            ];
            let parameters = parameters.map(Code::from).to_vec();
            out.blank();
            method(
                out,
                &format!("async def send_{}(", stream.name),
                parameters,
                "int",
                |out| {
                    out.docstring(&docs);
                    let arguments = ["message_id", "content", "to"].map(Code::from);
                    let arguments = [Code::Text(qualified(stream))].into_iter().chain(arguments);
                    Code::call("await self.server.send_stream", arguments.collect())
                        .write(out, "return ", "");
                },
            );
        }
    });
}
