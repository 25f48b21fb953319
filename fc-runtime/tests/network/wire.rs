//! A simulated TCP connection with all possible faults. It splits and joins, delays, breaks inside a frame, ends in one
//! direction only, or swallows bytes.
//!
//! It also simulates odd peers. They repeat, hold back and swap frames, repeat old responses and change one field of a
//! response. They send garbage, stop inside a frame, fall silent, and read nothing.

use super::garbage::{self, Garbage};
use super::lane::{Lane, Old, WINDOW, Weather};
use super::ledger::{self, Ledger};
use super::random::Random;
use std::collections::VecDeque;
use std::io::{Error, ErrorKind, Result};
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, Weak};
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::{Instant, Sleep, sleep};

/// Time after which both ends learn that a direction swallows bytes, like keepalive of TCP.
const KEEPALIVE: Duration = Duration::from_secs(60);

/// Both directions, for fault injection.
#[derive(Clone)]
pub struct Wire {
    /// The app's, the robot's.
    lanes: [Arc<Mutex<Lane>>; 2],
    pub ledger: ledger::Shared,
}

impl Wire {
    /// A wire and its ends: app's, robot's.
    pub fn new(random: &mut Random, weather: Weather, breaks: bool, old: &Old) -> (Self, End, End) {
        let ledger = ledger::Shared::default();
        let mut lane = |old: &Old| {
            let breaks_after = (breaks && random.one_in(2)).then(|| random.below(3000));
            Arc::new(Mutex::new(Lane {
                random: random.fork(),
                weather,
                partial: Vec::new(),
                held: Vec::new(),
                segments: VecDeque::new(),
                bytes: 0,
                sent: 0,
                read: 0,
                answers: VecDeque::new(),
                window: WINDOW,
                last: Instant::now(),
                breaks_after,
                hole: false,
                stops: false,
                closed: false,
                reset: false,
                end: false,
                reader_gone: false,
                reader: None,
                writer: None,
                old: Arc::clone(old),
                back: Weak::new(),
                ledger: Arc::clone(&ledger),
                odd: 0,
            }))
        };
        let (up, down) = (lane(&Old::default()), lane(old));
        up.lock().unwrap().back = Arc::downgrade(&down);
        down.lock().unwrap().back = Arc::downgrade(&up);
        let end = |incoming: &Arc<Mutex<Lane>>, outgoing: &Arc<Mutex<Lane>>, robot| End {
            incoming: Arc::clone(incoming),
            outgoing: Arc::clone(outgoing),
            sleep: Box::pin(sleep(Duration::ZERO)),
            robot,
        };
        let ends = (end(&down, &up, false), end(&up, &down, true));
        let lanes = [up, down];
        (Self { lanes, ledger }, ends.0, ends.1)
    }

    fn lanes(&self) -> impl Iterator<Item = MutexGuard<'_, Lane>> {
        self.lanes.iter().map(|lane| lane.lock().unwrap())
    }

    /// Breaks the connection at once.
    pub fn reset(&self) {
        for mut lane in self.lanes() {
            lane.reset = true;
            lane.segments.clear();
            lane.wake();
        }
    }

    /// Swallows bytes upwards, downwards or both ways, until TCP notices.
    pub fn swallow(&self, which: usize) {
        for (index, mut lane) in self.lanes().enumerate() {
            if which == index || which == 2 {
                lane.hole = true;
            }
        }
        let wire = self.clone();
        tokio::spawn(async move {
            sleep(KEEPALIVE).await;
            wire.reset();
        });
    }

    /// Returns `true` if both ends exist and no permanent fault was injected.
    pub fn is_sound(&self) -> bool {
        self.lanes().all(|lane| {
            let gone = lane.reset || lane.end || lane.reader_gone;
            !gone && !lane.hole && !lane.stops && !lane.closed && lane.window > 0
        }) && self.ledger().deafened.is_none()
            && !self.ledger().garbled
    }

    fn lane(&self, up: bool) -> MutexGuard<'_, Lane> {
        self.lanes[usize::from(!up)].lock().unwrap()
    }

    pub fn ledger(&self) -> MutexGuard<'_, Ledger> {
        self.ledger.lock().unwrap()
    }

    /// Ends one direction, perhaps inside a frame, and not the other.
    pub fn half_close(&self, up: bool) {
        if up {
            self.ledger().deafened = Some("requests answered after the app's half-close");
        }
        let mut lane = self.lane(up);
        if lane.random.one_in(2) {
            let begun = lane.partial.clone();
            lane.send(begun);
        }
        lane.closed = true;
        lane.wake();
    }

    /// Inserts garbage between two frames.
    pub fn garble(&self, up: bool, random: &mut Random) -> &'static str {
        let Garbage {
            what,
            bytes,
            in_sync,
        } = garbage::some(random, up);
        if !in_sync && up {
            self.ledger().deafened = Some("requests answered after garbage");
        } else if !in_sync {
            self.ledger().garbled = true;
        }
        self.lane(up).send(bytes);
        what
    }

    /// The sender in this direction stops inside the next frame for ever.
    pub fn stop_inside(&self, up: bool) {
        self.lane(up).stops = true;
    }

    /// The sender in this direction is silent for this time.
    pub fn pause(&self, up: bool, time: Duration) {
        let mut lane = self.lane(up);
        lane.last = lane.last.max(Instant::now() + time);
    }

    /// The receiver in this direction stops reading.
    pub fn fill(&self, up: bool) {
        self.lane(up).window = 0;
    }

    pub fn odd(&self) -> u64 {
        self.lanes().map(|lane| lane.odd).sum()
    }

    /// Most bytes that are under way in one direction.
    pub fn under_way(&self) -> usize {
        self.lanes().map(|lane| lane.bytes).max().unwrap_or(0)
    }
}

