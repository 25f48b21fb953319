//! The one task of a command connection: it alone touches the socket.
//!
//! Each time it is woken it goes on with waiting handlers, reads all there is, handles it in place,
//! takes up reports and answers, and sends all of it with one write. An app that does not read its
//! answers is not read either.

use super::context::ConnectionId;
use super::gate::{Gate, LARGE};
use super::pace::{Pace, inflated};
use super::peer::{Peer, PeerState};
use super::push::AckOutcome;
use super::service::{Request, Service};
use super::work::Waiting;
use crate::clock;
use crate::json::Allowance;
use crate::link::{CLOSING, Link, Transport};
use crate::message::{Empty, read_enveloped};
use crate::protocol::{AckPolicy, Protocol, ResponseEnvelope};
use crate::rate::Flow;
use crate::raw::Refusal;
use crate::session::{Due, Incoming, after};
use crate::thin::Thin;
use futures_util::stream::{FuturesUnordered, StreamExt};
use std::pin::{Pin, pin};
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};
use tokio::time::{Sleep, sleep, timeout};

/// Beyond this much unsent, in bytes, nothing is read or taken up.
const HIGH_WATER: usize = 256 * 1024;

/// What a connection may do in one turn before the others have theirs, in bytes received and
/// answered: some sixty small requests.
const TURN: usize = 160 * 1024;

/// After so many requests their answers are sent, though more requests are at hand: the app then
/// works on the ones while the robot works on the others.
const SLICE: usize = 32;

/// What the work on a frame counts beside its bytes.
pub(super) const FRAME: usize = 2 * 1024;

/// Why a connection has ended, for the log.
type Reason = &'static str;

/// Nothing can be sent any more either.
const BROKEN: Reason = "the connection broke";
const HEADER_LATE: Reason = "a header did not come in time";
const STALLED: Reason = "a frame stalled";

/// Why nothing more can be received.
enum End {
    /// Answers cannot be sent either.
    Broken,
    /// Answers can still be sent: the app has closed its half, or what it sends cannot be told into
    /// frames.
    Deaf(Reason),
}

pub(super) struct Driver<S, P: Protocol> {
    link: Link<S, P>,
    peer: Arc<Peer<P>>,
    service: Arc<dyn Service<P>>,
    waiting: FuturesUnordered<Waiting<P>>,
    /// A handler is waiting that has not been polled in its place.
    fresh: bool,
    /// What is left of the turn.
    turn: usize,
    gate: Gate,
    /// Another connection's large frame comes first.
    gated: bool,
    pace: Pace,
    /// What is logged of frames that could not be read, of the limit in flight, and of rests.
    bad_frames: Thin,
    in_flight: Thin,
    rests: Thin,
    /// Nothing more is read before this.
    rest_until: Option<Instant>,
    /// Why nothing more is read at all. What has been carried out is answered all the same.
    deaf: Option<Reason>,
    watch: Watch,
    timer: Pin<Box<Sleep>>,
    /// What the timer is set to.
    armed: Option<Instant>,
}

/// When something last happened on the connection.
struct Watch {
    /// The first byte of a header that is not whole yet.
    header: Option<Instant>,
    /// Of the frame that has begun to arrive, while it is read.
    read: Flow,
    reading: bool,
    /// Of what is to be sent.
    written: Flow,
    frame: Instant,
}

impl<S: Transport, P: Protocol> Driver<S, P> {
    pub(super) fn new(
        stream: S,
        peer: Arc<Peer<P>>,
        service: Arc<dyn Service<P>>,
        gate: Gate,
    ) -> Self {
        let now = clock::now();
        Self {
            link: Link::new(stream, peer.settings.decoder()),
            peer,
            service,
            waiting: FuturesUnordered::new(),
            fresh: false,
            turn: TURN,
            gate,
            gated: false,
            pace: Pace::default(),
            bad_frames: Thin::default(),
            in_flight: Thin::default(),
            rests: Thin::default(),
            rest_until: None,
            deaf: None,
            watch: Watch {
                header: None,
                read: Flow::new(now),
                reading: false,
                written: Flow::new(now),
                frame: now,
            },
            timer: Box::pin(sleep(Duration::ZERO)),
            armed: None,
        }
    }

