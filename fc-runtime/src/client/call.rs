//! A call: a future without a task.

use super::error::CallError;
use super::following::Following;
use super::loss::Loss;
use super::reports::Receiver;
use super::state::{Handle, Progress, State};
use super::state_watch::ConnectionState;
use crate::clock;
use crate::frame::{Body, FrameId, Staged};
use crate::json::Allowance;
use crate::message::{Message, read_enveloped, write_enveloped};
use crate::metrics::{Held, Since};
use crate::open_message::OpenMessage;
use crate::operation::{AckPolicy, Command, Effect, Report, SetsOff};
use crate::protocol::{Protocol, RequestEnvelope};
use crate::raw::RawResponse;
use crate::refusal::Refusal;
use crate::session::after;
use crate::sync::register;
use crate::trace::is_traced;
use std::fmt;
use std::pin::Pin;
use std::task::{Context, Poll};
use std::time::Duration;
use tracing::Span;

/// Maximum amount that a caller writes to the socket itself, in bytes.
const WRITTEN_AT_ONCE: usize = 32 * 1024;

/// Options of one call.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CallOptions {
    /// Longest wait for the response; `None` for the connection's default.
    pub timeout: Option<Duration>,
    /// `true` to send the call once more if the connection is lost before its response. After a second loss, the call
    /// ends with [`CallError::Lost`]. `None` repeats only commands with [`Effect::Read`]. `Some(true)` may execute
    /// other commands twice.
    pub repeat: Option<bool>,
}

/// The stage of a call.
#[derive(Clone, Copy, Debug)]
enum Stage {
    Start,
    InFlight { frame: FrameId, slot: usize },
    End,
}

/// The part of a call that does not depend on its type.
struct Flight<'a, P: Protocol> {
    inner: &'a Handle<P>,
    code: u16,
    timeout: Duration,
    repeat: bool,
    stage: Stage,
    span: Span,
    /// Start time, from the first poll until the end has been recorded.
    since: Option<(Since, Held)>,
}

type Write<'a> = &'a dyn Fn(&mut Vec<u8>);

impl<'a, P: Protocol> Flight<'a, P> {
    fn new(inner: &'a Handle<P>, code: u16, repeat: bool, options: CallOptions) -> Self {
        Self {
            inner,
            code,
            timeout: options.timeout.unwrap_or(inner.call_timeout),
            repeat: options.repeat.unwrap_or(repeat),
            stage: Stage::Start,
            span: Span::none(),
            since: None,
        }
    }

    /// Records result and duration.
    fn note(&mut self, result: &'static str) {
        if let Some((since, _held)) = self.since.take() {
            let operations = &self.inner.operations;
            operations.called(self.code, result);
            operations.took(self.code, since.elapsed());
        }
    }

    /// Continues the call. `write` appends the body, and is called again if the call is sent again.
    fn poll(
        &mut self,
        cx: &mut Context<'_>,
        name: &'static str,
        write: Write<'_>,
    ) -> Poll<Result<Body, CallError>> {
        let polled = match self.stage {
            Stage::Start => {
                self.since = Some((Since::now(), self.inner.flying.hold()));
                let inner = self.inner;
                let started = inner.staged(write, |body| self.start(cx, name, body));
                match started.map_err(CallError::from).and_then(|started| started) {
                    Ok(()) => Poll::Pending,
                    Err(error) => Poll::Ready(Err(error)),
                }
            }
            Stage::InFlight { frame, slot } => self.look(cx, frame, slot, write),
            Stage::End => Poll::Ready(Err(CallError::Closed(Loss::Ended))),
        };
        if polled.is_ready() {
            self.release();
        }
        polled
    }

    /// Frees the resources of a call in flight.
    fn release(&mut self) {
        if let Stage::InFlight { frame, slot } = self.stage {
            let mut state = self.inner.lock();
            state.session.cancel(frame);
            state.slots.free(slot);
        }
        self.stage = Stage::End;
    }

