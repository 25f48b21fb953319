//! `client.py`, `sync.py` and `robot.py`: the public classes, which combine the parts of all groups.

use super::modules::{GroupPart, ModulePlan};
use super::protocol;
use super::source::{Code, Python, method};
use crate::package::about;
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::ranges::pass_through;
use crate::package::source::Source;

/// Creates the head of a file: its docstring, and its imports from the standard library and the runtime.
fn head(context: &Context<'_>, about: [&'static str; 2], standard: &[(&str, &[&str])]) -> Source {
    let mut out = context.source();
    out.docstring(&Docs::said(about));
    out.blank();
    out.line("from __future__ import annotations");
    out.blank();
    for (module, names) in standard {
        out.import_from(module, names);
    }
    out.blank();
    out.line("import fc_runtime as rt");
    out.blank();
    out
}

/// Returns the bases of a class: a part of each group, then `own`.
fn bases_of(plan: &ModulePlan<'_, '_>, part: GroupPart, own: &[&str]) -> Vec<Code> {
    let parts = plan.parts(part).into_iter();
    parts.chain(own.iter().copied()).map(Code::from).collect()
}

fn class(
    out: &mut Source,
    name: &str,
    bases: Vec<Code>,
    docs: &Docs<'_>,
    body: impl FnOnce(&mut Source),
) {
    out.gap();
    Code::Call(format!("class {name}("), bases, ")").write(out, "", ":");
    out.enclose("", "", |out| {
        out.docstring(docs);
        body(out);
    });
}

/// Writes the class variable with the protocol of a stub.
fn speaks(out: &mut Source, context: &Context<'_>) {
    out.blank();
    out.line(format!(
        "protocol: ClassVar[rt.Protocol] = {}",
        protocol::name(context)
    ));
}

/// Generates `client.py`.
pub fn client(context: &Context<'_>, plan: &ModulePlan<'_, '_>) -> String {
    let has_streams = !context.package.streams.is_empty();
    let mut out = head(
        context,
        [
            "app 端：每条指令一个方法，全部上报汇成一个类型。",
            "The app's side: one method per command, one type for any report.",
        ],
        &[("typing", &["ClassVar", "TypeAlias"])],
    );
    plan.import(
        &mut out,
        &[GroupPart::AnyReport, GroupPart::Calls, GroupPart::Streams],
    );
    out.import_from(".protocol", &[&protocol::name(context)]);
    out.blank();
    let mut reports = plan.parts(GroupPart::AnyReport);
    reports.push("rt.RawReport");
    let union = Code::Union(reports.into_iter().map(str::to_owned).collect());
    union.write_in_parentheses(&mut out, "AnyReport: TypeAlias = ");
    out.docstring(&Docs::said([
        "任意一个上报；功能码不在规范中的为 `RawReport`，原样保留。",
        "Any report. A report with a code that is not in the spec is a `RawReport`, kept unchanged.",
    ]));
    let docs = Docs::said([
        "一个机器人，从 app 一侧看：每条指令一个方法。",
        "A robot as seen from the app: one method per command.",
    ]);
    let bases = bases_of(plan, GroupPart::Calls, &["rt.Client[AnyReport]"]);
    class(&mut out, "Client", bases, &docs, |out| {
        speaks(out, context);
    });
    if has_streams {
        let docs = Docs::said([
            "数据端口上的数据流：订阅机器人的数据流，发送 app 的数据流。",
            "The streams of the data port. Subscribe to those of the robot, and send those of the app.",
        ]);
        let bases = bases_of(plan, GroupPart::Streams, &["rt.Streams"]);
        class(&mut out, "Streams", bases, &docs, |_| ());
    }
    out.finish()
}

/// Generates `sync.py`.
pub fn sync(context: &Context<'_>, plan: &ModulePlan<'_, '_>) -> String {
    let mut out = head(
        context,
        [
            "不用 `async` 的 app 端。",
            "The app's side without `async`.",
        ],
        &[("typing", &["ClassVar"])],
    );
    out.import_from(".client", &["AnyReport"]);
    plan.import(&mut out, &[GroupPart::SyncCalls]);
    out.import_from(".protocol", &[&protocol::name(context)]);
    let docs = Docs::said([
        "一个机器人，从 app 一侧看：每条指令一个方法，等到有响应才返回。",
        "A robot as seen from the app: one method per command, which waits for the response.",
    ]);
    let bases = bases_of(plan, GroupPart::SyncCalls, &["rt.SyncClient[AnyReport]"]);
    class(&mut out, "Client", bases, &docs, |out| {
        speaks(out, context);
    });
    out.finish()
}

