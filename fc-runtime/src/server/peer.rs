//! One app's connection, as far as driver, handlers and pushes share it.

use super::abandoned::Abandoned;
use super::allow::Effects;
use super::budget::{Account, Holder, NO_MEMORY};
use super::config::Settings;
use super::connection_id::ConnectionId;
use super::counters::{Answered, Counting};
use super::push::{AckOutcome, Queued};
use crate::clock;
use crate::frame::{Encoder, FrameError, FrameId, Kept, Unsealed};
use crate::json::{BodyError, Json, decode, to_vec};
use crate::keys::Keys;
use crate::message::{Empty, Message, read_enveloped, write_enveloped};
use crate::protocol::{DigestOf, Effect, OperationInfo, Protocol, ResponseEnvelope, ResultText};
use crate::raw::Refusal;
use crate::session::Session;
use std::collections::VecDeque;
use std::future::poll_fn;
use std::net::SocketAddr;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::pin::pin;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::task::{Poll, Waker};
use tokio::sync::Notify;

/// What is to be sent. Only the driver's task locks it: nobody waits while a large answer is encoded.
pub(super) struct Output<P: Protocol> {
    /// Frames to be written.
    pub(super) out: Vec<u8>,
    pub(super) encoder: Encoder<P>,
    /// Long frames in `out` that are not digested yet, in their order.
    unsealed: VecDeque<Unsealed<P>>,
    /// The envelope of success as of a certain millisecond: many answers share one.
    success: Option<(i64, P::Response)>,
}

impl<P: Protocol> Output<P> {
    /// Appends a frame; a long one is digested bit by bit.
    fn append<E: Message, B: Message>(
        &mut self,
        id: FrameId,
        envelope: &E,
        body: &B,
    ) -> Result<(), FrameError> {
        let write = |out: &mut Vec<u8>| write_enveloped(envelope, body, out);
        let unsealed = self.encoder.unsealed(&mut self.out, id, write)?;
        self.unsealed.extend(unsealed);
        Ok(())
    }

    /// Digests at most so many bytes more of what is long, and gives how many it were.
    pub(super) fn seal(&mut self, most: usize) -> usize {
        let mut done = 0;
        while let Some(first) = self.unsealed.front_mut() {
            done += first.go_on(&self.out, most - done);
            if !first.is_digested() {
                break;
            }
            if let Some(first) = self.unsealed.pop_front() {
                first.seal(&mut self.out);
            }
        }
        done
    }

    /// Whether all of it may be sent.
    pub(super) fn is_sealed(&self) -> bool {
        self.unsealed.is_empty()
    }
}

/// What pushers and the driver share.
pub(super) struct PeerState<P: Protocol> {
    /// Reports in flight.
    pub(super) session: Session<P, Queued>,
    /// Reports not yet sent, oldest first.
    pub(super) queue: VecDeque<Queued>,
    /// The driver's, while it waits for something to do.
    pub(super) driver: Option<Waker>,
}

/// The envelope of success.
fn success<P: Protocol>(now: i64) -> P::Response {
    let success = P::RESULTS.success;
    P::Response::at(now, success.code, success.text)
}

pub(super) struct Peer<P: Protocol> {
    pub(super) id: ConnectionId,
    pub(super) address: SocketAddr,
    /// What may be called from there.
    effects: Effects,
    pub(super) settings: Arc<Settings>,
    pub(super) counters: Arc<Counting>,
    pub(super) abandoned: Arc<Abandoned>,
    pub(super) account: Account,
    output: Mutex<Output<P>>,
    state: Mutex<PeerState<P>>,
    unsent: AtomicUsize,
    unusable: AtomicU32,
    draining: AtomicBool,
    /// Something has been received.
    heard: AtomicBool,
    /// It has given way, for this reason.
    evicted: OnceLock<&'static str>,
    /// What is not needed is to be given back.
    untidy: AtomicBool,
    /// Set under the lock: nothing can be sent any more.
    gone: AtomicBool,
    going: Notify,
}