    fn start(
        &mut self,
        cx: &mut Context<'_>,
        name: &'static str,
        body: Staged<'_>,
    ) -> Result<(), CallError> {
        let policy = AckPolicy {
            timeout: self.timeout,
            retries: 0,
        };
        let now = clock::now();
        let mut guard = self.inner.lock();
        let state = &mut *guard;
        if let ConnectionState::Closed { why, .. } = state.connection.now() {
            return Err(CallError::Closed(why));
        }
        let slot = state.slots.take();
        let frame = match state.session.open(P::COMMAND, self.code, policy, now, slot) {
            Ok(frame) => frame,
            Err(busy) => {
                state.slots.free(slot);
                if let Some(held) = state.limiters.busy.admit(now) {
                    let (protocol, in_flight, held) = (P::NAME, busy.limit, held.shown());
                    let code = self.code;
                    tracing::warn!(protocol, name, code, in_flight, held, "too many calls");
                }
                return Err(busy.into());
            }
        };
        // From here on, dropping the call frees its resources.
        self.stage = Stage::InFlight { frame, slot };
        if let Some(slot) = state.slots.get(slot) {
            slot.repeat = self.repeat;
            slot.waker = Some(cx.waker().clone());
        }
        let mut socket = None;
        if state.connection.now().is_connected() {
            send(state, frame, body);
            if let Some(slot) = state.slots.get(slot) {
                slot.progress = Progress::Sent;
            }
            // With several callers, the driver sends all requests with one write. A caller whose response has just
            // arrived counts, because it will probably call again.
            if state.slots.used() == 1 && state.out.len() <= WRITTEN_AT_ONCE {
                socket.clone_from(&state.socket);
            }
        }
        let writing = (socket.as_ref()).and_then(|socket| socket.begin(&mut state.out));
        // Needed also without a connection, because the deadline may be earlier than all others.
        let deadline = after(now, self.timeout);
        let needed = writing.is_none() || state.alarm.is_none_or(|at| deadline < at);
        let driver = if needed { state.driver.take() } else { None };
        drop(guard);
        let written = writing.is_none_or(|writing| writing.finish(cx));
        if let Some(driver) = driver {
            driver.wake();
        } else if !written {
            self.inner.wake();
        }
        if is_traced() {
            self.span = tracing::debug_span!(
                "call",
                protocol = P::NAME,
                name,
                code = self.code,
                msg_id = frame.id
            );
        }
        Ok(())
    }

    fn look(
        &mut self,
        cx: &mut Context<'_>,
        frame: FrameId,
        slot: usize,
        write: Write<'_>,
    ) -> Poll<Result<Body, CallError>> {
        let mut guard = self.inner.lock();
        let state = &mut *guard;
        let now = state.connection.now();
        let Some(place) = state.slots.get(slot) else {
            return Poll::Ready(Err(CallError::Closed(now.why().unwrap_or(Loss::Ended))));
        };
        match place.progress {
            Progress::Done(_) => {
                self.stage = Stage::End;
                if let Progress::Done(result) = state.slots.free(slot) {
                    return Poll::Ready(result);
                }
            }
            Progress::Unsent | Progress::Again | Progress::Sent => {
                register(&mut place.waker, cx);
                if place.progress.is_to_send() && now.is_connected() {
                    drop(guard);
                    self.inner
                        .staged(write, |body| self.send_again(frame, slot, body))?;
                }
            }
        }
        Poll::Pending
    }

    /// Sends a request that has waited for a connection. If the connection is lost again, the request waits for the
    /// next one.
    fn send_again(&self, frame: FrameId, slot: usize, body: Staged<'_>) {
        let mut guard = self.inner.lock();
        let state = &mut *guard;
        let connected = state.connection.now().is_connected();
        let Some(place) = state.slots.get(slot) else {
            return;
        };
        if !connected || !place.progress.is_to_send() {
            return;
        }
        // Only one repetition, however often the connection is lost.
        place.repeat &= matches!(place.progress, Progress::Unsent);
        place.progress = Progress::Sent;
        send(state, frame, body);
        drop(guard);
        self.inner.wake();
    }

    /// Returns the memory of a large body for the next one.
    fn recycle(&self, body: Body) {
        if let Some(spare) = body.into_spare() {
            self.inner.lock().spare = spare;
        }
    }
}

fn send<P: Protocol>(state: &mut State<P>, frame: FrameId, body: Staged<'_>) {
    let before = state.out.len();
    body.append::<P>(&mut state.out, frame);
    state.counters.bytes_out += (state.out.len() - before) as u64;
}

impl<P: Protocol> Drop for Flight<'_, P> {
    fn drop(&mut self) {
        self.release();
        self.note("dropped");
    }
}

/// A call of a typed command. Resolves to the response.
///
/// The request is encoded when the future is first polled, directly into the connection's buffer.
///
/// Cancellation safe: dropping the future frees the call's resources, and a later response is ignored. A sent command
/// is executed nevertheless.
#[must_use = "a call is sent when it is awaited"]
pub struct Call<'a, P: Protocol, C: Command> {
    flight: Flight<'a, P>,
    request: &'a C,
}

