//! A log that a flood does not flood.

use std::time::{Duration, Instant};

/// Lines that one cause may write in a second.
const LINES: u32 = 5;

/// The lines of one cause, mostly on one connection: a few a second; what is held back is counted, and
/// the next line says so.
#[derive(Debug, Default)]
pub(crate) struct Thin {
    /// When the second began.
    since: Option<Instant>,
    lines: u32,
    held: u64,
}

impl Thin {
    /// Whether to write a line now; if so, how many were held back before it.
    pub(crate) fn line(&mut self, now: Instant) -> Option<Held> {
        let lasts = |since| now.saturating_duration_since(since) < Duration::from_secs(1);
        if !self.since.is_some_and(lasts) {
            self.since = Some(now);
            self.lines = 0;
        }
        if self.lines >= LINES {
            self.held = self.held.saturating_add(1);
            return None;
        }
        self.lines += 1;
        Some(Held(std::mem::take(&mut self.held)))
    }
}

/// Lines held back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held(u64);

impl Held {
    /// What the line says of it: nothing if there were none.
    pub(crate) fn shown(self) -> Option<u64> {
        (self.0 > 0).then_some(self.0)
    }
}