    /// Serves the connection until it ends.
    pub(super) async fn run(mut self) {
        let peer = Arc::clone(&self.peer);
        peer.counters
            .connected::<P>(peer.id, peer.address, "command");
        let reason = std::future::poll_fn(|cx| self.poll(cx)).await;
        peer.counters
            .ended::<P>(peer.id, peer.address, "command", reason);
        self.leave();
        if !peer.is_displaced() {
            // A peer that does not read, or does not stop sending, does not keep us.
            let _ = timeout(CLOSING, self.link.goodbye()).await;
        }
    }

    fn poll(&mut self, cx: &mut Context<'_>) -> Poll<Reason> {
        if self.peer.is_displaced() {
            return Poll::Ready("another has taken its place");
        }
        let now = clock::now();
        self.turn = TURN;
        self.rest_until = self.rest_until.filter(|until| *until > now);
        loop {
            while self.turn > 0 && self.has_room() {
                let before = self.peer.unsent();
                if !matches!(self.waiting.poll_next_unpin(cx), Poll::Ready(Some(()))) {
                    break;
                }
                self.charge(before);
            }
            let mut more = false;
            if !self.peer.is_draining() && self.deaf.is_none() {
                match self.receive(cx, now) {
                    Ok(read) => more = read,
                    Err(End::Broken) => return Poll::Ready(BROKEN),
                    Err(End::Deaf(reason)) => self.deaf = Some(reason),
                }
            }
            more |= std::mem::take(&mut self.fresh);
            let (loaded, due) = self.tend(cx, now);
            more |= loaded;
            let before = self.link.unwritten();
            let write = self.link.poll_write(cx);
            let written = before.saturating_sub(self.link.unwritten());
            self.watch
                .written
                .add(written, self.peer.settings.stall.bytes, now);
            match write {
                Poll::Ready(Ok(())) if more => {}
                Poll::Ready(Ok(())) if self.is_drained() => {
                    return Poll::Ready(self.deaf.unwrap_or("drained"));
                }
                Poll::Ready(Ok(())) => {}
                Poll::Ready(Err(_)) => return Poll::Ready(BROKEN),
                Poll::Pending => more = false,
            }
            if !more {
                if self.turn == 0 {
                    // There may be more to handle; first it is the others' turn. Unlike waking oneself,
                    // yielding lets the runtime look for what has arrived at other sockets.
                    let _ = pin!(tokio::task::yield_now()).poll(cx);
                }
                return self.arm(cx, now, due);
            }
        }
    }

    /// Whether an answer more may be written.
    fn has_room(&self) -> bool {
        self.link.unwritten() + self.peer.unsent() < HIGH_WATER
    }

    /// Counts what has been answered since as much as `before` was unsent.
    fn charge(&mut self, before: usize) {
        let answered = self.peer.unsent().saturating_sub(before);
        self.turn = self.turn.saturating_sub(answered);
    }

    /// Whether all that has been carried out is answered, and nothing more is to come.
    fn is_drained(&self) -> bool {
        (self.peer.is_draining() || self.deaf.is_some())
            && self.peer.unsent() == 0
            && self.waiting.is_empty()
    }