impl<P: Protocol> Peer<P> {
    pub(super) fn new(
        id: ConnectionId,
        address: SocketAddr,
        effects: Effects,
        settings: Arc<Settings>,
        counters: Arc<Counting>,
        abandoned: Arc<Abandoned>,
        account: Account,
    ) -> Self {
        let session = Session::new(&settings.limits, P::DEFAULTS.ack, settings.first_id());
        Self {
            id,
            address,
            effects,
            account,
            output: Mutex::new(Output {
                out: Vec::new(),
                encoder: settings.encoder(),
                unsealed: VecDeque::new(),
                success: None,
            }),
            state: Mutex::new(PeerState {
                session,
                queue: VecDeque::new(),
                driver: None,
            }),
            unsent: AtomicUsize::new(0),
            unusable: AtomicU32::new(0),
            draining: AtomicBool::new(false),
            heard: AtomicBool::new(false),
            evicted: OnceLock::new(),
            untidy: AtomicBool::new(false),
            gone: AtomicBool::new(false),
            going: Notify::new(),
            settings,
            counters,
            abandoned,
        }
    }

    /// Bytes gathered to be sent, as of the last answer.
    pub(super) fn unsent(&self) -> usize {
        self.unsent.load(Ordering::Relaxed)
    }

    /// Notes how much `output` holds now.
    pub(super) fn note(&self, output: &Output<P>) {
        self.unsent.store(output.out.len(), Ordering::Relaxed);
    }

    /// Notes a frame that nobody can make use of.
    pub(super) fn unusable(&self) {
        self.unusable.fetch_add(1, Ordering::Relaxed);
    }

    /// How many of these there have been since this was last asked.
    pub(super) fn take_unusable(&self) -> u32 {
        // Mostly there are none, and looking is cheaper than taking.
        match self.unusable.load(Ordering::Relaxed) {
            0 => 0,
            _ => self.unusable.swap(0, Ordering::Relaxed),
        }
    }

    /// Whether no more requests are read, while those being handled are answered still.
    pub(super) fn is_draining(&self) -> bool {
        self.draining.load(Ordering::Acquire)
    }

    /// Lets the connection end once everything is answered.
    pub(super) fn drain(&self) {
        self.draining.store(true, Ordering::Release);
        self.wake();
    }

    /// Notes that something has been received.
    pub(super) fn hear(&self) {
        self.heard.store(true, Ordering::Relaxed);
    }

    /// Whether anything has been received.
    pub(super) fn is_heard(&self) -> bool {
        self.heard.load(Ordering::Relaxed)
    }

