//! A log that a flood does not flood.

use std::time::{Duration, Instant};

/// Lines that one cause may write in a minute.
const LINES: u32 = 5;

/// The lines of one cause, mostly on one connection: a few a minute, for what goes on for hours is no
/// news. What is held back is counted, and the next line says so.
#[derive(Debug)]
pub(crate) struct LogLimiter {
    window: Duration,
    /// When the window began.
    since: Option<Instant>,
    lines: u32,
    held: u64,
}

impl Default for LogLimiter {
    fn default() -> Self {
        Self::within(Duration::from_secs(60))
    }
}

impl LogLimiter {
    /// As many lines a second, for what is news each time: that connections come and go. Nobody who
    /// reads the log may take one for up that is down.
    pub(crate) fn per_second() -> Self {
        Self::within(Duration::from_secs(1))
    }

    fn within(window: Duration) -> Self {
        Self {
            window,
            since: None,
            lines: 0,
            held: 0,
        }
    }

    /// Whether to write a line now; if so, how many were held back before it.
    pub(crate) fn admit(&mut self, now: Instant) -> Option<Suppressed> {
        let window = self.window;
        let lasts = |since| now.saturating_duration_since(since) < window;
        if !self.since.is_some_and(lasts) {
            self.since = Some(now);
            self.lines = 0;
        }
        if self.lines >= LINES {
            self.held = self.held.saturating_add(1);
            return None;
        }
        self.lines += 1;
        Some(Suppressed(std::mem::take(&mut self.held)))
    }
}

/// Lines held back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Suppressed(u64);

impl Suppressed {
    /// What the line says of it: nothing if there were none.
    pub(crate) fn shown(self) -> Option<u64> {
        (self.0 > 0).then_some(self.0)
    }
}
