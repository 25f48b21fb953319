//! The task of a connection: it reads the socket, and writes everything that callers do not write themselves.
//!
//! When it wakes, it reads everything, handles it under one lock, takes the requests of callers and sends them with one
//! write.

use super::arrivals::{Arrival, ArrivalError, ReportChecks, arrive};
use super::connecting::{Dial, Reconnect};
use super::connection_log::ConnectionLog;
use super::error::CallError;
use super::loss::Loss;
use super::socket::Shared;
use super::state::{Inner, Progress};
use super::state_watch::ConnectionState;
use crate::clock;
use crate::digest::Sum;
use crate::frame::{Decoder, FrameError};
use crate::link::{CLOSING, Transport};
use crate::progress::FrameProgress;
use crate::protocol::Protocol;
use crate::session::{Due, after};
use crate::sync::{Alarm, register};
use crate::wire::Header;
use std::pin::pin;
use std::sync::Arc;
use std::task::{Context, Poll, Waker};
use std::time::Instant;
use tokio::task::yield_now;
use tokio::time::{sleep, timeout};

/// Amount of requests that is sent without waiting for more, in bytes.
const GATHER_UP_TO: usize = 32 * 1024;
/// Amount that may be received before other tasks run, in bytes.
const TURN: usize = 256 * 1024;
/// Work per frame in addition to its bytes.
const FRAME: usize = 1024;

/// Drives a connection until it is closed, and reconnects as configured. It starts with `stream`, or connects first.
/// The driver exists from the call on, even if the task is never polled.
pub(super) fn drive_dialled<P: Protocol, D: Dial>(
    inner: Arc<Inner<P>>,
    stream: Option<D::Transport>,
    mut dial: D,
) -> impl Future<Output = ()> {
    let mut driver = Driver::new(inner, dial.address());
    async move {
        let mut reconnect = Reconnect::new(driver.inner.config.reconnect);
        let mut stream = match stream {
            None => driver.connect(&mut reconnect, &mut dial).await,
            there => there,
        };
        while let Some(connected) = stream.take() {
            let heard = driver.run(connected).await;
            reconnect.connected(heard);
            stream = driver.connect(&mut reconnect, &mut dial).await;
        }
    }
}

/// Drives a connection over a stream that cannot be made again.
pub(super) fn drive<P: Protocol, S: Transport>(
    inner: Arc<Inner<P>>,
    stream: S,
) -> impl Future<Output = ()> {
    let mut driver = Driver::new(inner, "a given stream".to_owned());
    async move {
        driver.run(stream).await;
    }
}

/// The end of a turn of the connection.
enum Turn {
    /// The turn has used up its bytes.
    Spent,
    /// The connection has ended.
    Over(Loss),
}

/// The socket and decoder of a connection.
struct Link<S, P: Protocol> {
    socket: Shared<S>,
    decoder: Decoder<P>,
}

struct Driver<P: Protocol> {
    inner: Arc<Inner<P>>,
    arrivals: Vec<Arrival>,
    report_checks: ReportChecks,
    /// Received bytes that are not counted yet.
    bytes_in: u64,
    wakers: Vec<Waker>,
    spare: Vec<u8>,
    /// `true` if other callers have had a chance to add requests to the next write.
    gathered: bool,
    /// Progress of the arriving frame.
    arriving: FrameProgress,
    /// Time since which the robot has read nothing.
    unread_since: Option<Instant>,
    /// Reason for the end of the connection, once known.
    why: Loss,
    log: ConnectionLog,
    alarm: Alarm,
}

impl<P: Protocol> Driver<P> {
    fn new(inner: Arc<Inner<P>>, address: String) -> Self {
        Self {
            log: ConnectionLog::new::<P>(address, "command"),
            arriving: FrameProgress::new(inner.config.connection.stall_timeout),
            unread_since: None,
            why: Loss::NotYet,
            inner,
            arrivals: Vec::new(),
            report_checks: ReportChecks::of::<P>(),
            bytes_in: 0,
            wakers: Vec::new(),
            spare: Vec::new(),
            gathered: false,
            alarm: Alarm::new(),
        }
    }

    /// Serves one connection until it ends or is closed. Returns `true` if at least one frame was received.
    async fn run<S: Transport>(&mut self, stream: S) -> bool {
        let mut link = Link {
            socket: Shared::new(stream),
            decoder: self.inner.config.decoder::<P>(),
        };
        let mut heard = false;
        self.arriving.complete();
        self.unread_since = None;
        // The reason if the task ends before the connection.
        self.why = Loss::Ended;
        self.up(&link.socket);
        self.log
            .connected(self.inner.lock().connection.now().connects());
        self.why = loop {
            let turn = std::future::poll_fn(|cx| self.poll(cx, &mut link, &mut heard));
            match turn.await {
                Turn::Over(why) => break why,
                // More data may be available, but other tasks run first.
                Turn::Spent => yield_now().await,
            }
        };
        self.log.ended(self.why);
        if self.inner.lock().connection.now().is_closed() {
            let out = std::mem::take(&mut self.inner.lock().out);
            // The wait is limited, because the peer may neither read nor stop sending.
            let _ = timeout(CLOSING, link.socket.goodbye(out)).await;
        }
        heard
    }