    /// Why the connection has to go, if it has.
    pub(super) fn evicted(&self) -> Option<&'static str> {
        self.evicted.get().copied()
    }

    /// Lets the connection end at once. The first reason counts.
    pub(super) fn give_way(&self, reason: &'static str) {
        let _ = self.evicted.set(reason);
        self.wake();
    }

    /// Whether memory is to be given back that is not needed.
    pub(super) fn take_untidy(&self) -> bool {
        self.untidy.load(Ordering::Relaxed) && self.untidy.swap(false, Ordering::Relaxed)
    }

    /// Resolves once the connection has to go before it has come to its first frame: another has taken
    /// its place, or the server ends.
    pub(super) async fn sent_away(&self) {
        poll_fn(|cx| {
            let mut state = self.lock();
            // Under the lock: who sends it away wakes afterwards.
            if self.evicted().is_some() || self.is_draining() {
                return Poll::Ready(());
            }
            state.driver = Some(cx.waker().clone());
            Poll::Pending
        })
        .await;
    }

    /// Queues a report. If the queue is full or memory is short, the oldest reports in it give way;
    /// where all the room is taken by reports in flight, the new one is dropped.
    pub(super) fn push(&self, mut report: Queued) {
        let (driver, dropped) = {
            let mut state = self.lock();
            if self.is_gone() {
                // A handler may hold on to the connection; nothing may wait in it.
                drop(state);
                return;
            }
            let mut dropped = Vec::new();
            loop {
                if state.queue.len() < self.settings.limits.queued_reports
                    && self.charge(&mut report)
                {
                    state.queue.push_back(report);
                    break;
                }
                let Some(mut oldest) = state.queue.pop_front() else {
                    dropped.push(report);
                    break;
                };
                oldest.charge = None;
                dropped.push(oldest);
            }
            (state.driver.take(), dropped)
        };
        for dropped in dropped {
            self.counters.reports_dropped.one();
            if let Some(held) = self.counters.lines.dropped.line() {
                let (protocol, connection, code) = (P::NAME, self.id.0, dropped.code);
                let (peer, held) = (self.address, held.shown());
                tracing::warn!(protocol, connection, %peer, code, held, "report dropped: the app is slow");
            }
            dropped.end(AckOutcome::Dropped);
        }
        if let Some(driver) = driver {
            driver.wake();
        }
    }

    /// Charges a report to the app, if there is room for it.
    fn charge(&self, report: &mut Queued) -> bool {
        let bytes = report.body.len();
        if self.account.queued().saturating_add(bytes) <= self.settings.queued_bytes {
            report.charge = self.account.queue(bytes);
        }
        report.charge.is_some()
    }

    /// Ends all reports, because the connection has ended, and keeps nothing for it.
    pub(super) fn end(&self) {
        let (queue, in_flight) = {
            let mut state = self.lock();
            self.gone.store(true, Ordering::Release);
            let in_flight = state.session.end_if(|_, _| true);
            (std::mem::take(&mut state.queue), in_flight)
        };
        {
            let mut output = self.output();
            output.out = Vec::new();
            output.unsealed.clear();
            output.encoder = self.settings.encoder();
        }
        // Dropped outside the lock: each wakes whoever waits for it.
        drop((queue, in_flight));
        self.going.notify_waiters();
    }

    /// Whether the connection has ended.
    pub(super) fn is_gone(&self) -> bool {
        self.gone.load(Ordering::Acquire)
    }

    /// Resolves once the connection has ended.
    pub(super) async fn gone(&self) {
        let mut going = pin!(self.going.notified());
        // From here on it is heard; what was before is seen.
        going.as_mut().enable();
        if !self.is_gone() {
            going.await;
        }
    }

    /// Nothing is left half done when the lock is given back, not even by a panic: the encoder takes
    /// back what it has begun. So poison means nothing.
    pub(super) fn output(&self) -> MutexGuard<'_, Output<P>> {
        self.output.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Poison means nothing here either.
    pub(super) fn lock(&self) -> MutexGuard<'_, PeerState<P>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Wakes the driver.
    pub(super) fn wake(&self) {
        let driver = self.lock().driver.take();
        if let Some(driver) = driver {
            driver.wake();
        }
    }

    /// Answers with success and a response; with a refusal if the response breaks a constraint of the
    /// spec, which is the handler's fault and not the app's.
    pub(super) fn answer<M: Message>(&self, request: FrameId, response: &M) {
        if let Err(error) = response.check() {
            return self.no_response(request, &error);
        }
        self.succeed(request, |output, envelope| {
            output.append(request.answer(), envelope, response)
        });
    }

    /// Answers with success and a response that has been checked and encoded before.
    pub(super) fn answer_kept(&self, request: FrameId, response: &Kept<DigestOf<P>>) {
        self.succeed(request, |output, envelope| {
            let (encoder, out) = (&mut output.encoder, &mut output.out);
            encoder.kept(out, request.answer(), envelope, response)
        });
    }

    /// Answers with what `write` makes of the envelope of success.
    fn succeed(
        &self,
        request: FrameId,
        write: impl FnOnce(&mut Output<P>, &P::Response) -> Result<(), FrameError>,
    ) {
        let now = clock::unix_ms();
        let written = {
            let mut output = self.output();
            // A panic while it is out costs no more than this envelope.
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

    /// Answers with an object that was made elsewhere. The envelope of success supplies the keys of the
    /// envelope that it lacks.
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

    /// What an answer lacks of the envelope, its keys, and whether both together say that all went well.
    fn completed(&self, text: &Json) -> Result<(Keys, Keys, bool), BodyError> {
        let allowance = self.settings.limits.json();
        let keys = decode::<Keys>(text.as_str().as_bytes(), allowance)?;
        let success = to_vec(&success::<P>(clock::unix_ms()));
        let missing = decode::<Keys>(&success, allowance)?.without(&keys);
        let mut whole = Vec::with_capacity(text.as_str().len());
        write_enveloped(&missing, &keys, &mut whole);
        let read = read_enveloped::<P::Response, Empty>(&whole, allowance)?;
        Ok((missing, keys, Refusal::of::<P>(&read.envelope).is_none()))
    }

    /// What the handler has made is no response. Its values are not logged, as no text of a body is.
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

    /// The response does not fit into a frame.
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

    /// Answers with a result alone; not at all where no response can carry one.
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
        // Its text may quote the body: the code alone is logged.
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

    /// Runs the user's code for a request. `None` if it has panicked: that is counted and logged,
    /// but not what the panic says, which may quote the body.
    pub(super) fn guard<T>(&self, request: FrameId, code: impl FnOnce() -> T) -> Option<T> {
        // What is ours is left whole, see `lock`; what is the user's he has to look after himself.
        if let Ok(done) = catch_unwind(AssertUnwindSafe(code)) {
            return Some(done);
        }
        let (protocol, connection) = (P::NAME, self.id.0);
        let (name, code, msg_id) = (name::<P>(request.code), request.code, request.id);
        if self.counters.handlers_panicked.one_to_log() {
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

    /// Counts a request for a command of the spec that this robot does not implement, and says so.
    pub(super) fn note_not_implemented(&self, code: u16) {
        if self.counters.calls_not_implemented.one_to_log() {
            let (protocol, connection, name) = (P::NAME, self.id.0, name::<P>(code));
            tracing::warn!(protocol, connection, name, code, "not implemented");
        }
    }

    /// Refuses a request whose handler has panicked.
    pub(super) fn refuse_after_panic(&self, request: FrameId) {
        self.refuse(request, &Refusal::panicked::<P>());
    }

    /// Whether a command may be called from the app's address.
    pub(super) fn may_call(&self, code: u16) -> bool {
        self.effects == Effects::ALL || self.effects.has(effect::<P>(code))
    }

    /// Refuses a request that may not be made from the app's address.
    pub(super) fn refuse_as_forbidden(&self, request: FrameId) {
        self.counters.calls_forbidden.one();
        if let Some(held) = self.counters.lines.forbidden_calls.line() {
            let (protocol, connection, peer) = (P::NAME, self.id.0, self.address);
            let (name, code) = (name::<P>(request.code), request.code);
            let (effect, held) = (effect::<P>(code), held.shown());
            tracing::warn!(protocol, connection, %peer, name, code, ?effect, held, "refused: not allowed from this address");
        }
        self.refuse(request, &Refusal::forbidden::<P>());
    }

    /// Refuses a request that is not begun because too many handlers run on.
    pub(super) fn refuse_as_full(&self, request: FrameId) {
        let limit = self.settings.abandoned_handlers;
        if self.counters.abandoned_reached.one_to_log() {
            let (protocol, connection, code) = (P::NAME, self.id.0, request.code);
            tracing::warn!(
                protocol,
                connection,
                code,
                limit,
                "too many abandoned handlers"
            );
        }
        self.refuse(request, &Refusal::too_many::<P>());
    }

    /// Answers with one of the protocol's own results.
    pub(super) fn refuse_with(&self, request: FrameId, result: ResultText) {
        self.refuse(request, &result.into());
    }
}

impl<P: Protocol> Holder for Peer<P> {
    fn tidy(&self) {
        self.untidy.store(true, Ordering::Relaxed);
        self.wake();
    }

    fn evict(&self, held: usize) {
        self.counters
            .evicted::<P>(self.id, self.address, "command", held);
        self.give_way(NO_MEMORY);
    }
}

/// What the spec says of a command code.
fn operation<P: Protocol>(code: u16) -> Option<&'static OperationInfo> {
    P::operations()
        .iter()
        .find(|operation| operation.code == Some(code))
}

/// The spec's name for a command code.
pub(super) fn name<P: Protocol>(code: u16) -> &'static str {
    operation::<P>(code).map_or("unknown", |operation| operation.name)
}

/// What a command does according to the spec.
pub(super) fn effect<P: Protocol>(code: u16) -> Effect {
    let effect = operation::<P>(code).and_then(|operation| operation.effect);
    effect.unwrap_or(Effect::Unknown)
}
