//! A TCP connection that does all that one may: it splits and joins, delays, breaks off inside a
//! frame, or swallows what it is given. Besides, it does what an odd peer may do with frames: say
//! them twice, hold them back and swap them, repeat answers of long ago, and answer with one thing
//! wrong.

use super::common::{Toy, ToyHeader, answer_to, frame};
use super::random::Random;
use super::world::{Drive, Look, Tick};
use fc_runtime::{Command, FrameId, Header, Protocol, Report};
use std::collections::VecDeque;
use std::io::{Error, ErrorKind, Result};
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, Weak};
use std::task::{Context, Poll, Waker};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::{Instant, Sleep, sleep};

/// What one direction takes before it is read, in bytes.
const WINDOW: usize = 16 * 1024;

/// Codes of commands and reports that answers are forged for.
const CODES: [u16; 3] = [Look::CODE, Drive::CODE, Tick::CODE];

/// What may go wrong on a wire.
#[derive(Clone, Copy, Debug)]
pub struct Weather {
    /// Longest delay of a segment, in milliseconds.
    pub delay: u64,
    /// One in so many frames that may be said twice is; 0 for none.
    pub twice: usize,
    /// One in so many answers and reports is held back behind later ones; 0 for none.
    pub swap: usize,
}

/// Answers of earlier connections, to be said again.
pub type Old = Arc<Mutex<Vec<Vec<u8>>>>;

/// One direction of a wire.
#[allow(clippy::struct_excessive_bools, reason = "each is a fate of its own")]
struct Lane {
    random: Random,
    weather: Weather,
    /// What has been written and is no whole frame yet.
    partial: Vec<u8>,
    held: Vec<Vec<u8>>,
    segments: VecDeque<(Instant, Vec<u8>)>,
    bytes: usize,
    last: Instant,
    /// Bytes until it breaks.
    breaks_after: Option<usize>,
    /// Swallows everything from now on.
    hole: bool,
    reset: bool,
    end: bool,
    reader_gone: bool,
    reader: Option<Waker>,
    writer: Option<Waker>,
    old: Old,
    /// The other direction.
    back: Weak<Mutex<Lane>>,
    /// Frames said twice, swapped, repeated or forged.
    pub odd: u64,
}

fn chance(random: &mut Random, n: usize) -> bool {
    n > 0 && random.one_in(n)
}

impl Lane {
    fn write(&mut self, bytes: &[u8]) {
        self.partial.extend_from_slice(bytes);
        while let Some(total) = ToyHeader::peek_total_length(&self.partial) {
            let total = total as usize;
            if self.partial.len() < total {
                break;
            }
            let frame: Vec<u8> = self.partial.drain(..total).collect();
            self.frame(frame);
        }
        for frame in std::mem::take(&mut self.held) {
            self.send(frame);
        }
    }

    fn frame(&mut self, frame: Vec<u8>) {
        let id = FrameId::of::<Toy>(&ToyHeader::read(&frame).expect("a header"));
        let command = id.kind == Toy::COMMAND && !id.response;
        if !id.response && chance(&mut self.random, self.weather.twice * 2) {
            self.forge(id);
        }
        if id.response && id.kind == Toy::COMMAND {
            let mut old = self.old.lock().unwrap();
            if old.len() < 32 {
                old.push(frame.clone());
            }
            if chance(&mut self.random, self.weather.twice * 2) {
                let index = self.random.below(old.len());
                let again = old[index].clone();
                drop(old);
                self.odd += 1;
                self.send(again);
            }
        }
        // A command said twice is another command: that is for the app to decide.
        if !command && chance(&mut self.random, self.weather.swap) {
            self.odd += 1;
            self.held.push(frame);
            return;
        }
        if !command && chance(&mut self.random, self.weather.twice) {
            self.odd += 1;
            self.send(frame.clone());
        }
        self.send(frame);
    }

