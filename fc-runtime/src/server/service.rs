//! The path of a request to its handler and back.

use super::answer::{effect, name};
use super::context::Context;
use super::gate::{Pass, process_frame};
use super::handlers::{Answer, begin};
use super::peer::Peer;
use super::running_handler::{StartedHandler, outlives};
use crate::clock;
use crate::frame::{FrameId, PreparedResponse};
use crate::json::{BodyError, Json, enveloped};
use crate::message::{Empty, Message};
use crate::operation::{Command, Effect};
use crate::protocol::{DigestOf, Protocol, RequestEnvelope};
use crate::raw::{RawAnswer, RawRequest};
use crate::refusal::Refusal;
use crate::session::after;
use crate::trace::is_traced;
use std::fmt;
use std::sync::Arc;
use std::task::Waker;
use std::time::Instant;
use tracing::Span;
use tracing::instrument::{Instrument, Instrumented};

/// A handler of requests. `#[dispatch]` implements it for a trait of handlers. By hand it is a `match` on
/// [`Request::code`].
pub trait Service<P: Protocol>: Send + Sync + 'static {
    /// Handles one request with one of its methods.
    fn call(&self, request: Request<'_, P>) -> Handling;
}

impl<P: Protocol, F> Service<P> for F
where
    F: Fn(Request<'_, P>) -> Handling + Send + Sync + 'static,
{
    fn call(&self, request: Request<'_, P>) -> Handling {
        self(request)
    }
}

/// The result of a request: answered, or passed to a handler that waits.
#[must_use = "the server has to be told"]
pub struct Handling(pub(super) Option<StartedHandler>);

impl fmt::Debug for Handling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() {
            "Handling(waiting)"
        } else {
            "Handling(done)"
        })
    }
}

/// A received request. Its body is still in the receive buffer.
#[must_use = "every request deserves an answer"]
pub struct Request<'a, P: Protocol> {
    pub(super) frame: FrameId,
    pub(super) body: &'a [u8],
    pub(super) peer: &'a Arc<Peer<P>>,
    pub(super) waker: &'a Waker,
    /// Permission to read a large request. It is returned before the handler is polled.
    pub(super) pass: Option<Pass>,
    /// Time of arrival.
    pub(super) at: Instant,
}

