//! Detects frames that stall while they arrive.
//!
//! [`MinimumRate`](crate::rate::MinimumRate) counts in windows. An app needs another rule, because a frame with a wrong
//! length swallows the following responses, which may arrive at some KiB per second. A limit above that in each window
//! would break a good frame on a slow link. A limit over the whole frame, plus the stall timeout, does not.

use crate::session::after;
use std::time::{Duration, Instant};

/// Minimum rate of a frame besides the stall timeout, in bytes per second. Responses swallowed by a wrong length must
/// not count as progress.
const LEAST: u64 = 16 * 1024;

/// Detects when the arriving frame stalls.
#[derive(Debug)]
pub(crate) struct FrameProgress {
    limit: Duration,
    /// Start of the frame, and arrival of its last bytes.
    since: Option<(Instant, Instant)>,
}

impl FrameProgress {
    pub(crate) fn new(limit: Duration) -> Self {
        Self { limit, since: None }
    }

    /// Notes that a frame is complete or has been skipped.
    pub(crate) fn complete(&mut self) {
        self.since = None;
    }

    /// Notes that bytes have arrived.
    pub(crate) fn received(&mut self, now: Instant) {
        if let Some((_, last)) = &mut self.since {
            *last = now;
        }
    }

    /// Returns the time at which the arriving frame stalls, or `None` between frames. `received` bytes of it have
    /// arrived.
    pub(crate) fn deadline(&mut self, received: usize, now: Instant) -> Option<Instant> {
        if received == 0 {
            self.since = None;
            return None;
        }
        let (begun, last) = *self.since.get_or_insert((now, now));
        let earned = Duration::from_millis((received as u64).saturating_mul(1000) / LEAST);
        let slow = after(begun, self.limit.saturating_add(earned));
        Some(after(last, self.limit).min(slow))
    }
}
