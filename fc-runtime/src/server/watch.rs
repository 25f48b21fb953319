//! What has to come, or go, in time on a command connection.

use super::config::Settings;
use crate::rate::RateMeter;
use crate::session::after;
use crate::sync::Alarm;
use std::task::{Context, Poll};
use std::time::Instant;

/// Why a connection has ended, for the log.
pub(super) type Reason = &'static str;

/// What bytes a connection waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Expected {
    /// For none.
    Nothing,
    /// For a frame.
    Frame,
    /// For the rest of one.
    Rest,
}

/// What a connection is at when it has done all it can for now.
#[derive(Clone, Copy, Debug)]
pub(super) struct Activity {
    pub(super) expected: Expected,
    /// Something is to be sent that the app does not take.
    pub(super) unwritten: bool,
    /// Nothing has come that is not answered.
    pub(super) idle: bool,
    /// When it has to go on by itself.
    pub(super) due: Option<Instant>,
}

/// What did not come in time.
#[derive(Clone, Copy, Debug)]
pub(super) enum Overdue {
    /// The rest of a frame: nothing more can be read, but answered.
    Frame(Reason),
    /// Anything else: the connection is of no more use.
    All(Reason),
}

/// When something last happened on a connection, and the timer for what is next.
pub(super) struct Watchdog {
    /// The first byte of a header that is not whole yet.
    header: Option<Instant>,
    /// Of the frame that has begun to arrive, while it is read.
    read: RateMeter,
    reads: bool,
    /// Of what is to be sent.
    written: RateMeter,
    frame: Instant,
    alarm: Alarm,
}

impl Watchdog {
    pub(super) fn new(now: Instant) -> Self {
        Self {
            header: None,
            read: RateMeter::new(now),
            reads: false,
            written: RateMeter::new(now),
            frame: now,
            alarm: Alarm::new(),
        }
    }

    /// The first bytes of a frame have come.
    pub(super) fn begins(&mut self, now: Instant) {
        self.read = RateMeter::new(now);
    }

    /// More bytes of it have come.
    pub(super) fn received(&mut self, bytes: usize, settings: &Settings, now: Instant) {
        self.read.add(bytes, settings.stall.bytes, now);
    }

    /// All that has come has been looked at, and it ends `inside` a header, or not.
    pub(super) fn ends_inside_header(&mut self, inside: bool, now: Instant) {
        self.header = inside.then(|| self.header.unwrap_or(now));
    }

    /// A whole frame has come.
    pub(super) fn frame(&mut self, now: Instant) {
        self.header = None;
        self.read = RateMeter::new(now);
        self.frame = now;
    }

    /// Something new is to be sent.
    pub(super) fn loads(&mut self, now: Instant) {
        self.written = RateMeter::new(now);
    }

    /// So much of it has been taken.
    pub(super) fn wrote(&mut self, bytes: usize, settings: &Settings, now: Instant) {
        self.written.add(bytes, settings.stall.bytes, now);
    }

    /// Says what is late, or has `cx` woken when the next thing is.
    pub(super) fn poll(
        &mut self,
        cx: &mut Context<'_>,
        now: Instant,
        settings: &Settings,
        activity: Activity,
    ) -> Poll<Overdue> {
        let reads = activity.expected != Expected::Nothing;
        if reads && !self.reads {
            // What could not come meanwhile is not missed.
            self.read = RateMeter::new(now);
        }
        self.reads = reads;
        let stalled = |flow: &RateMeter| after(flow.since, settings.stall.within);
        let limits = [
            (
                self.header
                    .filter(|_| reads)
                    .map(|at| after(at, settings.header_timeout)),
                Overdue::Frame("a header did not come in time"),
            ),
            (
                (activity.expected == Expected::Rest).then(|| stalled(&self.read)),
                Overdue::Frame("a frame stalled"),
            ),
            (
                activity.unwritten.then(|| stalled(&self.written)),
                Overdue::All("the app does not read"),
            ),
            (
                settings
                    .idle_timeout
                    .filter(|_| activity.idle)
                    .map(|limit| after(self.frame, limit)),
                Overdue::All("idle"),
            ),
        ];
        let mut next = activity.due;
        for (at, late) in limits {
            let Some(at) = at else { continue };
            if at <= now {
                return Poll::Ready(late);
            }
            next = Some(next.map_or(at, |next| next.min(at)));
        }
        if let Some(next) = next {
            self.alarm.set(cx, next);
        }
        Poll::Pending
    }
}
