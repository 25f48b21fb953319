//! Time limits of a command connection.

use super::config::Settings;
use crate::rate::RateMeter;
use crate::session::after;
use crate::sync::Alarm;
use std::task::{Context, Poll};
use std::time::Instant;

/// The reason for the end of a connection, for the log.
pub(super) type Reason = &'static str;

/// The bytes that a connection waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Expected {
    /// No bytes.
    Nothing,
    /// A frame.
    Frame,
    /// The rest of a frame.
    Rest,
}

/// The activity of a connection after all possible work.
#[derive(Clone, Copy, Debug)]
pub(super) struct Activity {
    pub(super) expected: Expected,
    /// `true` if the app does not take bytes that are to be sent.
    pub(super) unwritten: bool,
    /// `true` if no received request is unanswered.
    pub(super) idle: bool,
    /// Time at which the connection must continue.
    pub(super) due: Option<Instant>,
}

/// An exceeded time limit.
#[derive(Clone, Copy, Debug)]
pub(super) enum Overdue {
    /// The rest of a frame is late. The connection cannot be read any more, but responses can be sent.
    Frame(Reason),
    /// Anything else. The connection cannot be used any more.
    All(Reason),
}

/// Times of the last events of a connection, and the timer for the next limit.
pub(super) struct Watchdog {
    /// Arrival of the first byte of an incomplete header.
    header: Option<Instant>,
    /// Rate of the arriving frame while it is read.
    read: RateMeter,
    reads: bool,
    /// Rate of the sent bytes.
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

    /// Notes the first bytes of a frame.
    pub(super) fn begins(&mut self, now: Instant) {
        self.read = RateMeter::new(now);
    }

    /// Notes further bytes of a frame.
    pub(super) fn received(&mut self, bytes: usize, settings: &Settings, now: Instant) {
        self.read.add(bytes, settings.stall.bytes, now);
    }

    /// Notes that all received bytes have been read. They may end inside a header.
    pub(super) fn ends_inside_header(&mut self, inside: bool, now: Instant) {
        self.header = inside.then(|| self.header.unwrap_or(now));
    }

    /// Notes a complete frame.
    pub(super) fn frame(&mut self, now: Instant) {
        self.header = None;
        self.read = RateMeter::new(now);
        self.frame = now;
    }

    /// Notes new bytes to be sent.
    pub(super) fn loads(&mut self, now: Instant) {
        self.written = RateMeter::new(now);
    }

    /// Notes sent bytes.
    pub(super) fn wrote(&mut self, bytes: usize, settings: &Settings, now: Instant) {
        self.written.add(bytes, settings.stall.bytes, now);
    }

    /// Returns an exceeded limit, or wakes the task of `cx` at the next one.
    pub(super) fn poll(
        &mut self,
        cx: &mut Context<'_>,
        now: Instant,
        settings: &Settings,
        activity: Activity,
    ) -> Poll<Overdue> {
        let reads = activity.expected != Expected::Nothing;
        if reads && !self.reads {
            // Bytes that were not read meanwhile are not late.
            self.read = RateMeter::new(now);
        }
        self.reads = reads;
        let begun = self.header.filter(|_| reads);
        let header = begun.map(|at| after(at, settings.header_timeout));
        let stalled = |flow: &RateMeter| after(flow.since, settings.stall.within);
        let rest = (activity.expected == Expected::Rest).then(|| stalled(&self.read));
        let unread = activity.unwritten.then(|| stalled(&self.written));
        let silence = settings.idle_timeout.filter(|_| activity.idle);
        let idle = silence.map(|limit| after(self.frame, limit));
        let limits = [
            (header, Overdue::Frame("a header did not come in time")),
            (rest, Overdue::Frame("a frame stalled")),
            (unread, Overdue::All("the app does not read")),
            (idle, Overdue::All("idle")),
        ];
        let is_late = |at: Option<Instant>| at.is_some_and(|at| at <= now);
        if let Some((_, late)) = limits.into_iter().find(|(at, _)| is_late(*at)) {
            return Poll::Ready(late);
        }
        let ends = limits.into_iter().filter_map(|(at, _)| at);
        if let Some(next) = ends.chain(activity.due).min() {
            self.alarm.set(cx, next);
        }
        Poll::Pending
    }
}
