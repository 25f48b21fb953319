//! The streams of a page: the details of a stream, or the streams that a command starts and stops.

use super::shared::Desk;
use crate::emit::markdown::links::Link;
use fc_spec::model::{Kind, Operation};
use serde::Serialize;

/// A stream.
#[derive(Debug, Serialize)]
pub(super) struct StreamView {
    /// The media type of its bytes, if it is stated.
    content: Option<String>,
    json: bool,
    started_by: Option<Link>,
    stopped_by: Option<Link>,
    /// `true` if it has the code of the command that starts it.
    shares_code: bool,
}

/// The streams of a command.
#[derive(Debug, Serialize)]
pub(super) struct OwnStreams {
    started: Vec<Link>,
    stopped: Vec<Link>,
}

pub(super) fn stream(desk: Desk<'_, '_>, operation: &Operation) -> Option<StreamView> {
    let stream = operation.stream()?;
    let command = |name: &Option<String>| desk.book.operation(name.as_deref()?);
    let starts = command(&stream.started_by);
    let shares = |command: &Operation| command.code.value == operation.code.value;
    Some(StreamView {
        content: stream.content.media_type().map(str::to_owned),
        json: stream.content.json().is_some(),
        started_by: starts.map(|command| desk.operation(command)),
        stopped_by: command(&stream.stopped_by).map(|command| desk.operation(command)),
        shares_code: operation.code.value.is_some() && starts.is_some_and(shares),
    })
}

/// Returns `None` if the command has no streams.
pub(super) fn of_command(desk: Desk<'_, '_>, operation: &Operation) -> Option<OwnStreams> {
    if operation.kind() != Kind::Command {
        return None;
    }
    let (mut started, mut stopped) = (Vec::new(), Vec::new());
    for it in desk.book.model.streams_of(operation) {
        let stream = it.stream()?;
        if stream.started_by.as_ref() == Some(&operation.name) {
            started.push(desk.operation(it));
        }
        if stream.stopped_by.as_ref() == Some(&operation.name) {
            stopped.push(desk.operation(it));
        }
    }
    let any = !started.is_empty() || !stopped.is_empty();
    any.then_some(OwnStreams { started, stopped })
}