    /// Handles what has been received and reads on until nothing more is there, nothing more may be
    /// taken or a slice has been handled. `Ok(true)` if there may be more to come at once.
    fn receive(&mut self, cx: &mut Context<'_>, now: Instant) -> Result<bool, End> {
        let mut slice = SLICE;
        loop {
            while self.has_room() {
                if self.waiting.len() >= self.peer.settings.limits.in_flight {
                    self.peer.counters.in_flight_reached.one();
                    self.full(now);
                    return Ok(false);
                }
                if self.turn == 0 || self.rest_until.is_some() {
                    return Ok(false);
                }
                let before = self.peer.unsent();
                let taken = if self.link.decoder.is_work(LARGE) {
                    let Poll::Ready(pass) = self.gate.poll_pass(cx) else {
                        self.gated = true;
                        return Ok(false);
                    };
                    pass.through(|| self.take(cx, now))?
                } else {
                    self.take(cx, now)?
                };
                self.gated = false;
                self.charge(before);
                let surplus = self.link.decoder.take_surplus();
                if surplus > 0 {
                    self.link.decoder.release();
                    self.rest(inflated(surplus));
                }
                let unusable = self.peer.take_unusable();
                if unusable > 0 {
                    let owed = self.pace.unusable(unusable, now);
                    self.rest(owed);
                }
                if !taken {
                    break;
                }
                slice -= 1;
                if slice == 0 {
                    return Ok(true);
                }
            }
            if !self.has_room() {
                // The answers have to go out first.
                return Ok(true);
            }
            let begins = self.link.decoder.pending() == 0;
            match self.link.poll_read(cx) {
                Poll::Pending => return Ok(false),
                Poll::Ready(Ok(0)) => {
                    let inside = self.link.decoder.finish().is_err();
                    return Err(End::Deaf(if inside {
                        "closed inside a frame"
                    } else {
                        "closed by the app"
                    }));
                }
                Poll::Ready(Ok(n)) => {
                    self.peer.hear();
                    if begins {
                        self.watch.read = Flow::new(now);
                    } else {
                        let least = self.peer.settings.stall.bytes;
                        self.watch.read.add(n, least, now);
                    }
                    self.peer.counters.bytes_in.add(n);
                }
                Poll::Ready(Err(_)) => return Err(End::Broken),
            }
        }
    }

    /// Logs that as many handlers are at work as may be.
    fn full(&mut self, now: Instant) {
        if let Some(held) = self.in_flight.line(now) {
            let (protocol, held) = (P::NAME, held.shown());
            let (connection, peer) = (self.peer.id.0, self.peer.address);
            let in_flight = self.peer.settings.limits.in_flight;
            tracing::info!(protocol, connection, %peer, in_flight, held, "not read: too many requests");
        }
    }

    /// Reads nothing for so long.
    fn rest(&mut self, time: Duration) {
        if !time.is_zero() {
            let until = after(clock::now(), time);
            self.rest_until = self.rest_until.max(Some(until));
            self.peer.counters.connections_paced.one();
            if let Some(held) = self.rests.line(clock::now()) {
                let (protocol, held) = (P::NAME, held.shown());
                let (connection, peer) = (self.peer.id.0, self.peer.address);
                tracing::info!(protocol, connection, %peer, held, "not read for {time:?}: useless work");
            }
        }
    }