    /// Answers with one thing wrong: code, kind or id.
    fn forge(&mut self, request: FrameId) {
        let mut answer = answer_to(request);
        match self.random.below(3) {
            0 => {
                let other = CODES.iter().find(|code| **code != request.code);
                answer.code = other.copied().unwrap_or(0);
            }
            1 => answer.kind = Toy::COMMAND ^ Toy::REPORT ^ request.kind,
            // As many low bits as any table looks at are the same.
            _ => answer.id ^= 1 << 20,
        }
        if let Some(back) = self.back.upgrade() {
            let body = br#"{"result":7,"number":4000000000}"#;
            back.lock().unwrap().send(frame(answer, body));
            self.odd += 1;
        }
    }

    fn send(&mut self, mut bytes: Vec<u8>) {
        if self.hole || self.reset {
            return;
        }
        let breaks = self.breaks_after.is_some_and(|left| left < bytes.len());
        if let Some(left) = &mut self.breaks_after {
            bytes.truncate(*left);
            *left -= bytes.len();
        }
        while !bytes.is_empty() {
            let length = match self.random.below(4) {
                0 => 1,
                1 => 1 + self.random.below(40),
                _ => bytes.len(),
            };
            let rest = bytes.split_off(length.min(bytes.len()));
            let delay = match self.random.below(8) {
                0 => self.random.ms(self.weather.delay),
                1 => self.random.ms(10),
                _ => Duration::ZERO,
            };
            self.last = self.last.max(Instant::now() + delay);
            self.bytes += bytes.len();
            self.segments.push_back((self.last, bytes));
            bytes = rest;
        }
        self.reset |= breaks;
        if let Some(reader) = self.reader.take() {
            reader.wake();
        }
    }

    fn wake(&mut self) {
        for waker in [self.reader.take(), self.writer.take()]
            .into_iter()
            .flatten()
        {
            waker.wake();
        }
    }
}

/// Both directions, for whoever makes the weather.
#[derive(Clone)]
pub struct Wire {
    lanes: [Arc<Mutex<Lane>>; 2],
}

impl Wire {
    /// A wire and its ends: app's, robot's.
    pub fn new(random: &mut Random, weather: Weather, breaks: bool, old: &Old) -> (Self, End, End) {
        let mut lane = |old: &Old| {
            let breaks_after = (breaks && random.one_in(2)).then(|| random.below(3000));
            Arc::new(Mutex::new(Lane {
                random: random.fork(),
                weather,
                partial: Vec::new(),
                held: Vec::new(),
                segments: VecDeque::new(),
                bytes: 0,
                last: Instant::now(),
                breaks_after,
                hole: false,
                reset: false,
                end: false,
                reader_gone: false,
                reader: None,
                writer: None,
                old: Arc::clone(old),
                back: Weak::new(),
                odd: 0,
            }))
        };
        let (up, down) = (lane(&Old::default()), lane(old));
        up.lock().unwrap().back = Arc::downgrade(&down);
        down.lock().unwrap().back = Arc::downgrade(&up);
        let end = |incoming: &Arc<Mutex<Lane>>, outgoing: &Arc<Mutex<Lane>>| End {
            incoming: Arc::clone(incoming),
            outgoing: Arc::clone(outgoing),
            sleep: Box::pin(sleep(Duration::ZERO)),
        };
        let ends = (end(&down, &up), end(&up, &down));
        let wire = Self { lanes: [up, down] };
        (wire, ends.0, ends.1)
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

    /// Swallows what is sent upwards, downwards or both.
    pub fn swallow(&self, which: usize) {
        for (index, mut lane) in self.lanes().enumerate() {
            if which == index || which == 2 {
                lane.hole = true;
            }
        }
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
            if lane.end && !lane.hole {
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
        // What has arrived is joined, or given out in bits.
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
            if bytes.is_empty() {
                lane.segments.pop_front();
            }
        }
        if let Some(writer) = lane.writer.take() {
            writer.wake();
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
        if lane.bytes >= WINDOW {
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
        let mut lane = self.outgoing.lock().unwrap();
        lane.end = true;
        lane.wake();
        Poll::Ready(Ok(()))
    }
}

impl Drop for End {
    fn drop(&mut self) {
        let mut lane = self.outgoing.lock().unwrap();
        lane.end = true;
        lane.wake();
        drop(lane);
        let mut lane = self.incoming.lock().unwrap();
        lane.reader_gone = true;
        lane.wake();
    }
}