impl<'a, P: Protocol, C: Command> Call<'a, P, C> {
    pub(super) fn new(handle: &'a Handle<P>, request: &'a C, options: CallOptions) -> Self {
        let repeat = C::EFFECT == Effect::Read;
        Self {
            flight: Flight::new(handle, C::CODE, repeat, options),
            request,
        }
    }

    /// Sets the options of this call: its timeout, and whether it is sent again after a loss.
    pub fn with_options(self, options: CallOptions) -> Self {
        Self::new(self.flight.inner, self.request, options)
    }

    /// Waits for the response, and then follows the reports `R` that the command sets off, until a report with a final
    /// state or a failure.
    ///
    /// Reports are followed from the moment the request is sent, also before the response.
    ///
    /// Cancellation safe, like the call.
    ///
    /// # Errors
    ///
    /// The errors of the call. In that case no reports are followed.
    pub async fn follow<R: Report>(self) -> Result<Following<P, C, R>, CallError>
    where
        C: SetsOff<R>,
    {
        let request = self.request;
        let receiver = Receiver::new(self.flight.inner.clone(), Some(R::CODE));
        let answer = self.await?;
        Ok(Following::new(receiver, request.clone(), answer))
    }
}

impl<P: Protocol, C: Command> Future for Call<'_, P, C> {
    type Output = Result<C::Response, CallError>;

    fn poll(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Self::Output> {
        let this = self.get_mut();
        let request = this.request;
        if matches!(this.flight.stage, Stage::Start) {
            request.check().map_err(CallError::Invalid)?;
        }
        let write =
            |out: &mut Vec<u8>| write_enveloped(&P::Request::at(clock::unix_ms()), request, out);
        let polled = this.flight.poll(cx, C::NAME, &write);
        let Poll::Ready(result) = polled else {
            return Poll::Pending;
        };
        let _entered = std::mem::replace(&mut this.flight.span, Span::none()).entered();
        let result = result.and_then(|body| {
            let read = response::<P, C::Response>(&body, this.flight.inner.limits.json());
            this.flight.recycle(body);
            read
        });
        match &result {
            Ok(_) => tracing::debug!("answered"),
            Err(error) => tracing::debug!(error = error.name(), "failed"),
        }
        this.flight.note(ended(&result));
        Poll::Ready(result)
    }
}

/// Reads a body as a typed response in one pass.
fn response<P: Protocol, M: Message>(body: &[u8], allowance: Allowance) -> Result<M, CallError> {
    let read = read_enveloped::<P::Response, M>(body, allowance).map_err(CallError::Response)?;
    match Refusal::of::<P>(&read.envelope) {
        None => read.body.map_err(CallError::Response),
        Some(refusal) => Err(CallError::Refused(refusal)),
    }
}

impl<P: Protocol, C: Command> fmt::Debug for Call<'_, P, C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Call")
            .field("name", &C::NAME)
            .field("stage", &self.flight.stage)
            .finish_non_exhaustive()
    }
}

/// Calls `code` with a JSON object of the request's keys. The envelope is added if `body` has none.
pub(super) async fn raw<P: Protocol>(
    handle: &Handle<P>,
    code: u16,
    body: &[u8],
    options: CallOptions,
) -> Result<RawResponse<P>, CallError> {
    let allowance = handle.limits.json();
    let request =
        read_enveloped::<P::Request, OpenMessage>(body, allowance).map_err(CallError::Invalid)?;
    let keys = request.body.map_err(CallError::Invalid)?;
    let envelope = request.envelope;
    let write = |out: &mut Vec<u8>| {
        if envelope.time_ms().is_some() {
            write_enveloped(&envelope, &keys, out);
        } else {
            write_enveloped(&P::Request::at(clock::unix_ms()), &keys, out);
        }
    };
    let mut flight = Flight::new(handle, code, false, options);
    let body = std::future::poll_fn(|cx| flight.poll(cx, "raw", &write)).await;
    let response: Result<RawResponse<P>, CallError> = body.and_then(|body| {
        let read = read_enveloped::<P::Response, OpenMessage>(&body, allowance)
            .map_err(CallError::Response)?;
        Ok(RawResponse {
            envelope: read.envelope,
            text: body.into_vec(),
        })
    });
    flight.note(match &response {
        Ok(response) if Refusal::of::<P>(&response.envelope).is_some() => "refused",
        other => ended(other),
    });
    response
}

/// Returns the result of a call, for metrics.
fn ended<T>(result: &Result<T, CallError>) -> &'static str {
    match result {
        Ok(_) => "success",
        Err(error) => error.name(),
    }
}