impl<P: Protocol> Request<'_, P> {
    /// Returns the command code.
    #[must_use]
    pub fn code(&self) -> u16 {
        self.frame.code
    }

    /// Returns the message id.
    #[must_use]
    pub fn id(&self) -> u32 {
        self.frame.id
    }

    /// Returns the whole text, envelope included. It may not be JSON.
    #[must_use]
    pub fn body(&self) -> &[u8] {
        self.body
    }

    /// Returns the context. The time of the request is unknown before the body has been read.
    #[must_use]
    pub fn context(&self) -> Context<P> {
        Context {
            peer: self.peer.address,
            connection: self.peer.id,
            id: self.frame.id,
            code: self.frame.code,
            time_ms: None,
            app: Arc::clone(self.peer),
            deadline: after(self.at, self.peer.settings.handler_timeout),
        }
    }

    /// Reads the body as `C`, calls `handler` and sends its result. An invalid body is answered without a call. If a
    /// response violates a constraint of the spec, the app gets the protocol's error result, and the key is logged.
    ///
    /// A panic of the handler is answered with the protocol's error result, counted and logged. It affects no other
    /// request. Data that the handler shares must stay consistent.
    ///
    /// The handler is polled once at once, and costs no wake-up if it is ready. If the app closes its sending side or
    /// sends invalid bytes, running handlers continue, and their responses are sent before the robot closes the
    /// connection.
    ///
    /// If a handler exceeds the handler timeout, the app is answered with the timeout result. The connection may also
    /// break before. In both cases the app no longer waits for the response. A handler with [`Effect::Motion`] or
    /// [`Effect::Unknown`] then runs to its end in its own task, unless it stops on [`Context::abandoned`]. Any other
    /// handler is dropped. All are dropped after the grace period of a shutdown.
    /// [`ServerConfig::abandoned_handlers`](super::ServerConfig::abandoned_handlers) limits the number of handlers that
    /// run on.
    pub fn handle<C, F, Fut>(self, handler: F) -> Handling
    where
        C: Command,
        F: FnOnce(Context<P>, C) -> Fut,
        Fut: Future<Output = Result<C::Response, Refusal>> + Send + 'static,
    {
        self.typed(handler, |peer, frame, output| match output {
            Ok(response) => peer.answer(frame, response),
            Err(refusal) => peer.refuse(frame, refusal),
        })
    }

    /// Handles a request like [`handle`](Self::handle), for a response that many apps request, such as a map. It is
    /// encoded and digested once by [`PreparedResponse::new`], and copied into each response.
    ///
    /// If the other commands are served by a trait, put a [`Service`] with one `match` in front of it.
    pub fn handle_prepared<C, F, Fut>(self, handler: F) -> Handling
    where
        C: Command,
        F: FnOnce(Context<P>, C) -> Fut,
        Fut: Future<Output = Result<PreparedResponse<C::Response, DigestOf<P>>, Refusal>>
            + Send
            + 'static,
    {
        self.typed(handler, |peer, frame, output| match output {
            Ok(response) => peer.answer_prepared(frame, response.body()),
            Err(refusal) => peer.refuse(frame, refusal),
        })
    }

    /// Reads the body as `C`, calls `handler` and sends its result with `answer`.
    fn typed<C, F, Fut>(self, handler: F, answer: Answer<P, Fut::Output>) -> Handling
    where
        C: Command,
        F: FnOnce(Context<P>, C) -> Fut,
        Fut: Future<Output: 'static> + Send + 'static,
    {
        let (context, request, lists) = match self.read::<C>() {
            Ok(read) => read,
            Err(refusal) => return self.refuse(&refusal),
        };
        if self.peer.detached.is_full() && outlives(C::EFFECT) {
            return self.refuse_as_full();
        }
        let span = self.span(|| C::NAME);
        let future = span.in_scope(|| handler(context, request));
        self.start(future.instrument(span), lists, |_| C::EFFECT, answer)
    }

    /// Calls `handler` with the unread body and sends the keys of its result, which may include keys of the envelope. A
    /// body that is not a JSON object is answered without a call.
    pub fn handle_raw<F, Fut>(self, handler: F) -> Handling
    where
        F: FnOnce(Context<P>, RawRequest) -> Fut,
        Fut: Future<Output = Result<RawAnswer, Refusal>> + Send + 'static,
    {
        let read = self.read::<Empty>().and_then(|(context, ..)| {
            let text = std::str::from_utf8(self.body).unwrap_or_default();
            let text = if text.is_empty() { "{}" } else { text };
            Json::new(text)
                .map(|text| (context, text))
                .map_err(Self::invalid)
        });
        let (context, text) = match read {
            Ok(read) => read,
            Err(refusal) => return self.refuse(&refusal),
        };
        if self.peer.detached.is_full() && outlives(effect::<P>(self.frame.code)) {
            return self.refuse_as_full();
        }
        let span = self.span(|| name::<P>(self.frame.code));
        let code = self.frame.code;
        let future = span.in_scope(|| handler(context, RawRequest { code, text }));
        self.start(
            future.instrument(span),
            0,
            effect::<P>,
            |peer, frame, output| match output {
                Ok(RawAnswer(text)) => peer.answer_raw(frame, text),
                Err(refusal) => peer.refuse(frame, refusal),
            },
        )
    }

    /// Answers that the command is unknown.
    pub fn unknown(self) -> Handling {
        self.refuse(&Refusal::unknown::<P>())
    }

    /// Answers with a refusal.
    pub fn refuse(self, refusal: &Refusal) -> Handling {
        self.peer.refuse(self.frame, refusal);
        Handling(None)
    }

    fn refuse_as_full(self) -> Handling {
        self.peer.refuse_as_full(self.frame);
        Handling(None)
    }

    /// Reads envelope and body in one pass and checks the time. Returns also the memory of the body's lists, in bytes.
    fn read<M: Message>(&self) -> Result<(Context<P>, M, usize), Refusal> {
        let settings = &self.peer.settings;
        let allowance = settings.limits.json();
        let (read, lists) = process_frame(self.pass.as_ref(), || {
            enveloped::<P::Request, M>(self.body, allowance)
        })
        .map_err(Self::invalid)?;
        let time_ms = read.envelope.time_ms();
        if let (Some(age), Some(time)) = (settings.max_age, time_ms)
            && u128::try_from(clock::unix_ms().saturating_sub(time))
                .is_ok_and(|old| old > age.as_millis())
        {
            return Err(P::RESULTS.expired.into());
        }
        let body = read.body.map_err(Self::invalid)?;
        let context = Context {
            time_ms,
            ..self.context()
        };
        Ok((context, body, lists))
    }

    #[allow(clippy::needless_pass_by_value, reason = "the argument of map_err")]
    fn invalid(error: BodyError) -> Refusal {
        Refusal::invalid::<P>(error)
    }

    fn span(&self, name: impl FnOnce() -> &'static str) -> Span {
        if !is_traced() {
            return Span::none();
        }
        tracing::debug_span!(
            "handle",
            protocol = P::NAME,
            name = name(),
            code = self.frame.code,
            msg_id = self.frame.id,
            connection = self.peer.id.0
        )
    }

    fn start<F>(
        self,
        future: Instrumented<F>,
        lists: usize,
        effect: fn(u16) -> Effect,
        answer: Answer<P, F::Output>,
    ) -> Handling
    where
        F: Future<Output: 'static> + Send + 'static,
    {
        drop(self.pass);
        let weight = self.body.len() + lists;
        let started = begin(self.peer, self.frame, future, answer, effect, self.waker);
        Handling(started.map(|handler| StartedHandler { handler, weight }))
    }
}

impl<P: Protocol> fmt::Debug for Request<'_, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Request({}, {} bytes)", self.frame, self.body.len())
    }
}
