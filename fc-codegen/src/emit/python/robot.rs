//! A group's part of the robot's stubs: methods for its commands, reports and streams.

use super::client::content;
use super::group::part_of;
use super::modules::{GroupPart, NamedGroup};
use super::operations::constant;
use super::source::{Code, Python, method};
use crate::package::context::Context;
use crate::package::facts;
use crate::package::items::Call;
use crate::package::source::Source;

/// Writes a method that handles a command.
fn handler(out: &mut Source, command: &Call<'_>, body: impl FnOnce(&mut Source)) {
    let request = format!("request: {}", command.request.ty.name);
    let parameters = ["self", "context: rt.Context", &request];
    let open = format!("async def {}(", command.method);
    let returns = &command.response.ty.name;
    method(out, &open, &parameters, returns, body);
}

/// Writes the methods that a complete robot must implement.
pub fn handlers(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    let (part, about) = (GroupPart::Handlers, ["Robot", "指令", "commands"]);
    part_of(out, group, part, "ABC", about, |out| {
        for command in &group.commands {
            let operation = command.operation;
            let docs = facts::command_docs(context, operation, |error| {
                format!("To refuse the command, raise the `refusal()` of a `{error}`.")
            });
            out.blank();
            out.line("@abstractmethod");
            handler(out, command, |out| out.docstring(&docs));
        }
    });
}

/// Writes the methods of a partial robot. Each method is optional.
pub fn partial_handlers(out: &mut Source, group: &NamedGroup<'_, '_>) {
    let Some(base) = group.part(GroupPart::Handlers) else {
        return;
    };
    let (part, about) = (
        GroupPart::PartialHandlers,
        ["PartialRobot", "指令", "commands"],
    );
    part_of(out, group, part, base, about, |out| {
        for command in &group.commands {
            out.blank();
            out.line("@rt.left_out");
            handler(out, command, |out| {
                out.line(format!("\"\"\"See `Robot.{}`.\"\"\"", command.method));
                out.line("raise NotImplementedError");
            });
        }
    });
}

/// Writes the methods that push reports.
pub fn reporter(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    let (part, about) = (GroupPart::Reporter, ["Reporter", "上报", "reports"]);
    part_of(out, group, part, "rt.Reporter", about, |out| {
        for report in &group.reports {
            let operation = report.operation;
            let docs = facts::method_docs(context, operation, |docs| {
                docs.paragraph("Returns the outcome at each connection.");
            });
            let message = format!("report: {}", report.request.ty.name);
            let parameters = ["self", &message, "to: int | None = None"];
            let open = format!("async def {}(", report.method);
            let returns = "list[rt.Acknowledgement]";
            out.blank();
            method(out, &open, &parameters, returns, |out| {
                out.docstring(&docs);
                let arguments = [&*constant(context, operation), "report", "to"];
                Code::call("await self.server.push", arguments).write(out, "return ", "");
            });
        }
    });
}

/// Writes the methods that send the robot's streams.
pub fn streamer(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    let (part, about) = (GroupPart::Streamer, ["Streamer", "数据流", "streams"]);
    part_of(out, group, part, "rt.Streamer", about, |out| {
        for stream in group.subscribed() {
            let mut docs = facts::method_docs(context, stream.of, |_| ());
            docs.paragraph("Returns the number of data connections that took it.");
            let held = content(context, stream);
            let parameters = ["self", "message_id: int", &held, "to: int | None = None"];
            let open = format!("async def send_{}(", stream.of.name);
            out.blank();
            method(out, &open, &parameters, "int", |out| {
                out.docstring(&docs);
                let arguments = [&*constant(context, stream), "message_id", "content", "to"];
                Code::call("await self.server.send_stream", arguments).write(out, "return ", "");
            });
        }
    });
}