    /// Handles the next frame; `Ok(false)` if there is none yet.
    fn take(&mut self, cx: &mut Context<'_>, now: Instant) -> Result<bool, End> {
        let peer = &self.peer;
        let frame = match self.link.decoder.next() {
            Ok(Some(frame)) => {
                self.turn = self.turn.saturating_sub(FRAME + frame.body().len());
                frame
            }
            Ok(None) => {
                let inside = self.link.decoder.inside_header();
                self.watch.header = inside.then(|| self.watch.header.unwrap_or(now));
                return Ok(false);
            }
            Err(error) => {
                self.turn = self.turn.saturating_sub(FRAME);
                let counters = &peer.counters;
                let whose = (peer.id, peer.address);
                counters.bad_frame::<P>(&mut self.bad_frames, whose, error.name(), &error);
                let id = error.frame().ok_or(End::Deaf(error.name()))?;
                if id.response {
                    peer.unusable();
                } else {
                    peer.refuse_with(id, P::RESULTS.protocol);
                }
                return Ok(true);
            }
        };
        self.watch.header = None;
        self.watch.read = Flow::new(now);
        self.watch.frame = now;
        let id = frame.id();
        let incoming = if id.response || id.kind != P::COMMAND {
            let mut state = peer.lock();
            let incoming = state.session.receive(id, now);
            if let Incoming::Answer(queued) = &incoming {
                state.report_bytes -= queued.body.len();
            }
            incoming
        } else {
            Incoming::Command
        };
        match incoming {
            Incoming::Command if !peer.may_call(id.code) => peer.refuse_as_forbidden(id),
            Incoming::Command => {
                let request = Request {
                    frame: id,
                    body: frame.body(),
                    peer,
                    waker: cx.waker(),
                    at: now,
                };
                let service = &self.service;
                let Some(handling) = peer.guard(id, || service.call(request)) else {
                    peer.refuse_after_panic(id);
                    return Ok(true);
                };
                if let Some(work) = handling.0 {
                    let deadline = after(now, peer.settings.handler_timeout);
                    let waiting = Waiting::new(work, id, Arc::clone(peer), deadline);
                    self.waiting.push(waiting);
                    self.fresh = true;
                }
            }
            Incoming::Answer(queued) => {
                let allowance = peer.settings.limits.json();
                let outcome = acknowledged::<P>(frame.body(), allowance);
                match outcome {
                    AckOutcome::Acknowledged => peer.counters.reports_acknowledged.one(),
                    _ => peer.counters.reports_refused.one(),
                }
                queued.end(outcome);
            }
            Incoming::Late => peer.unusable(),
            // Robots take no reports, and streams have a port of their own.
            Incoming::Report | Incoming::Repeated | Incoming::Stream => {
                peer.refuse_with(id, P::RESULTS.protocol);
            }
        }
        Ok(true)
    }

    /// Everything else that happens under the lock: reports, deadlines, what is to be sent. Says
    /// whether there is something to send, and when the next report is due.
    fn tend(&mut self, cx: &mut Context<'_>, now: Instant) -> (bool, Option<Instant>) {
        let mut guard = self.peer.lock();
        let state = &mut *guard;
        let counters = &self.peer.counters;
        let room = |state: &PeerState<P>, link: &Link<S, P>| {
            state.out.len() + link.unwritten() < HIGH_WATER
        };
        let mut expired = Vec::new();
        while let Some(due) = state.session.due(now) {
            match due {
                Due::Again(id, queued) => {
                    if state.out.len() < HIGH_WATER {
                        state.encoder.prepared(&mut state.out, id, &queued.body);
                        counters.reports_repeated.one();
                    }
                }
                Due::Expired(_, queued) => {
                    counters.reports_timed_out.one();
                    state.report_bytes -= queued.body.len();
                    expired.push(queued);
                }
            }
        }
        while self.deaf.is_none()
            && room(state, &self.link)
            && state.session.in_flight() < self.peer.settings.limits.in_flight
            && let Some(queued) = state.queue.pop_front()
        {
            let (code, body) = (queued.code, queued.body.clone());
            let policy = spread(queued.policy, self.peer.id);
            if let Ok(id) = state.session.open(P::REPORT, code, policy, now, queued) {
                state.encoder.prepared(&mut state.out, id, &body);
                counters.reports_sent.one();
            }
        }
        let loads = self.link.unwritten() == 0 && !state.out.is_empty();
        if loads {
            counters.bytes_out.add(state.out.len());
            self.link.load(&mut state.out);
            self.watch.written = Flow::new(now);
        }
        self.peer.note(state);
        let due = state.session.next_due();
        if !state
            .driver
            .as_ref()
            .is_some_and(|waker| waker.will_wake(cx.waker()))
        {
            state.driver = Some(cx.waker().clone());
        }
        drop(guard);
        for queued in expired {
            queued.end(AckOutcome::TimedOut);
        }
        (loads, due)
    }

