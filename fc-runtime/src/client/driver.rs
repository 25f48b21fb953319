//! The one task of a connection: it alone touches the socket.
//!
//! Each time it is woken it reads all there is, deals with it under one lock, takes what callers
//! have written meanwhile and sends it with one write.

use super::arrivals::{Arrival, Fault, arrive};
use super::connecting::{Dial, Tries};
use super::error::CallError;
use super::state::{Inner, Phase, Progress};
use crate::clock;
use crate::frame::FrameError;
use crate::link::{CLOSING, Link, Transport};
use crate::protocol::Protocol;
use crate::session::Due;
use std::pin::{Pin, pin};
use std::sync::Arc;
use std::task::{Context, Poll, Waker};
use std::time::{Duration, Instant};
use tokio::task::yield_now;
use tokio::time::{Sleep, sleep, timeout};

/// From this much on, in bytes, requests are sent without waiting for more of them.
const GATHER_UP_TO: usize = 32 * 1024;
/// How much may arrive before it is dealt with and others have their turn, in bytes.
const TURN: usize = 256 * 1024;
/// What the work on a frame counts beside its bytes.
const FRAME: usize = 1024;
/// Drives a connection until it is closed, reconnecting as configured.
pub(super) async fn drive_dialled<P: Protocol, D: Dial>(
    inner: Arc<Inner<P>>,
    stream: D::Transport,
    mut dial: D,
) {
    let mut driver = Driver::new(inner);
    let mut stream = Some(stream);
    let mut tries = Tries::default();
    while let Some(connected) = stream.take() {
        let heard = driver.run(connected).await.heard;
        tries.connected(heard);
        stream = driver.reconnect(&mut tries, &mut dial).await;
    }
}

/// Drives a connection over a stream that cannot be made again.
pub(super) async fn drive<P: Protocol, S: Transport>(inner: Arc<Inner<P>>, stream: S) {
    Driver::new(inner).run(stream).await;
}

/// What a connection that has ended was like.
struct Ended {
    /// It gave at least one frame.
    heard: bool,
}

struct Driver<P: Protocol> {
    inner: Arc<Inner<P>>,
    arrivals: Vec<Arrival>,
    /// Received and not yet counted.
    bytes_in: u64,
    wakers: Vec<Waker>,
    spare: Vec<u8>,
    /// Callers have had their turn before what is to be sent next.
    gathered: bool,
    timer: Pin<Box<Sleep>>,
    /// What the timer is set to.
    armed: Option<Instant>,
}

impl<P: Protocol> Driver<P> {
    fn new(inner: Arc<Inner<P>>) -> Self {
        Self {
            inner,
            arrivals: Vec::new(),
            bytes_in: 0,
            wakers: Vec::new(),
            spare: Vec::new(),
            gathered: false,
            timer: Box::pin(sleep(Duration::ZERO)),
            armed: None,
        }
    }

    /// Serves one connection until it ends or is closed.
    async fn run<S: Transport>(&mut self, stream: S) -> Ended {
        let mut link = Link::new(stream, self.inner.config.decoder::<P>());
        let mut heard = false;
        self.up();
        std::future::poll_fn(|cx| self.poll(cx, &mut link, &mut heard)).await;
        if self.inner.lock().phase == Phase::Closed {
            // A peer that does not read, or does not stop sending, does not keep us.
            let _ = timeout(CLOSING, link.goodbye()).await;
        }
        Ended { heard }
    }

    /// Ready when the connection has ended.
    fn poll<S: Transport>(
        &mut self,
        cx: &mut Context<'_>,
        link: &mut Link<S, P>,
        heard: &mut bool,
    ) -> Poll<()> {
        let mut turn = TURN;
        let ended = loop {
            if self.decode(link, &mut turn).is_err() {
                break true;
            }
            if turn == 0 {
                break false;
            }
            match link.poll_read(cx) {
                Poll::Pending => break false,
                Poll::Ready(Ok(n)) if n > 0 => self.bytes_in += n as u64,
                Poll::Ready(Ok(_)) => {
                    tracing::debug!(protocol = P::NAME, "the peer has closed the connection");
                    break true;
                }
                Poll::Ready(Err(error)) => {
                    tracing::debug!(protocol = P::NAME, %error, "the connection broke");
                    break true;
                }
            }
        };
        *heard |= !self.arrivals.is_empty();
        if !ended && self.gather(cx, link) {
            return Poll::Pending;
        }
        let closed = self.tend(cx, Some(link));
        if ended || closed {
            return Poll::Ready(());
        }
        loop {
            match link.poll_write(cx) {
                Poll::Ready(Ok(())) => {}
                Poll::Ready(Err(error)) => {
                    tracing::debug!(protocol = P::NAME, %error, "the connection broke");
                    return Poll::Ready(());
                }
                Poll::Pending => break,
            }
            link.load(&mut self.inner.lock().out);
            if link.unwritten() == 0 {
                break;
            }
        }
        if turn == 0 {
            // There may be more; first it is the others' turn.
            let _ = pin!(yield_now()).poll(cx);
        }
        Poll::Pending
    }

