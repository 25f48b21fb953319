//! The task of a command connection. Only it uses the socket.
//!
//! When it wakes, it continues waiting handlers, reads and handles all requests, takes reports and responses, and sends
//! everything with one write. An app that does not read its responses is not read either.

mod requests;

use super::connection_id::ConnectionId;
use super::gate::{Gate, GateQueue};
use super::handlers::Handlers;
use super::output::Output;
use super::peer::Peer;
use super::penalty::ReadPause;
use super::push::AckOutcome;
use super::service::Service;
use super::watch::{Activity, Expected, Overdue, Reason, Watchdog};
use crate::clock;
use crate::frame::LONG;
use crate::link::{CLOSING, Link, Transport};
use crate::log_limiter::LogLimiter;
use crate::operation::AckPolicy;
use crate::protocol::Protocol;
use crate::session::Due;
use crate::sync::register;
use requests::ReadEnd;
use std::future::poll_fn;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Instant;
use tokio::task::yield_now;
use tokio::time::timeout;

/// Unsent bytes beyond which nothing is read or taken from queues.
const HIGH_WATER: usize = 256 * 1024;

/// Work of a connection in one turn, in bytes received and answered: about sixty small requests. Then other connections
/// run.
const TURN: usize = 160 * 1024;

/// Bytes of a long response that are digested at once, in about sixty microseconds.
const DIGEST: usize = 32 * 1024;

/// Bytes written at once. The system copies them while no other task runs.
const WRITE: usize = 256 * 1024;

/// Work per frame in addition to its bytes.
pub(super) const FRAME: usize = 2 * 1024;

/// The reason if nothing can be sent any more.
const BROKEN: Reason = "the connection broke";

/// The end of a turn of the connection.
enum Turn {
    /// The turn has used up its work.
    Spent,
    /// The connection has ended.
    Over(Reason),
}

pub(super) struct Driver<S, P: Protocol> {
    link: Link<S, P>,
    peer: Arc<Peer<P>>,
    service: Arc<dyn Service<P>>,
    handlers: Handlers<P>,
    /// Work left in this turn, in bytes.
    turn: usize,
    gate: GateQueue,
    /// `true` if there is no memory to read on.
    short: bool,
    pause: ReadPause,
    /// Log limits for unreadable frames, and for the limit of calls in flight.
    bad_frames: LogLimiter,
    in_flight: LogLimiter,
    /// The reason why nothing more is read. Handled requests are answered nevertheless.
    half_closed: Option<Reason>,
    watch: Watchdog,
}

impl<S: Transport, P: Protocol> Driver<S, P> {
    pub(super) fn new(
        stream: S,
        peer: Arc<Peer<P>>,
        service: Arc<dyn Service<P>>,
        gate: Gate,
    ) -> Self {
        Self {
            link: Link::new(stream, peer.settings.decoder()),
            peer,
            service,
            handlers: Handlers::default(),
            turn: TURN,
            gate: GateQueue::new(gate),
            short: false,
            pause: ReadPause::default(),
            bad_frames: LogLimiter::default(),
            in_flight: LogLimiter::default(),
            half_closed: None,
            watch: Watchdog::new(clock::now()),
        }
    }

    /// Serves the connection until it ends.
    pub(super) async fn run(mut self) {
        let peer = Arc::clone(&self.peer);
        peer.counters
            .connected::<P>(peer.id, peer.address, "command");
        let reason = loop {
            let turn = poll_fn(|cx| {
                let turn = self.poll(cx);
                self.gate.keep_if_asked();
                self.update_memory();
                turn
            });
            match turn.await {
                Turn::Over(reason) => break reason,
                // More requests may be available, but other tasks run first.
                Turn::Spent => yield_now().await,
            }
        };
        peer.counters
            .ended::<P>(peer.id, peer.address, "command", reason);
        self.leave();
        if peer.evicted().is_none() {
            // The wait is limited, because the app may neither read nor stop sending.
            let _ = timeout(CLOSING, self.link.goodbye()).await;
        }
    }

