//! The response to a call, and the process that the call has started.

use crate::paths::{self, at};
use fc_reflect::{About, BodyError, Frame, Message, Node, Reflector, Value};
use fc_spec::model::{
    self, Cadence, Direction, EnvelopeRole, Exchange, Model, Operation, ResultCode, ResultRole,
    SetOff,
};
use std::time::Duration;

/// The result in the envelope of a response.
#[derive(Clone, Debug)]
pub struct Outcome<'m> {
    /// The result code, or `None` if responses carry none.
    pub code: Option<i64>,
    /// The result code in the spec.
    pub known: Option<&'m ResultCode>,
    /// The text, or an empty string.
    pub text: String,
}

impl<'m> Outcome<'m> {
    /// Reads the result of a response.
    #[must_use]
    pub fn of(model: &'m Model, message: &Message<'_>) -> Self {
        let code = result_code(message);
        let text = match with_role(&message.envelope, EnvelopeRole::ResultText) {
            Some(Value::Text(text)) => text.clone(),
            _ => String::new(),
        };
        let known = model.results.iter().find(|known| Some(known.code) == code);
        Self { code, known, text }
    }

    /// Returns `true` if the robot has accepted the request. Without a result code, every response is a success.
    #[must_use]
    pub fn is_success(&self) -> bool {
        self.code.is_none()
            || self
                .known
                .is_some_and(|it| it.role == Some(ResultRole::Success))
    }
}

/// Returns the result code of a response, if its envelope has one.
pub(crate) fn result_code(message: &Message<'_>) -> Option<i64> {
    match with_role(&message.envelope, EnvelopeRole::ResultCode)? {
        Value::Int(code) => i64::try_from(*code).ok(),
        _ => None,
    }
}

fn with_role<'a>(envelope: &'a [Node<'_>], role: EnvelopeRole) -> Option<&'a Value<'a>> {
    let has_role = |node: &&Node<'_>| matches!(node.about, About::Envelope(it) if it.role == role);
    envelope.iter().find(has_role).map(|node| &node.value)
}

/// A response that has been read.
#[derive(Debug)]
pub struct Response<'e, 'm> {
    /// The command, or `None` if the spec has none with this code.
    pub command: Option<&'m Operation>,
    /// The frame.
    pub frame: &'e Frame<'m>,
    /// The message in the frame.
    pub message: Message<'m>,
    /// The result.
    pub outcome: Outcome<'m>,
    /// The time since the request.
    pub took: Duration,
}

impl<'e, 'm> Response<'e, 'm> {
    /// Reads the response to a command.
    ///
    /// # Errors
    /// The error that prevents reading the envelope. The message contains an error of the body.
    pub fn read(
        reflector: &Reflector<'m>,
        command: Option<&'m Operation>,
        frame: &'e Frame<'m>,
        took: Duration,
    ) -> Result<Self, BodyError> {
        let message = reflector.message(command, Direction::Response, &frame.data)?;
        Ok(Self {
            command,
            frame,
            outcome: Outcome::of(reflector.model(), &message),
            message,
            took,
        })
    }
}

/// The progress of a process after a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Further reports will come.
    Running,
    /// The process has ended.
    Ended,
    /// The process has failed.
    Failed,
}

/// A process that a call has started.
#[derive(Clone, Debug)]
pub struct Process<'m> {
    /// The model of the command.
    pub model: &'m Model,
    /// The command.
    pub command: &'m Operation,
    /// The request of the call.
    pub request: model::Value,
    /// The response to it.
    pub response: model::Value,
}

impl Process<'_> {
    /// Returns the progress after a report, or `None` for a report of something else.
    ///
    /// A process ends with a final state. If the spec names none, it ends with a state that no other follows, or with the
    /// largest value of the number whose steps are reported. Any other report ends it.
    #[must_use]
    pub fn progress(&self, report: &Operation, body: &model::Value) -> Option<Progress> {
        let mut sets_off = self.command.sets_off().iter();
        let set_off = sets_off.find(|set_off| set_off.report == report.name)?;
        if !self.is_tied(set_off, body) {
            return None;
        }
        let Exchange::Report {
            state,
            failures,
            messages,
            cadence,
            ..
        } = &report.exchange
        else {
            return None;
        };
        let value = |keys: &[String]| {
            let (_, shape) = self.model.enum_at(&messages.request.ty, keys)?;
            let found = at(body, keys)?;
            let mut values = shape.values.iter();
            let value = values.find(|value| model::Value::from(&value.wire) == *found)?;
            Some((shape, value))
        };
        let has_failed = |keys: &Vec<String>| value(keys).is_some_and(|(_, value)| value.is_error);
        if state.iter().chain(failures).any(has_failed) {
            return Some(Progress::Failed);
        }
        let has_ended = match (state, cadence) {
            (Some(keys), _) => value(keys).is_some_and(|(shape, value)| {
                let has_final = shape.values.iter().any(|value| value.is_final);
                value.is_final || (!has_final && value.then.is_empty())
            }),
            (None, Some(Cadence::Step(step))) => {
                let field = paths::field(self.model, &messages.request.ty, &step.field)?;
                let most = field.details().constraints.max.as_ref();
                most.is_none_or(|most| {
                    let keys: Vec<&str> = step.field.split('.').collect();
                    paths::all(body, &keys, &|value| match value {
                        model::Value::Number(number) => number.compare(most).is_ge(),
                        _ => false,
                    })
                })
            }
            (None, _) => true,
        };
        Some(if has_ended {
            Progress::Ended
        } else {
            Progress::Running
        })
    }

    fn is_tied(&self, set_off: &SetOff, body: &model::Value) -> bool {
        set_off.tied.iter().all(|tie| {
            let message = match tie.side {
                Direction::Request => &self.request,
                Direction::Response => &self.response,
            };
            at(message, &tie.command) == at(body, &tie.report)
        })
    }
}
