//! What a connection pays for when its frames make work and cannot be used: for a while nothing is
//! read from it, and the others have the robot to themselves.

use crate::clock;
use crate::log_limiter::{LogLimiter, Suppressed};
use crate::session::after;
use std::time::{Duration, Instant};

/// How much a connection may have decompressed for it, in bytes per second, beyond the bytes it has
/// sent.
const INFLATED: u64 = 128 * 1024 * 1024;

/// What a frame costs that cannot be used: what is answered as a protocol error, as invalid or as
/// expired, and answers that nobody waits for.
const UNUSABLE: Duration = Duration::from_millis(1);

/// So many of these are free, and are so again once the time they cost has passed: an app of another
/// version notices nothing.
const FREE: u32 = 256;

/// What one connection has to pay for.
#[derive(Debug, Default)]
pub(super) struct Penalty {
    owed: Duration,
    /// When that much was owed.
    at: Option<Instant>,
}

impl Penalty {
    /// How long the connection rests after so many frames that could not be used.
    pub(super) fn unusable(&mut self, frames: u32, now: Instant) -> Duration {
        if let Some(at) = self.at.replace(now) {
            self.owed = self.owed.saturating_sub(now.saturating_duration_since(at));
        }
        self.owed = self.owed.saturating_add(UNUSABLE.saturating_mul(frames));
        self.owed.saturating_sub(UNUSABLE * FREE)
    }
}

/// How long a connection rests after so many bytes were decompressed for it.
pub(super) fn inflated(surplus: u64) -> Duration {
    Duration::from_micros(surplus.saturating_mul(1_000_000) / INFLATED)
}

/// When a connection is not read because of what it owes.
#[derive(Debug, Default)]
pub(super) struct ReadPause {
    penalty: Penalty,
    until: Option<Instant>,
    limiters: LogLimiter,
}

impl ReadPause {
    /// When it is over, if the connection rests.
    pub(super) fn until(&mut self, now: Instant) -> Option<Instant> {
        self.until = self.until.filter(|until| *until > now);
        self.until
    }

    /// Notes what the last frames have cost: bytes decompressed beyond those that came, and frames that
    /// could not be used. Gives the new rest, if there is one, and what to log of it.
    pub(super) fn owe(
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