    fn poll(&mut self, cx: &mut Context<'_>) -> Poll<Turn> {
        if let Some(reason) = self.peer.evicted() {
            return Poll::Ready(Turn::Over(reason));
        }
        if self.peer.take_untidy() {
            self.tidy();
        }
        let now = clock::now();
        self.turn = TURN;
        loop {
            while self.turn > 0 && self.has_room() {
                let before = self.peer.unsent();
                if self.handlers.poll_next(cx).is_pending() {
                    break;
                }
                self.charge(before);
            }
            let mut more = false;
            if !self.peer.is_draining() && self.half_closed.is_none() {
                match self.receive(cx, now) {
                    Ok(read) => more = read,
                    Err(ReadEnd::Broken) => return Poll::Ready(Turn::Over(BROKEN)),
                    Err(ReadEnd::HalfClosed(reason)) => self.half_closed = Some(reason),
                }
            }
            more |= self.handlers.take_fresh();
            let sealed = self.seal();
            let (loaded, due) = self.update_state(cx, now);
            more |= loaded;
            let before = self.link.unwritten();
            let write = self.link.poll_write(cx, WRITE);
            let unwritten = self.link.unwritten();
            let written = before.saturating_sub(unwritten);
            self.watch.wrote(written, &self.peer.settings, now);
            // Long data is digested and written in pieces, with pauses for other tasks.
            let long = !sealed || (write.is_ready() && unwritten > 0);
            more &= !long;
            match write {
                Poll::Ready(Ok(())) if more || long => {}
                Poll::Ready(Ok(())) if self.is_drained() => {
                    return Poll::Ready(Turn::Over(self.half_closed.unwrap_or("drained")));
                }
                Poll::Ready(Ok(())) => {}
                Poll::Ready(Err(_)) => return Poll::Ready(Turn::Over(BROKEN)),
                Poll::Pending => more = false,
            }
            if more {
                continue;
            }
            let activity = self.activity(now, due);
            match self.watch.poll(cx, now, &self.peer.settings, activity) {
                Poll::Ready(late) => {
                    // A connection that is no longer read has been counted before.
                    if self.half_closed.is_none() {
                        self.peer.counters.connections_timed_out.increment();
                    }
                    match late {
                        Overdue::All(reason) => return Poll::Ready(Turn::Over(reason)),
                        // Requests before it may still be running.
                        Overdue::Frame(reason) => self.half_closed = Some(reason),
                    }
                }
                Poll::Pending if self.turn == 0 || long => return Poll::Ready(Turn::Spent),
                Poll::Pending => return Poll::Pending,
            }
        }
    }

    /// Returns the activity of the connection after all possible work.
    fn activity(&mut self, now: Instant, due: Option<Instant>) -> Activity {
        let rest = self.pause.until(now);
        let inside = self.link.decoder.pending() > 0;
        let reads = self.handlers.len() < self.peer.settings.limits.in_flight
            && self.has_room()
            && !self.gate.is_waiting()
            && !self.short
            && rest.is_none()
            && self.half_closed.is_none();
        Activity {
            expected: match (reads, inside) {
                (false, _) => Expected::Nothing,
                (true, false) => Expected::Frame,
                (true, true) => Expected::Rest,
            },
            unwritten: self.link.unwritten() > 0,
            idle: self.handlers.is_empty() && !inside,
            due: [due, rest].into_iter().flatten().min(),
        }
    }

    /// Updates the memory held for the connection.
    fn update_memory(&self) {
        let (mut busy, mut idle) = (self.handlers.weight(), 0);
        let unsent = {
            let output = self.peer.output();
            (output.out.capacity(), output.out.is_empty())
        };
        let unwritten = (self.link.capacity(), self.link.unwritten() == 0);
        for (bytes, is_idle) in [unsent, unwritten] {
            *if is_idle { &mut idle } else { &mut busy } += bytes;
        }
        let kept = self.link.decoder.idle();
        busy += self.link.decoder.capacity() - kept;
        self.peer.memory.update(busy, idle + kept);
    }