/// Generates `robot.py`.
pub fn robot(context: &Context<'_>, plan: &ModulePlan<'_, '_>) -> String {
    let mut out = head(
        context,
        [
            "机器人端：每条指令一个方法，按示例响应的示例机器人，以及上报的发送端。",
            "The robot's side: one method per command, a robot that responds with the examples of the spec, and the sender of reports.",
        ],
        &[("abc", &["ABC"]), ("typing", &["ClassVar"])],
    );
    plan.import(
        &mut out,
        &[
            GroupPart::Handlers,
            GroupPart::PartialHandlers,
            GroupPart::Reporter,
            GroupPart::Streamer,
        ],
    );
    out.import_from(".protocol", &[&protocol::name(context)]);
    complete(&mut out, context, plan);
    let docs = Docs::said([
        "只实现了一部分指令的机器人：没有写的指令以“未实现”拒绝。",
        "A robot with some of the commands. It refuses the others as not implemented.",
    ]);
    let bases = bases_of(plan, GroupPart::PartialHandlers, &["Robot"]);
    class(&mut out, "PartialRobot", bases, &docs, |_| ());
    let mut docs = Docs::said([
        "用规范中的示例响应指令，只用于演示和测试；自己的机器人从 `PartialRobot` 开始。",
        "Responds with the examples of the spec, only for demos and tests. Your own robot starts with `PartialRobot`.",
    ]);
    docs.both([
        "它不执行运动指令和影响不详的指令，以“未实现”拒绝；`pretend_motion=True` 时假装成功。",
        "It does not execute commands that move the robot or have an unknown effect, and refuses them as not implemented. With `pretend_motion=True`, it pretends success.",
    ]);
    let bases = vec!["rt.ExampleRobot".into()];
    class(&mut out, "ExampleRobot", bases, &docs, |out| {
        speaks(out, context);
    });
    let mut docs = Docs::said([
        "发送上报：每种上报一个方法。",
        "Pushes reports: one method per report.",
    ]);
    docs.both([
        "`to` 是某个连接的编号；不给出时，向全部连接上报。",
        "`to` is the number of a connection. Without it, a report goes to all of them.",
    ]);
    let bases = bases_of(plan, GroupPart::Reporter, &["rt.Reporter"]);
    class(&mut out, "Reporter", bases, &docs, |_| ());
    if !context.package.streams.is_empty() {
        let docs = Docs::said([
            "机器人发送的数据流：每个数据流一个方法。",
            "Sends the streams of the robot: one method per stream.",
        ]);
        let bases = bases_of(plan, GroupPart::Streamer, &["rt.Streamer"]);
        class(&mut out, "Streamer", bases, &docs, |_| ());
    }
    out.finish()
}

fn complete(out: &mut Source, context: &Context<'_>, plan: &ModulePlan<'_, '_>) {
    let mut docs = Docs::said([
        "完整的机器人：处理规范中的全部指令。规范新增一条指令，这里就缺少一个方法，类型检查器会指出，Python 也会拒绝创建对象。",
        "A complete robot, which handles all commands of the spec. When the spec gains a command, the type checker reports a missing method, and Python refuses to create the robot.",
    ]);
    docs.both([
        "只实现了一部分指令的机器人，从 `PartialRobot` 继承：方法相同，都可以不写。指令齐全之后，改为继承 `Robot`。",
        "A robot with some of the commands inherits from `PartialRobot`. The methods are the same, and each is optional. Once the robot has all commands, inherit from `Robot`.",
    ]);
    let bases = bases_of(plan, GroupPart::Handlers, &["rt.Robot", "ABC"]);
    class(out, "Robot", bases, &docs, |out| {
        speaks(out, context);
        for (name, range) in pass_through(context) {
            let parameters = ["self", "context: rt.Context", "request: rt.RawRequest"];
            let parameters = parameters.map(Code::from).to_vec();
            let open = format!("async def {name}(");
            out.blank();
            out.line("@rt.left_out");
            method(out, &open, parameters, "rt.Json", |out| {
                out.docstring(&about::range(range));
                out.line("raise NotImplementedError");
            });
        }
    });
}