    /// Ready at the end of a turn.
    fn poll<S: Transport>(
        &mut self,
        cx: &mut Context<'_>,
        link: &mut Link<S, P>,
        heard: &mut bool,
    ) -> Poll<Turn> {
        let now = clock::now();
        let mut turn = TURN;
        let ended = loop {
            if let Err(error) = self.decode(link, &mut turn) {
                break Some(Loss::Frame(error));
            }
            *heard |= !self.arrivals.is_empty();
            if turn == 0 {
                break None;
            }
            match link.socket.poll_read(&mut link.decoder, cx) {
                Poll::Pending => break self.stalled(link, now),
                Poll::Ready(Ok(n)) if n > 0 => {
                    self.bytes_in += n as u64;
                    self.arriving.received(now);
                }
                Poll::Ready(Ok(_)) => {
                    break Some(match link.decoder.finish() {
                        Err(error) => Loss::Frame(error),
                        Ok(()) if *heard => Loss::Closed,
                        Ok(()) => Loss::Unheard,
                    });
                }
                Poll::Ready(Err(error)) => break Some(Loss::broken(&error, *heard)),
            }
        };
        if ended.is_none() && self.gather(cx, link) {
            return Poll::Pending;
        }
        let (closed, due) = self.update_state(cx, now);
        if closed {
            return Poll::Ready(Turn::Over(Loss::Here));
        }
        if let Some(loss) = ended {
            return Poll::Ready(Turn::Over(loss));
        }
        let inner = &self.inner;
        let written = (link.socket).write(cx, |outlet| outlet.load(&mut inner.lock().out));
        let (before, unwritten) = match written {
            Ok(left) => left,
            Err(error) => return Poll::Ready(Turn::Over(Loss::broken(&error, *heard))),
        };
        let unread = self.unread(before, unwritten, now);
        if unread.is_some_and(|at| at <= now) {
            return Poll::Ready(Turn::Over(Loss::Unread));
        }
        let stalls = self.arriving.deadline(link.decoder.pending(), now);
        if let Some(due) = [due, unread, stalls].into_iter().flatten().min() {
            self.alarm.set(cx, due);
        }
        if turn == 0 {
            return Poll::Ready(Turn::Spent);
        }
        Poll::Pending
    }

    /// Returns the loss if the arriving frame has stalled. All available bytes have been read.
    fn stalled<S>(&mut self, link: &Link<S, P>, now: Instant) -> Option<Loss> {
        let received = link.decoder.pending();
        let deadline = self.arriving.deadline(received, now)?;
        (deadline <= now).then(|| Loss::Stalled {
            received,
            total: link.decoder.expected().unwrap_or(P::Header::LEN),
        })
    }

    /// Returns the time at which the robot has read nothing for too long, or `None` if it has nothing to read. `before`
    /// bytes were unwritten before the last write, `unwritten` bytes are now.
    fn unread(&mut self, before: usize, unwritten: usize, now: Instant) -> Option<Instant> {
        if unwritten == 0 {
            self.unread_since = None;
            return None;
        }
        if unwritten != before {
            self.unread_since = None;
        }
        let since = *self.unread_since.get_or_insert(now);
        Some(after(since, self.inner.config.connection.stall_timeout))
    }

    /// Returns `true` to let other callers add requests before the next write. This costs nothing with a single caller.
    fn gather<S: Transport>(&mut self, cx: &mut Context<'_>, link: &Link<S, P>) -> bool {
        let waits = !self.gathered && self.arrivals.is_empty() && link.socket.unwritten() == 0 && {
            let state = self.inner.lock();
            state.session.in_flight() > 1 && (1..GATHER_UP_TO).contains(&state.out.len())
        };
        self.gathered = waits;
        if waits {
            cx.waker().wake_by_ref();
        }
        waits
    }

    /// Takes complete frames out of the decoder, as many as the turn allows.
    fn decode<S>(&mut self, link: &mut Link<S, P>, turn: &mut usize) -> Result<(), FrameError> {
        while *turn > 0 {
            match link.decoder.next() {
                Ok(None) => return Ok(()),
                Ok(Some(frame)) => {
                    self.arriving.complete();
                    *turn = turn.saturating_sub(FRAME + frame.body().len());
                    let allowance = self.inner.limits.json();
                    self.arrivals.push(Arrival::of(
                        frame,
                        &mut self.spare,
                        &self.report_checks,
                        allowance,
                    ));
                }
                Err(error) => {
                    self.arriving.complete();
                    *turn = turn.saturating_sub(FRAME);
                    let Some(id) = error.frame() else {
                        self.inner.lock().counters.bad_frames += 1;
                        return Err(error);
                    };
                    let body = Err(ArrivalError::Frame(error));
                    self.arrivals.push(Arrival {
                        id,
                        digest: Sum::default(),
                        body,
                    });
                }
            }
        }
        Ok(())
    }