    /// Releases unused memory.
    fn tidy(&mut self) {
        self.link.tidy();
        let mut output = self.peer.output();
        if output.out.is_empty() {
            output.out = Vec::new();
        }
    }

    /// Returns `true` if another response may be written.
    fn has_room(&self) -> bool {
        self.link.unwritten() + self.peer.unsent() < HIGH_WATER
    }

    /// Continues the digests of long responses. Returns `true` if they are complete.
    fn seal(&mut self) -> bool {
        if self.peer.unsent() < LONG {
            return true;
        }
        let mut output = self.peer.output();
        self.turn -= output.seal(self.turn.min(DIGEST));
        output.is_sealed()
    }

    /// Subtracts new responses from the turn. `before` is the number of unsent bytes before them.
    fn charge(&mut self, before: usize) {
        let answered = self.peer.unsent().saturating_sub(before);
        self.turn = self.turn.saturating_sub(answered);
    }

    /// Returns `true` if all requests are answered and no more are to come.
    fn is_drained(&self) -> bool {
        (self.peer.is_draining() || self.half_closed.is_some())
            && self.peer.unsent() == 0
            && self.handlers.is_empty()
    }

    /// Handles reports, deadlines and the send buffer under the lock. Returns `true` if there is something to send, and
    /// the deadline of the next report.
    fn update_state(&mut self, cx: &mut Context<'_>, now: Instant) -> (bool, Option<Instant>) {
        let mut guard = self.peer.lock();
        let state = &mut *guard;
        let mut output = self.peer.output();
        let output = &mut *output;
        let counters = &self.peer.counters;
        let room = |output: &Output<P>, link: &Link<S, P>| {
            output.out.len() + link.unwritten() < HIGH_WATER
        };
        let mut expired = Vec::new();
        while let Some(due) = state.session.due(now) {
            match due {
                Due::Again(id, queued) => {
                    if output.out.len() < HIGH_WATER {
                        output.encoder.prepared(&mut output.out, id, &queued.body);
                        counters.reports_repeated.increment();
                    }
                }
                Due::Expired(_, queued) => {
                    counters.reports_timed_out.increment();
                    expired.push(queued);
                }
            }
        }
        while self.half_closed.is_none()
            && room(output, &self.link)
            && state.session.in_flight() < self.peer.settings.limits.in_flight
            && let Some(queued) = state.queue.pop_front()
        {
            let (code, body) = (queued.code, queued.body.clone());
            let policy = spread(queued.policy, self.peer.id);
            if let Ok(id) = state.session.open(P::REPORT, code, policy, now, queued) {
                output.encoder.prepared(&mut output.out, id, &body);
                counters.reports_sent.increment();
            }
        }
        let loads = self.link.unwritten() == 0 && !output.out.is_empty() && output.is_sealed();
        if loads {
            counters.bytes_out.add(output.out.len());
            self.link.load(&mut output.out);
            self.watch.loads(now);
        }
        self.peer.note(output);
        let due = state.session.next_due();
        register(&mut state.driver, cx);
        drop(guard);
        for queued in expired {
            queued.end(AckOutcome::TimedOut);
        }
        (loads, due)
    }
}

impl<S, P: Protocol> Driver<S, P> {
    /// Notes that no more responses are sent.
    fn leave(&mut self) {
        self.peer.end();
        self.handlers.abandon();
    }
}

/// Runs however the task ends.
impl<S, P: Protocol> Drop for Driver<S, P> {
    fn drop(&mut self) {
        self.leave();
        self.peer.memory.close();
    }
}

/// Spreads repetitions to different apps over an eighth of the wait, so that many unacknowledged reports are not
/// repeated at once.
fn spread(policy: AckPolicy, connection: ConnectionId) -> AckPolicy {
    const PLACES: u32 = 32;
    let place = u32::try_from(connection.0 % u64::from(PLACES)).unwrap_or_default();
    let step = policy.timeout / 8 / PLACES;
    AckPolicy {
        timeout: policy.timeout.saturating_add(step * place),
        ..policy
    }
}
