//! The streams of a page: the details of a stream, or the streams that a command starts and stops.

use super::shared::Desk;
use fc_spec::model::{Kind, Operation};
use minijinja::{Value, context};

pub(super) fn stream(desk: Desk<'_, '_>, operation: &Operation) -> Option<Value> {
    let stream = operation.stream()?;
    let command = |name: &Option<String>| desk.book.operation(name.as_deref()?);
    let starts = command(&stream.started_by);
    let shares = |command: &Operation| command.code.value == operation.code.value;
    Some(context! {
        content => stream.content.media_type().map(str::to_owned),
        json => stream.content.json().is_some(),
        started_by => starts.map(|command| desk.operation(command)),
        stopped_by => command(&stream.stopped_by).map(|command| desk.operation(command)),
        shares_code => operation.code.value.is_some() && starts.is_some_and(shares),
    })
}

/// Returns `None` if the command has no streams.
pub(super) fn of_command(desk: Desk<'_, '_>, operation: &Operation) -> Option<Value> {
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
    any.then_some(context! { started, stopped })
}