    /// Whether to let other callers have their turn before what the first has written is sent: their
    /// requests then go out with the same write. Costs a lone caller nothing.
    fn gather<S: Transport>(&mut self, cx: &mut Context<'_>, link: &Link<S, P>) -> bool {
        let waits = !self.gathered && self.arrivals.is_empty() && link.unwritten() == 0 && {
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
    fn decode<S: Transport>(
        &mut self,
        link: &mut Link<S, P>,
        turn: &mut usize,
    ) -> Result<(), FrameError> {
        while *turn > 0 {
            match link.decoder.next() {
                Ok(None) => return Ok(()),
                Ok(Some(frame)) => {
                    *turn = turn.saturating_sub(FRAME + frame.body().len());
                    let depth = self.inner.limits.json_depth;
                    self.arrivals
                        .push(Arrival::of(frame, &mut self.spare, depth));
                }
                Err(error) => {
                    *turn = turn.saturating_sub(FRAME);
                    let Some(id) = error.frame() else {
                        tracing::warn!(protocol = P::NAME, error = error.name(), "{error}");
                        self.inner.lock().counters.bad_frames += 1;
                        return Err(error);
                    };
                    let body = Err(Fault::Frame(error));
                    self.arrivals.push(Arrival {
                        id,
                        digest: [0; 16],
                        body,
                    });
                }
            }
        }
        Ok(())
    }

    /// Everything that happens under the lock: arrivals, deadlines, what is to be sent. Says whether
    /// the connection has been closed.
    fn tend<S: Transport>(&mut self, cx: &mut Context<'_>, link: Option<&mut Link<S, P>>) -> bool {
        let now = clock::now();
        let mut guard = self.inner.lock();
        let state = &mut *guard;
        state.counters.bytes_in += std::mem::take(&mut self.bytes_in);
        for arrival in self.arrivals.drain(..) {
            arrive(state, arrival, now, &mut self.wakers);
        }
        while let Some(due) = state.session.due(now) {
            if let Due::Expired(_, slot) = due {
                state.counters.timeouts += 1;
                self.wakers
                    .extend(state.slots.finish(slot, Err(CallError::Timeout)));
            }
        }
        if self.spare.capacity() == 0 {
            self.spare = std::mem::take(&mut state.spare);
        }
        if let Some(link) = link {
            link.load(&mut state.out);
        }
        let closed = state.is_over();
        let due = state.session.next_due();
        if !closed
            && !state
                .driver
                .as_ref()
                .is_some_and(|waker| waker.will_wake(cx.waker()))
        {
            state.driver = Some(cx.waker().clone());
        }
        drop(guard);
        for waker in self.wakers.drain(..) {
            waker.wake();
        }
        self.arm(cx, due);
        closed
    }

    /// Sets the timer to `due`.
    fn arm(&mut self, cx: &mut Context<'_>, due: Option<Instant>) {
        let Some(due) = due else {
            self.armed = None;
            return;
        };
        if self.armed != Some(due) {
            self.timer.as_mut().reset(due.into());
            self.armed = Some(due);
        }
        if self.timer.as_mut().poll(cx).is_ready() {
            // Due while we were at it: come back at once.
            self.armed = None;
            cx.waker().wake_by_ref();
        }
    }

    fn up(&self) {
        let mut state = self.inner.lock();
        if state.phase == Phase::Closed {
            return;
        }
        // The first connection was there, and counted, before its driver.
        if state.phase == Phase::Down {
            state.counters.connects += 1;
        }
        state.phase = Phase::Up;
        state.session.reconnected();
        let wakers: Vec<_> = state
            .slots
            .iter_mut()
            .filter(|slot| slot.progress.is_to_send())
            .filter_map(|slot| slot.waker.take())
            .collect();
        drop(state);
        wakers.into_iter().for_each(Waker::wake);
    }

    /// Ends the calls that must not be sent twice, and keeps the others for the next connection.
    fn down(&mut self, phase: Phase) {
        let mut guard = self.inner.lock();
        let state = &mut *guard;
        if state.phase != Phase::Closed {
            state.phase = phase;
        }
        let over = state.phase == Phase::Closed;
        state.out.clear();
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
                CallError::Closed
            } else {
                CallError::Lost
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
    async fn reconnect<D: Dial>(
        &mut self,
        tries: &mut Tries,
        dial: &mut D,
    ) -> Option<D::Transport> {
        let backoff = self.inner.config.backoff()?;
        self.down(Phase::Down);
        loop {
            let wait = tries.next(backoff)?;
            tracing::debug!(protocol = P::NAME, ?wait, "reconnecting");
            let attempt = async {
                sleep(wait).await;
                dial.dial().await
            };
            let mut attempt = pin!(attempt);
            let connected = std::future::poll_fn(|cx| {
                if self.tend::<D::Transport>(cx, None) {
                    return Poll::Ready(None);
                }
                attempt.as_mut().poll(cx).map(Some)
            });
            match connected.await? {
                Ok(stream) => return Some(stream),
                Err(error) => tracing::debug!(protocol = P::NAME, %error, "not connected"),
            }
        }
    }
}

/// However it ends, even with the runtime, no call waits for ever.
impl<P: Protocol> Drop for Driver<P> {
    fn drop(&mut self) {
        self.down(Phase::Closed);
    }
}
