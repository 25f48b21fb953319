//! Limits of log lines.

use std::time::{Duration, Instant};

/// Lines of one cause in a time window.
const LINES: u32 = 5;

/// Limits the lines of one cause, usually on one connection, to a few per minute. Suppressed lines are counted, and the
/// next line contains their number.
#[derive(Debug)]
pub(crate) struct LogLimiter {
    window: Duration,
    /// Start of the window.
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
    /// Allows as many lines per second, for lines that are always new: connections that begin and end. A reader of the
    /// log must not take a lost connection for an open one.
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

    /// Returns the number of lines suppressed before if a line may be written now, or `None`.
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

/// Number of suppressed lines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Suppressed(u64);

impl Suppressed {
    /// Returns the number for the line, or `None` if no lines were suppressed.
    pub(crate) fn shown(self) -> Option<u64> {
        (self.0 > 0).then_some(self.0)
    }
}
