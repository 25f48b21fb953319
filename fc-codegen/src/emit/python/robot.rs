//! What a group has of the robot's stubs: the methods of its commands, its reports and its streams.

use super::client::{about, content, stream_docs};
use super::group::part_of;
use super::homes::{Group, Piece};
use super::operations::constant;
use super::source::{Code, Python, method};
use crate::emit::stub::context::{Context, page_of};
use crate::emit::stub::facts;
use crate::emit::stub::source::Source;
use crate::surface::package::Call;
use fc_spec::model::Side;

/// A method that handles a command.
fn handler(out: &mut Source, command: &Call<'_>, body: impl FnOnce(&mut Source)) {
    let request = format!("request: {}", command.request.ty.name);
    let parameters = ["self", "context: rt.Context", &request].map(Code::from);
    let open = format!("async def {}(", command.method);
    let returns = &command.response.ty.name;
    method(out, &open, parameters.to_vec(), returns, body);
}

/// The methods that a complete robot has to have.
pub fn handlers(out: &mut Source, context: &Context<'_>, group: &Group<'_>) {
    let Some(name) = group.name(Piece::Handlers) else {
        return;
    };
    let about = about("Robot", "指令", "commands", group);
    part_of(out, name, "ABC", about, |out| {
        for command in &group.commands {
            let operation = command.operation;
            let mut docs = facts::operation_docs(operation);
            facts::operation_end(context.style, &mut docs, operation);
            if let Some(error) = context.package.error_type(operation) {
                docs.raw(format!(
                    "To refuse the command, raise the `refusal()` of a `{error}`."
                ));
            }
            docs.paragraph(context.links(&operation.location, &page_of(operation)));
            out.blank();
            out.line("@abstractmethod");
            handler(out, command, |out| out.docstring(&docs));
        }
    });
}

/// The same, none of which has to be there.
pub fn partial_handlers(out: &mut Source, group: &Group<'_>) {
    let (Some(name), Some(base)) = (
        group.name(Piece::PartialHandlers),
        group.name(Piece::Handlers),
    ) else {
        return;
    };
    let about = about("PartialRobot", "指令", "commands", group);
    part_of(out, name, base, about, |out| {
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

/// The methods that push reports.
pub fn reporter(out: &mut Source, context: &Context<'_>, group: &Group<'_>) {
    let Some(name) = group.name(Piece::Reporter) else {
        return;
    };
    let about = about("Reporter", "上报", "reports", group);
    part_of(out, name, "rt.Reporter", about, |out| {
        for report in &group.reports {
            let operation = report.operation;
            let mut docs = facts::operation_docs(operation);
            facts::operation_end(context.style, &mut docs, operation);
            docs.paragraph("Returns the outcome at each connection.");
            docs.paragraph(context.links(&operation.location, &page_of(operation)));
            let message = format!("report: {}", report.request.ty.name);
            let parameters = ["self", &message, "to: int | None = None"].map(Code::from);
            let open = format!("async def {}(", report.method);
            let returns = "list[rt.Acknowledgement]";
            out.blank();
            method(out, &open, parameters.to_vec(), returns, |out| {
                out.docstring(&docs);
                let arguments = [&*constant(context, operation), "report", "to"];
                Code::call("await self.server.push", arguments.map(Code::from).to_vec())
                    .write(out, "return ", "");
            });
        }
    });
}

/// The methods that send the robot's streams.
pub fn streamer(out: &mut Source, context: &Context<'_>, group: &Group<'_>) {
    let Some(name) = group.name(Piece::Streamer) else {
        return;
    };
    let about = about("Streamer", "数据流", "streams", group);
    part_of(out, name, "rt.Streamer", about, |out| {
        for stream in group.streams.iter().filter(|it| it.sender == Side::Robot) {
            let mut docs = stream_docs(context, stream);
            docs.paragraph("Returns the number of data connections that took it.");
            let held = content(context, stream);
            let parameters = ["self", "message_id: int", &held, "to: int | None = None"];
            let parameters = parameters.map(Code::from).to_vec();
            let open = format!("async def send_{}(", stream.name);
            out.blank();
            method(out, &open, parameters, "int", |out| {
                out.docstring(&docs);
                let arguments = [&*constant(context, stream), "message_id", "content", "to"];
                let arguments = arguments.map(Code::from).to_vec();
                Code::call("await self.server.send_stream", arguments).write(out, "return ", "");
            });
        }
    });
}
