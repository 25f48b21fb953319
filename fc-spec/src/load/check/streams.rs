//! Streams: what a frame carries, and the commands that start and stop them.

use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::load::draft::{Draft, Placed};
use crate::load::grammar::STREAM;
use crate::model::{Kind, Operation};
use crate::syntax::Node;

/// A frame carries bytes of a media type or a JSON object.
pub(super) fn check_content(draft: &Draft<'_>, faults: &mut Faults) {
    for stream in streams(draft) {
        let node = stream.place.node;
        let Some((text, span)) = STREAM.content.of(node).and_then(|content| {
            let text = content.as_str()?;
            Some((text, content.span()))
        }) else {
            continue;
        };
        if let Some(body) = STREAM.body.entry(node) {
            let message = "what has a `body` is JSON and has no other media type";
            faults.push(
                Diagnostic::error(FaultCode::StreamContent, span, message)
                    .also(body.key.span(), "its keys are here"),
            );
        } else if text.ends_with("/json") {
            let message = "what is JSON has a `body` with its keys instead";
            faults.push(Diagnostic::error(FaultCode::StreamContent, span, message));
        }
    }
}

/// What starts or stops a stream is a command.
pub(super) fn check_commands(draft: &Draft<'_>, faults: &mut Faults) {
    for stream in streams(draft) {
        let node = stream.place.node;
        for by in [STREAM.started_by.of(node), STREAM.stopped_by.of(node)] {
            if let Some(fault) = by.and_then(|by| no_command(draft, by)) {
                faults.push(fault);
            }
        }
    }
}

fn no_command(draft: &Draft<'_>, by: Node<'_>) -> Option<Diagnostic> {
    let name = by.as_str()?;
    let span = by.span();
    let mut operations = draft.operations.iter();
    let named = operations.find(|operation| operation.item.name == name);
    let fault = match named {
        Some(named) if named.item.kind() == Kind::Command => return None,
        Some(named) => {
            let kind = named.item.kind().name();
            let message =
                format!("`{name}` is a {kind}; what starts or stops a stream is a command");
            Diagnostic::error(FaultCode::NotACommand, span, message)
                .also(named.place.name(), "declared here")
        }
        None => {
            let message = format!("there is no command `{name}`");
            Diagnostic::error(FaultCode::UnknownOperation, span, message)
        }
    };
    let commands = draft.operations.iter().map(|operation| &operation.item);
    let commands = commands.filter(|operation| operation.kind() == Kind::Command);
    Some(match nearest(name, commands.map(|it| it.name.as_str())) {
        Some(near) => fault.fix(span, near, format!("did you mean `{near}`?")),
        None => fault,
    })
}

fn streams<'d, 'a>(draft: &'d Draft<'a>) -> impl Iterator<Item = &'d Placed<'a, Operation>> {
    let operations = draft.operations.iter();
    operations.filter(|operation| operation.item.kind() == Kind::Stream)
}
