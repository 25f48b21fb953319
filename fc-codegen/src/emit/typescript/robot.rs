//! `robot.ts`: the robot's side, whose methods the groups declare.

use super::client::{method, stream_docs};
use super::context::{Context, own};
use super::group::{Group, What, extending, merged, parts};
use super::messages::deprecated;
use super::operations::carried;
use super::protocol::{imported, ranges};
use super::source::{head, named};
use crate::package::about;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::items::Call;
use crate::package::ranges::UNKNOWN;
use crate::package::source::Source;
use fc_spec::model::Side;

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
    out.template("serve", &[("protocol", &protocol)]);
    if has_commands {
        let parts = parts(context, groups, "examples", What::Commands);
        merged(&mut out, "ExampleRobot", ["指令", " of commands"], &parts);
        out.template("example_robot", &[]);
    }
    for (has, name, word, what) in [
        (has_reports, "Reporter", "reporter", What::Reports),
        (has_streams, "Streamer", "streamer", What::RobotStreams),
    ] {
        if has {
            let parts = parts(context, groups, word, what);
            merged(&mut out, name, ["", ""], &parts);
            out.template(name, &[]);
        }
    }
    out.finish()
}

fn robot(out: &mut Source, context: &Context<'_>, mut parts: Vec<String>) {
    let ranges = ranges(context).into_iter().map(|(name, _)| name);
    let raw: Vec<String> = ranges.chain([UNKNOWN.to_owned()]).collect();
    parts.push(format!("Pick<PartialRobot, '{}'>", raw.join("' | '")));
    let extending = extending(out, "Robot", &parts);
    out.template("complete_robot", &[("extending", &extending)]);
}

fn partial_robot(out: &mut Source, context: &Context<'_>, parts: &[String]) {
    let open = extending(out, "PartialRobot", parts);
    out.block(open, |out| {
        for (name, range) in ranges(context) {
            raw(out, about::codes(Some(range)), &name);
        }
        raw(out, about::codes(None), UNKNOWN);
    });
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
    group.interface(out, context, PARTIAL, &group.commands, |out, command| {
        handler(out, context, command);
    });
    let partial = group.part(context, PARTIAL);
    if group.has(What::Commands) {
        let name = group.part(context, Side::Robot.name());
        out.template("handlers", &[("name", &name), ("partial", &partial)]);
    }
    group.interface(out, context, "examples", &group.commands, |out, command| {
        let mut docs = Docs::default();
        docs.raw(format!("{{@inheritDoc {partial}.{}}}", command.method));
        out.docs(&docs);
        let parameters = parameters(context, command);
        let parameters: &[String] = if command.may_move() { &parameters } else { &[] };
        method(out, command.method, parameters, &command.response.ty.name);
    });
    let audience = format!("audience?: {}", own(context, "Audience"));
    group.interface(out, context, "reporter", &group.reports, |out, report| {
        let mut docs = facts::method_docs(context, report.operation, |docs| {
            docs.paragraph("Resolves to the outcome at each app.");
        });
        deprecated(&mut docs, report.operation.deprecated.as_ref());
        out.docs(&docs);
        let parameters = [
            format!("report: {}", report.request.ty.name),
            audience.clone(),
        ];
        let result = format!("Promise<{}[]>", own(context, "Acknowledgement"));
        method(out, report.method, &parameters, &result);
    });
    let streams: Vec<_> = group.subscribed().collect();
    group.interface(out, context, "streamer", &streams, |out, stream| {
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
    });
}

fn handler(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let method_name = command.method;
    let mut docs = facts::command_docs(context, command.operation, |_| {
        format!("`Refusal.declared(commands.{method_name}, …)` makes one of its errors.")
    });
    deprecated(&mut docs, command.operation.deprecated.as_ref());
    out.docs(&docs);
    let result = format!("{}<{}>", own(context, "Answer"), command.response.ty.name);
    let name = [method_name, "?"].concat();
    method(out, &name, &parameters(context, command), &result);
}

/// Returns the parameters of a robot's method.
fn parameters(context: &Context<'_>, command: &Call<'_>) -> [String; 2] {
    let request = format!("request: {}", command.request.ty.name);
    [request, format!("context: {}", own(context, "Context"))]
}
