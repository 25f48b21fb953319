//! The way of a request to its handler and back.

use super::answer::{effect, name};
use super::context::Context;
use super::gate::{Pass, through};
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

/// What serves requests. `#[dispatch]` writes it for a trait of handlers; by hand it is one `match`
/// on [`Request::code`].
pub trait Service<P: Protocol>: Send + Sync + 'static {
    /// Serves one request by one of its methods.
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

/// What has become of a request: answered, or in the hands of a handler that waits.
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

/// A request that has arrived. Its body still lies in the receive buffer.
#[must_use = "every request deserves an answer"]
pub struct Request<'a, P: Protocol> {
    pub(super) frame: FrameId,
    pub(super) body: &'a [u8],
    pub(super) peer: &'a Arc<Peer<P>>,
    pub(super) waker: &'a Waker,
    /// Leave to read it, if it is large. Given back before the handler is polled.
    pub(super) pass: Option<Pass>,
    /// When it arrived.
    pub(super) at: Instant,
}

impl<P: Protocol> Request<'_, P> {
    /// Command code.
    #[must_use]
    pub fn code(&self) -> u16 {
        self.frame.code
    }

    /// Message id.
    #[must_use]
    pub fn id(&self) -> u32 {
        self.frame.id
    }

    /// The whole JSON text, envelope included; not yet known to be JSON.
    #[must_use]
    pub fn body(&self) -> &[u8] {
        self.body
    }

    /// What a handler is told beside the request. The time is not known before the body is read.
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

    /// Reads the body as `C`, calls `handler` and answers with what it resolves to. A body that is
    /// not such a request is answered without calling it. A response that breaks a constraint of the spec
    /// is not sent: the app gets the protocol's own refusal, and the key is logged.
    ///
    /// A handler that panics is answered with the protocol's error result, counted and logged; nobody
    /// else notices. What it shares with others it has to leave whole itself.
    ///
    /// The handler is polled once at once; one that is ready then costs no wake-up. An app that closes
    /// its side, or sends bytes that are not a frame, ends nothing: its handlers finish and their
    /// responses are sent before the robot closes the connection.
    ///
    /// When a handler takes longer than the handler timeout, the app is answered with the result of
    /// a timeout, and its connection may break before that. From then on nobody waits for the answer.
    /// The handler of a command that sets something in motion, or of which nobody knows what it does,
    /// runs to its end all the same, in a task of its own, unless [`Context::abandoned`] tells it to
    /// stop; that of any other command is dropped. All are dropped when a shutdown's grace period is
    /// over. See [`ServerConfig::abandoned_handlers`](super::ServerConfig::abandoned_handlers) for
    /// how many may run on.
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

    /// The same for a response that many ask for, such as a map: it is encoded and digested once, by
    /// [`PreparedResponse::new`], and copied into each answer.
    ///
    /// A robot whose other commands are served by a trait puts a [`Service`] of one `match` in front
    /// of that.
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

    /// Reads the body as `C`, calls `handler` and has `answer` send what it resolves to.
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

    /// Calls `handler` with the body as it is and answers with the keys it resolves to, among them
    /// those of the envelope that it brings. A body that is not a JSON object is answered without calling it.
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

    /// Answers that there is no such command.
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

    /// Reads envelope and body in one pass, and looks at the time. Gives beside them what the lists of the
    /// body take, in bytes.
    fn read<M: Message>(&self) -> Result<(Context<P>, M, usize), Refusal> {
        let settings = &self.peer.settings;
        let allowance = settings.limits.json();
        let (read, lists) = through(self.pass.as_ref(), || {
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
