//! One direction of a wire: frames go in, segments come out.

use super::common::{Toy, ToyHeader, answer_to, frame};
use super::ledger;
use super::random::Random;
use super::world::{Drive, Look, Tick};
use fc_runtime::{Command, FrameId, Header, Protocol, Report};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, Weak};
use std::task::Waker;
use std::time::Duration;
use tokio::time::Instant;

/// Capacity of one direction, in bytes.
pub const WINDOW: usize = 16 * 1024;

/// Codes of commands and reports that answers are forged for.
const CODES: [u16; 3] = [Look::CODE, Drive::CODE, Tick::CODE];

/// Faults of a wire.
#[derive(Clone, Copy, Debug)]
pub struct Weather {
    /// Longest delay of a segment, in milliseconds.
    pub delay: u64,
    /// Repeats one in this many repeatable frames; 0 for none.
    pub twice: usize,
    /// One in so many answers and reports is held back behind later ones; 0 for none.
    pub swap: usize,
}

impl Weather {
    pub const CALM: Self = Self {
        delay: 1,
        twice: 0,
        swap: 0,
    };
}

/// Answers of earlier connections, to be said again.
pub type Old = Arc<Mutex<Vec<Vec<u8>>>>;

/// One direction of a wire.
#[allow(clippy::struct_excessive_bools, reason = "each is a fate of its own")]
pub struct Lane {
    pub random: Random,
    pub weather: Weather,
    /// Written bytes that are not a complete frame yet.
    pub partial: Vec<u8>,
    pub held: Vec<(Option<u32>, Vec<u8>)>,
    pub segments: VecDeque<(Instant, Vec<u8>)>,
    pub bytes: usize,
    /// Bytes sent and read in total, and the offsets at which responses are complete.
    pub sent: u64,
    pub read: u64,
    pub answers: VecDeque<(u64, u32)>,
    /// Capacity before it is read.
    pub window: usize,
    pub last: Instant,
    /// Bytes until it breaks.
    pub breaks_after: Option<usize>,
    /// Swallows everything from now on.
    pub hole: bool,
    /// Becomes a hole inside the next frame.
    pub stops: bool,
    /// Ends here for its reader; its writer does not know.
    pub closed: bool,
    pub reset: bool,
    pub end: bool,
    pub reader_gone: bool,
    pub reader: Option<Waker>,
    pub writer: Option<Waker>,
    pub old: Old,
    /// The other direction.
    pub back: Weak<Mutex<Lane>>,
    pub ledger: ledger::Shared,
    /// Frames said twice, swapped, repeated or forged.
    pub odd: u64,
}

fn chance(random: &mut Random, n: usize) -> bool {
    n > 0 && random.one_in(n)
}

impl Lane {
    pub fn write(&mut self, bytes: &[u8]) {
        self.partial.extend_from_slice(bytes);
        while let Some(total) = ToyHeader::peek_total_length(&self.partial) {
            let total = total as usize;
            if self.partial.len() < total {
                break;
            }
            let frame: Vec<u8> = self.partial.drain(..total).collect();
            self.frame(frame);
        }
        for (answer, frame) in std::mem::take(&mut self.held) {
            self.send_answer(answer, frame);
        }
    }

    fn frame(&mut self, frame: Vec<u8>) {
        let id = FrameId::of::<Toy>(&ToyHeader::read(&frame).expect("a header"));
        let command = id.kind == Toy::COMMAND && !id.response;
        if !id.response && chance(&mut self.random, self.weather.twice * 2) {
            self.forge(id);
        }
        let answer = (id.response && id.kind == Toy::COMMAND).then_some(id.id);
        if let Some(id) = answer {
            self.ledger.lock().unwrap().answers(id);
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
            self.held.push((answer, frame));
            return;
        }
        if !command && chance(&mut self.random, self.weather.twice) {
            self.odd += 1;
            self.send(frame.clone());
        }
        self.send_answer(answer, frame);
    }

    /// Sends a frame, and notes where it ends if it is an answer.
    fn send_answer(&mut self, answer: Option<u32>, frame: Vec<u8>) {
        let whole = self.sent + frame.len() as u64;
        self.send(frame);
        if let Some(id) = answer
            && self.sent == whole
            && !self.ledger.lock().unwrap().garbled
        {
            self.answers.push_back((whole, id));
        }
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

    pub fn send(&mut self, mut bytes: Vec<u8>) {
        if self.hole || self.reset || self.closed {
            return;
        }
        if std::mem::take(&mut self.stops) {
            bytes.truncate(1 + self.random.below(bytes.len() - 1));
            self.hole = true;
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
            self.sent += bytes.len() as u64;
            self.segments.push_back((self.last, bytes));
            bytes = rest;
        }
        self.reset |= breaks;
        if let Some(reader) = self.reader.take() {
            reader.wake();
        }
    }

    pub fn wake(&mut self) {
        for waker in [self.reader.take(), self.writer.take()]
            .into_iter()
            .flatten()
        {
            waker.wake();
        }
    }
}
