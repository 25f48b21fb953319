//! Responses and refusals, and the check of permissions.

use super::allow::Effects;
use super::counters::Answered;
use super::output::Output;
use super::peer::Peer;
use crate::clock;
use crate::frame::{FrameError, FrameId, PreparedBody};
use crate::json::{BodyError, Json, decode, to_vec};
use crate::message::{Empty, Message, read_enveloped, write_enveloped};
use crate::open_message::OpenMessage;
use crate::operation::{Effect, OperationInfo, OperationKind, ResultText};
use crate::protocol::{DigestOf, Protocol, ResponseEnvelope};
use crate::refusal::Refusal;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Returns the envelope of success.
fn success<P: Protocol>(now: i64) -> P::Response {
    let success = P::RESULTS.success;
    P::Response::at(now, success.code, success.text)
}

impl<P: Protocol> Peer<P> {
    /// Answers with success and a response. If the response violates a constraint of the spec, answers with a refusal,
    /// because that is an error of the handler.
    pub(super) fn answer<M: Message>(&self, request: FrameId, response: &M) {
        if let Err(error) = response.check() {
            return self.no_response(request, &error);
        }
        self.succeed(request, |output, envelope| {
            output.append(request.answer(), envelope, response)
        });
    }

    /// Answers with success and a prepared response.
    pub(super) fn answer_prepared(&self, request: FrameId, response: &PreparedBody<DigestOf<P>>) {
        self.succeed(request, |output, envelope| {
            let (encoder, out) = (&mut output.encoder, &mut output.out);
            encoder.prepared_response(out, request.answer(), envelope, response)
        });
    }

    /// Answers with a frame that `write` writes with the envelope of success.
    fn succeed(
        &self,
        request: FrameId,
        write: impl FnOnce(&mut Output<P>, &P::Response) -> Result<(), FrameError>,
    ) {
        let now = clock::unix_ms();
        let written = {
            let mut output = self.output();
            // A panic in `write` loses only this envelope.
            let (made, envelope) = (output.success.take())
                .filter(|(made, _)| *made == now)
                .unwrap_or_else(|| (now, success::<P>(now)));
            let written = write(&mut output, &envelope);
            output.success = Some((made, envelope));
            self.note(&output);
            written
        };
        match written {
            Ok(()) => self.counters.call(request.code, Answered::Success),
            Err(error) => self.no_frame(request, &error),
        }
    }

    /// Answers with a JSON object. The envelope of success supplies its missing envelope keys.
    pub(super) fn answer_raw(&self, request: FrameId, text: &Json) {
        let (missing, keys, success) = match self.completed(text) {
            Ok(read) => read,
            Err(error) => return self.no_response(request, &error),
        };
        let written = {
            let mut output = self.output();
            let written = output.append(request.answer(), &missing, &keys);
            self.note(&output);
            written
        };
        match written {
            Ok(()) => {
                let answered = if success {
                    Answered::Success
                } else {
                    Answered::Refused
                };
                self.counters.call(request.code, answered);
            }
            Err(error) => self.no_frame(request, &error),
        }
    }

    /// Returns the envelope keys that an answer lacks, its keys, and `true` if together they mean success.
    fn completed(&self, text: &Json) -> Result<(OpenMessage, OpenMessage, bool), BodyError> {
        let allowance = self.settings.limits.json();
        let keys = decode::<OpenMessage>(text.as_str().as_bytes(), allowance)?;
        let success = to_vec(&success::<P>(clock::unix_ms()));
        let missing = decode::<OpenMessage>(&success, allowance)?.without(&keys);
        let mut whole = Vec::with_capacity(text.as_str().len());
        write_enveloped(&missing, &keys, &mut whole);
        let read = read_enveloped::<P::Response, Empty>(&whole, allowance)?;
        Ok((missing, keys, Refusal::of::<P>(&read.envelope).is_none()))
    }

    /// Logs an invalid response of a handler and answers with an error. Its values are not logged, like any text of a
    /// body.
    #[cold]
    fn no_response(&self, request: FrameId, error: &BodyError) {
        let (code, msg_id) = (request.code, request.id);
        let (path, error) = (error.path(), error.name());
        tracing::error!(
            protocol = P::NAME,
            code,
            msg_id,
            path,
            error,
            "the handler's response breaks the spec"
        );
        self.refuse_with(request, P::RESULTS.protocol);
    }

    /// Logs a response that does not fit into a frame, and answers with an error.
    #[cold]
    fn no_frame(&self, request: FrameId, error: &FrameError) {
        let (code, msg_id) = (request.code, request.id);
        tracing::error!(
            protocol = P::NAME,
            code,
            msg_id,
            error = error.name(),
            "{error}"
        );
        self.refuse_with(request, P::RESULTS.protocol);
    }

