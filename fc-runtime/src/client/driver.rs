//! The one task of a connection: it reads the socket, and writes to it what callers do not write themselves.
//!
//! Each time it is woken it reads all there is, deals with it under one lock, takes what callers
//! have written meanwhile and sends it with one write.

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

/// From this much on, in bytes, requests are sent without waiting for more of them.
const GATHER_UP_TO: usize = 32 * 1024;
/// How much may arrive before it is dealt with and others have their turn, in bytes.
const TURN: usize = 256 * 1024;
/// What the work on a frame counts beside its bytes.
const FRAME: usize = 1024;

/// Drives a connection until it is closed, reconnecting as configured: the one that there is, or else
/// the first that can be made. There is a driver from now on, also if the task never has a turn.
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
            let heard = driver.run(connected).await.heard;
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

/// How a turn of the connection has ended.
enum Turn {
    /// As much has arrived as may be dealt with at once.
    Spent,
    /// And the connection with it.
    Over(Loss),
}

/// What a connection that has ended was like.
struct Ended {
    /// It gave at least one frame.
    heard: bool,
}

/// One connection's bytes.
struct Link<S, P: Protocol> {
    socket: Shared<S>,
    decoder: Decoder<P>,
}

struct Driver<P: Protocol> {
    inner: Arc<Inner<P>>,
    arrivals: Vec<Arrival>,
    report_checks: ReportChecks,
    /// Received and not yet counted.
    bytes_in: u64,
    wakers: Vec<Waker>,
    spare: Vec<u8>,
    /// Callers have had their turn before what is to be sent next.
    gathered: bool,
    /// The frame that is arriving.
    arriving: FrameProgress,
    /// Since when the robot has taken nothing of what is to be sent.
    unread_since: Option<Instant>,
    /// Why the connection has ended, as soon as it is known.
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

    /// Serves one connection until it ends or is closed.
    async fn run<S: Transport>(&mut self, stream: S) -> Ended {
        let mut link = Link {
            socket: Shared::new(stream),
            decoder: self.inner.config.decoder::<P>(),
        };
        let mut heard = false;
        self.arriving.whole();
        self.unread_since = None;
        // Should the task end before the connection does.
        self.why = Loss::Ended;
        self.up(&link.socket);
        self.log
            .connected(self.inner.lock().connection.now().connects());
        self.why = loop {
            let turn = std::future::poll_fn(|cx| self.poll(cx, &mut link, &mut heard));
            match turn.await {
                Turn::Over(why) => break why,
                // There may be more; first it is the others' turn.
                Turn::Spent => yield_now().await,
            }
        };
        self.log.ended(self.why);
        if self.inner.lock().connection.now().is_closed() {
            let out = std::mem::take(&mut self.inner.lock().out);
            // A peer that does not read, or does not stop sending, does not keep us.
            let _ = timeout(CLOSING, link.socket.goodbye(out)).await;
        }
        Ended { heard }
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
                    self.arriving.came(now);
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
        let (closed, due) = self.tend(cx, now);
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

    /// Whether the frame that is arriving has stalled, now that nothing more of it is there.
    fn stalled<S>(&mut self, link: &Link<S, P>, now: Instant) -> Option<Loss> {
        let received = link.decoder.pending();
        let deadline = self.arriving.deadline(received, now)?;
        (deadline <= now).then(|| Loss::Stalled {
            received,
            total: link.decoder.expected().unwrap_or(P::Header::LEN),
        })
    }

    /// When the robot has read nothing for too long, if something is left for it to read: `unwritten`
    /// bytes of `before`.
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

    /// Whether to let other callers have their turn before what the first has written is sent: their
    /// requests then go out with the same write. Costs a lone caller nothing.
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

    /// Takes whole frames out of the decoder, as many as the turn allows.
    fn decode<S>(&mut self, link: &mut Link<S, P>, turn: &mut usize) -> Result<(), FrameError> {
        while *turn > 0 {
            match link.decoder.next() {
                Ok(None) => return Ok(()),
                Ok(Some(frame)) => {
                    self.arriving.whole();
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
                    self.arriving.whole();
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

    /// What happens under the lock: arrivals and deadlines. Says whether the connection has been closed,
    /// and when the next call is due.
    fn tend(&mut self, cx: &mut Context<'_>, now: Instant) -> (bool, Option<Instant>) {
        let mut guard = self.inner.lock();
        let state = &mut *guard;
        state.counters.bytes_in += std::mem::take(&mut self.bytes_in);
        for arrival in self.arrivals.drain(..) {
            arrive(state, arrival, now, &mut self.wakers);
        }
        while let Some(due) = state.session.due(now) {
            if let Due::Expired(_, slot) = due {
                state.counters.timeouts += 1;
                let unsent = state
                    .slots
                    .get(slot)
                    .is_some_and(|slot| matches!(slot.progress, Progress::Unsent));
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
        // The first connection may have been there, and counted, before its driver.
        if !state.connection.now().is_connected() {
            state.connection.connected();
        }
        state.session.reconnected();
        state.report_watchdog.begin();
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
            let unsent = state
                .slots
                .get(slot)
                .is_some_and(|slot| matches!(slot.progress, Progress::Unsent));
            let error = if unsent {
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

    /// A new connection, or `None` once there will be none.
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
                let (closed, due) = self.tend(cx, clock::now());
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

/// However it ends, even with the runtime, no call waits for ever.
impl<P: Protocol> Drop for Driver<P> {
    fn drop(&mut self) {
        if self.why == Loss::NotYet {
            self.why = Loss::Ended;
        }
        self.down(true);
    }
}