/// One end of a wire.
pub struct End {
    incoming: Arc<Mutex<Lane>>,
    outgoing: Arc<Mutex<Lane>>,
    sleep: Pin<Box<Sleep>>,
    /// It is the robot's, and not the app's.
    robot: bool,
}

impl End {
    /// The robot has nothing more to say, or is not able to.
    fn settle(&self) {
        let broken = self.incoming.lock().unwrap().reset;
        let lane = self.outgoing.lock().unwrap();
        let said = lane.end;
        if self.robot
            && !(said || broken || lane.reset || lane.reader_gone || lane.writer.is_some())
        {
            lane.ledger.lock().unwrap().closes();
        }
    }
}

impl AsyncRead for End {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<Result<()>> {
        let this = &mut *self;
        let mut lane = this.incoming.lock().unwrap();
        let Some((at, _)) = lane.segments.front() else {
            if lane.reset {
                return Poll::Ready(Err(Error::from(ErrorKind::ConnectionReset)));
            }
            if lane.closed || lane.end && !lane.hole {
                return Poll::Ready(Ok(()));
            }
            lane.reader = Some(cx.waker().clone());
            return Poll::Pending;
        };
        let at = *at;
        if at > Instant::now() {
            lane.reader = Some(cx.waker().clone());
            drop(lane);
            this.sleep.as_mut().reset(at);
            if this.sleep.as_mut().poll(cx).is_pending() {
                return Poll::Pending;
            }
            lane = this.incoming.lock().unwrap();
        }
        // Arrived bytes are joined or split.
        let lane = &mut *lane;
        let mut most = if lane.random.one_in(4) {
            1 + lane.random.below(64)
        } else {
            usize::MAX
        };
        while let Some((at, bytes)) = lane.segments.front_mut()
            && *at <= Instant::now()
            && most > 0
            && buf.remaining() > 0
        {
            let n = bytes.len().min(buf.remaining()).min(most);
            buf.put_slice(&bytes[..n]);
            bytes.drain(..n);
            most -= n;
            lane.bytes -= n;
            lane.read += n as u64;
            if bytes.is_empty() {
                lane.segments.pop_front();
            }
        }
        if let Some(writer) = lane.writer.take() {
            writer.wake();
        }
        while let Some(&(whole, id)) = lane.answers.front()
            && whole <= lane.read
        {
            lane.answers.pop_front();
            // An app that has said goodbye has ended its calls.
            if !this.outgoing.lock().unwrap().end {
                lane.ledger.lock().unwrap().arrives(id);
            }
        }
        Poll::Ready(Ok(()))
    }
}

impl AsyncWrite for End {
    fn poll_write(self: Pin<&mut Self>, cx: &mut Context<'_>, buf: &[u8]) -> Poll<Result<usize>> {
        let mut lane = self.outgoing.lock().unwrap();
        if lane.reset || lane.reader_gone && !lane.hole {
            return Poll::Ready(Err(Error::from(ErrorKind::BrokenPipe)));
        }
        if lane.bytes >= lane.window {
            lane.writer = Some(cx.waker().clone());
            return Poll::Pending;
        }
        let n = if lane.random.one_in(4) {
            1 + lane.random.below(buf.len())
        } else {
            buf.len()
        };
        lane.write(&buf[..n]);
        Poll::Ready(Ok(n))
    }

    fn poll_flush(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<Result<()>> {
        Poll::Ready(Ok(()))
    }

    fn poll_shutdown(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<Result<()>> {
        self.settle();
        let mut lane = self.outgoing.lock().unwrap();
        lane.end = true;
        lane.wake();
        Poll::Ready(Ok(()))
    }
}

impl Drop for End {
    fn drop(&mut self) {
        self.settle();
        let mut lane = self.outgoing.lock().unwrap();
        lane.end = true;
        lane.wake();
        drop(lane);
        let mut lane = self.incoming.lock().unwrap();
        lane.reader_gone = true;
        lane.wake();
    }
}
