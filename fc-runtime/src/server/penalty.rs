//! Penalties for connections whose frames cause useless work: they are not read for a while.

use crate::clock;
use crate::log_limiter::{LogLimiter, Suppressed};
use crate::session::after;
use std::time::{Duration, Instant};

/// Inflated bytes per second that a connection may cause beyond the bytes it has sent.
const INFLATED: u64 = 128 * 1024 * 1024;

/// Penalty for an unusable frame: a protocol error, an invalid or expired message, or a response to no request.
const UNUSABLE: Duration = Duration::from_millis(1);

/// Number of unusable frames without a penalty. They become free again after the time they cost. So an app of another
/// version is not slowed down.
const FREE: u32 = 256;

/// The penalty of one connection for unusable frames.
#[derive(Debug, Default)]
pub(super) struct Penalty {
    owed: Duration,
    /// Time of the last update.
    at: Option<Instant>,
}

impl Penalty {
    /// Returns the pause after this many unusable frames.
    pub(super) fn unusable(&mut self, frames: u32, now: Instant) -> Duration {
        if let Some(at) = self.at.replace(now) {
            self.owed = self.owed.saturating_sub(now.saturating_duration_since(at));
        }
        self.owed = self.owed.saturating_add(UNUSABLE.saturating_mul(frames));
        self.owed.saturating_sub(UNUSABLE * FREE)
    }
}

/// Returns the pause after this many surplus bytes have been inflated.
pub(super) fn inflated(surplus: u64) -> Duration {
    Duration::from_micros(surplus.saturating_mul(1_000_000) / INFLATED)
}

/// The pause of a connection that is not read because of a penalty.
#[derive(Debug, Default)]
pub(super) struct ReadPause {
    penalty: Penalty,
    until: Option<Instant>,
    limiters: LogLimiter,
}

impl ReadPause {
    /// Returns the end of the pause, or `None` without one.
    pub(super) fn until(&mut self, now: Instant) -> Option<Instant> {
        self.until = self.until.filter(|until| *until > now);
        self.until
    }

    /// Adds the cost of the last frames: inflated bytes beyond those received, and unusable frames. Returns the new
    /// pause, if there is one, and the state of the log limit.
    pub(super) fn add(
        &mut self,
        surplus: u64,
        unusable: u32,
        now: Instant,
    ) -> Option<(Duration, Option<Suppressed>)> {
        let mut rest = inflated(surplus);
        if unusable > 0 {
            rest = rest.max(self.penalty.unusable(unusable, now));
        }
        if rest.is_zero() {
            return None;
        }
        let now = clock::now();
        self.until = self.until.max(Some(after(now, rest)));
        Some((rest, self.limiters.admit(now)))
    }
}