    /// Handles arrivals and deadlines under the lock. Returns `true` if the connection is closed, and the deadline of
    /// the next call.
    fn update_state(&mut self, cx: &mut Context<'_>, now: Instant) -> (bool, Option<Instant>) {
        let mut guard = self.inner.lock();
        let state = &mut *guard;
        state.counters.bytes_in += std::mem::take(&mut self.bytes_in);
        for arrival in self.arrivals.drain(..) {
            arrive(state, arrival, now, &mut self.wakers);
        }
        while let Some(due) = state.session.due(now) {
            if let Due::Expired(_, slot) = due {
                state.counters.timeouts += 1;
                let unsent = state.slots.is_unsent(slot);
                let error = match (state.connection.now(), unsent) {
                    (ConnectionState::Connected { .. }, _) => CallError::Timeout,
                    (ConnectionState::Connecting { why, .. }, true) => CallError::NotConnected(why),
                    (ConnectionState::Closed { why, .. }, true) => CallError::Closed(why),
                    (
                        ConnectionState::Connecting { why, .. }
                        | ConnectionState::Closed { why, .. },
                        false,
                    ) => CallError::Lost(why),
                };
                self.wakers.extend(state.slots.finish(slot, Err(error)));
            }
        }
        if self.spare.capacity() == 0 {
            self.spare = std::mem::take(&mut state.spare);
        }
        // A caller with an earlier deadline wakes the driver to set its alarm.
        self.alarm.forget_past(now);
        state.alarm = self.alarm.at();
        state.tell();
        let closed = state.connection.now().is_closed();
        let due = state.session.next_due();
        if !closed {
            register(&mut state.driver, cx);
        }
        drop(guard);
        for waker in self.wakers.drain(..) {
            waker.wake();
        }
        (closed, due)
    }

    fn up<S: Transport>(&self, socket: &Shared<S>) {
        let mut state = self.inner.lock();
        state.socket = Some(socket.for_callers());
        // The first connection may have been counted before the driver was created.
        if !state.connection.now().is_connected() {
            state.connection.connected();
        }
        state.session.reconnected();
        state.report_watchdog.restart();
        let mut wakers: Vec<_> = state
            .slots
            .iter_mut()
            .filter(|slot| slot.progress.is_to_send())
            .filter_map(|slot| slot.waker.take())
            .collect();
        state.reports.connected(&mut wakers);
        drop(state);
        wakers.into_iter().for_each(Waker::wake);
    }

    /// Ends the calls that must not be sent twice, and keeps the others for the next connection.
    fn down(&mut self, for_good: bool) {
        let mut guard = self.inner.lock();
        let state = &mut *guard;
        if for_good {
            state.connection.close(self.why);
        } else {
            if state.connection.now().is_connected() {
                state.reports.lost(self.why, &mut self.wakers);
            }
            state.connection.lost(self.why);
        }
        state.tell();
        let over = state.connection.now().is_closed();
        let why = state.connection.now().why().unwrap_or(self.why);
        state.out.clear();
        state.socket = None;
        let slots = &mut state.slots;
        let ended = state.session.end_if(|_, slot| {
            let Some(slot) = slots.get(*slot) else {
                return true;
            };
            if slot.repeat && matches!(slot.progress, Progress::Sent) {
                slot.progress = Progress::Again;
            }
            over || !slot.progress.is_to_send()
        });
        for (_, slot) in ended {
            let error = if state.slots.is_unsent(slot) {
                CallError::Closed(why)
            } else {
                CallError::Lost(why)
            };
            self.wakers.extend(state.slots.finish(slot, Err(error)));
        }
        if over {
            state.reports.wake(&mut self.wakers);
        }
        drop(guard);
        for waker in self.wakers.drain(..) {
            waker.wake();
        }
    }

    /// Returns a new connection, or `None` if there will be none.
    async fn connect<D: Dial>(
        &mut self,
        reconnect: &mut Reconnect,
        dial: &mut D,
    ) -> Option<D::Transport> {
        loop {
            let Some(wait) = reconnect.next() else {
                self.log.given_up(self.why);
                return None;
            };
            self.down(false);
            tracing::debug!(protocol = P::NAME, ?wait, "connecting");
            let attempt = async {
                sleep(wait).await;
                dial.dial().await
            };
            let mut attempt = pin!(attempt);
            let connected = std::future::poll_fn(|cx| {
                let (closed, due) = self.update_state(cx, clock::now());
                if closed {
                    return Poll::Ready(None);
                }
                if let Some(due) = due {
                    self.alarm.set(cx, due);
                }
                attempt.as_mut().poll(cx).map(Some)
            });
            match connected.await? {
                Ok(stream) => return Some(stream),
                Err(error) => {
                    self.why = Loss::from(&error);
                    reconnect.failed();
                    self.log.not_connected(self.why);
                }
            }
        }
    }
}

/// Ends all calls, even if the runtime ends.
impl<P: Protocol> Drop for Driver<P> {
    fn drop(&mut self) {
        if self.why == Loss::NotYet {
            self.why = Loss::Ended;
        }
        self.down(true);
    }
}