    /// Sets the timer to whatever comes first, or says what did not come in time.
    fn arm(&mut self, cx: &mut Context<'_>, now: Instant, due: Option<Instant>) -> Poll<Reason> {
        let settings = &self.peer.settings;
        let reading = self.waiting.len() < settings.limits.in_flight
            && self.has_room()
            && !self.gated
            && self.rest_until.is_none()
            && self.deaf.is_none();
        if reading && !self.watch.reading {
            // What could not come meanwhile is not missed.
            self.watch.read = Flow::new(now);
        }
        self.watch.reading = reading;
        let watch = &self.watch;
        let idle = self.waiting.is_empty() && self.link.decoder.pending() == 0;
        let limits = [
            (
                watch
                    .header
                    .filter(|_| reading)
                    .map(|at| after(at, settings.header_timeout)),
                HEADER_LATE,
            ),
            (
                (reading && self.link.decoder.pending() > 0)
                    .then(|| after(watch.read.since, settings.stall.within)),
                STALLED,
            ),
            (
                (self.link.unwritten() > 0)
                    .then(|| after(watch.written.since, settings.stall.within)),
                "the app does not read",
            ),
            (
                settings
                    .idle_timeout
                    .filter(|_| idle)
                    .map(|limit| after(watch.frame, limit)),
                "idle",
            ),
        ];
        let mut first = [due, self.rest_until].into_iter().flatten().min();
        for (at, reason) in limits {
            let Some(at) = at else { continue };
            if at <= now {
                // One that has fallen silent before has been counted then.
                if self.deaf.is_none() {
                    self.peer.counters.connections_timed_out.one();
                }
                if !matches!(reason, HEADER_LATE | STALLED) {
                    return Poll::Ready(reason);
                }
                // Requests before it may still be carried out.
                self.deaf = Some(reason);
                cx.waker().wake_by_ref();
                return Poll::Pending;
            }
            first = Some(first.map_or(at, |first| first.min(at)));
        }
        let Some(first) = first else {
            return Poll::Pending;
        };
        // A timer that rings too early does no harm; most are moved on before they ring.
        if self.armed.is_none_or(|armed| first < armed) {
            self.timer.as_mut().reset(first.into());
            self.armed = Some(first);
        }
        if self.timer.as_mut().poll(cx).is_ready() {
            self.armed = None;
            cx.waker().wake_by_ref();
        }
        Poll::Pending
    }
}

impl<S, P: Protocol> Driver<S, P> {
    /// Nothing more will be answered.
    fn leave(&mut self) {
        self.peer.end();
        for mut waiting in std::mem::take(&mut self.waiting) {
            waiting.abandon();
        }
    }
}

/// However the task ends.
impl<S, P: Protocol> Drop for Driver<S, P> {
    fn drop(&mut self) {
        self.leave();
    }
}

/// Repetitions to different apps are spread over an eighth of the wait: what many apps have not
/// acknowledged does not go to all of them again at once.
fn spread(policy: AckPolicy, connection: ConnectionId) -> AckPolicy {
    const PLACES: u32 = 32;
    let place = u32::try_from(connection.0 % u64::from(PLACES)).unwrap_or_default();
    let step = policy.timeout / 8 / PLACES;
    AckPolicy {
        timeout: policy.timeout.saturating_add(step * place),
        ..policy
    }
}

/// What an app has answered to a report.
fn acknowledged<P: Protocol>(body: &[u8], allowance: Allowance) -> AckOutcome {
    match read_enveloped::<P::Response, Empty>(body, allowance) {
        Err(error) => AckOutcome::Invalid(error),
        Ok(read) if read.envelope.result_code() == P::RESULTS.success.code => {
            AckOutcome::Acknowledged
        }
        Ok(read) => AckOutcome::Refused(Refusal::new(
            read.envelope.result_code(),
            read.envelope.result_text(),
        )),
    }
}