    /// Answers with only a result, or not at all if responses have no result.
    pub(super) fn refuse(&self, request: FrameId, refusal: &Refusal) {
        let results = P::RESULTS;
        let (answered, usable) = match refusal.code {
            code if code == results.protocol.code => (Answered::Protocol, false),
            code if code == results.timeout.code => (Answered::TimedOut, true),
            code if code == results.invalid.code => (Answered::Invalid, false),
            code if code == results.expired.code => (Answered::Expired, false),
            _ => (Answered::Refused, true),
        };
        self.counters.call(request.code, answered);
        if !usable {
            self.unusable();
        }
        // Only the code is logged, because the text may quote the body.
        let (code, msg_id, result) = (request.code, request.id, refusal.code);
        tracing::debug!(protocol = P::NAME, code, msg_id, result, "refused");
        if !P::Response::HAS_RESULT {
            return;
        }
        let envelope = P::Response::at(clock::unix_ms(), refusal.code, &refusal.text);
        let mut output = self.output();
        let written = output.append(request.answer(), &envelope, &Empty);
        self.note(&output);
        drop(output);
        if let Err(error) = written {
            tracing::error!(protocol = P::NAME, error = error.name(), "{error}");
        }
    }

    /// Runs code of the user for a request. A panic is counted and logged and returns `None`. The text of the panic is
    /// not logged, because it may quote the body.
    pub(super) fn guard<T>(&self, request: FrameId, code: impl FnOnce() -> T) -> Option<T> {
        // The state of the runtime stays consistent, see `lock`. The user is responsible for their own state.
        if let Ok(done) = catch_unwind(AssertUnwindSafe(code)) {
            return Some(done);
        }
        let (protocol, connection) = (P::NAME, self.id.0);
        let (name, code, msg_id) = (name::<P>(request.code), request.code, request.id);
        if self.counters.handlers_panicked.increment_sampled() {
            tracing::error!(
                protocol,
                connection,
                name,
                code,
                msg_id,
                "a handler panicked"
            );
        } else {
            tracing::debug!(
                protocol,
                connection,
                name,
                code,
                msg_id,
                "a handler panicked"
            );
        }
        None
    }

    /// Counts and logs a command of the spec that this robot does not implement.
    pub(super) fn note_not_implemented(&self, code: u16) {
        if self.counters.calls_not_implemented.increment_sampled() {
            let (protocol, connection, name) = (P::NAME, self.id.0, name::<P>(code));
            tracing::warn!(protocol, connection, name, code, "not implemented");
        }
    }

    /// Refuses a request whose handler has panicked.
    pub(super) fn refuse_after_panic(&self, request: FrameId) {
        self.refuse(request, &Refusal::protocol::<P>("the handler panicked"));
    }

    /// Returns `true` if the app's address may call a command.
    pub(super) fn may_call(&self, code: u16) -> bool {
        self.effects == Effects::ALL || self.effects.has(effect::<P>(code))
    }

    /// Refuses a request that the app's address may not make.
    pub(super) fn refuse_as_forbidden(&self, request: FrameId) {
        self.counters.calls_forbidden.increment();
        if let Some(held) = self.counters.limiters.forbidden_calls.admit() {
            let (protocol, connection, peer) = (P::NAME, self.id.0, self.address);
            let (name, code) = (name::<P>(request.code), request.code);
            let (effect, held) = (effect::<P>(code), held.shown());
            tracing::warn!(protocol, connection, %peer, name, code, ?effect, held, "refused: not allowed from this address");
        }
        let why = "not allowed from this address";
        self.refuse(request, &Refusal::protocol::<P>(why));
    }

    /// Refuses a request that is not started because too many handlers run on.
    pub(super) fn refuse_as_full(&self, request: FrameId) {
        let limit = self.settings.abandoned_handlers;
        if self.counters.abandoned_reached.increment_sampled() {
            let (protocol, connection, code) = (P::NAME, self.id.0, request.code);
            tracing::warn!(
                protocol,
                connection,
                code,
                limit,
                "too many abandoned handlers"
            );
        }
        let why = "too many handlers are still at work";
        self.refuse(request, &Refusal::protocol::<P>(why));
    }

    /// Answers with one of the protocol's results.
    pub(super) fn refuse_with(&self, request: FrameId, result: ResultText) {
        self.refuse(request, &result.into());
    }
}

/// Returns the operation with this code on the command port. A stream may have the code of its command.
fn operation<P: Protocol>(code: u16) -> Option<&'static OperationInfo> {
    P::operations()
        .iter()
        .find(|operation| operation.code == Some(code) && operation.kind != OperationKind::Stream)
}

/// Returns the spec's name of a command code.
pub(super) fn name<P: Protocol>(code: u16) -> &'static str {
    operation::<P>(code).map_or("unknown", |operation| operation.name)
}

/// Returns the effect of a command in the spec.
pub(super) fn effect<P: Protocol>(code: u16) -> Effect {
    let effect = operation::<P>(code).and_then(|operation| operation.effect);
    effect.unwrap_or(Effect::Unknown)
}
