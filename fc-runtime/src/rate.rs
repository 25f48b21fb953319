//! Minimum rates of transfers.

use std::time::{Duration, Instant};

/// The minimum number of bytes in a time. Without it, a peer that sends a byte now and then would keep its memory for
/// ever.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MinimumRate {
    pub(crate) bytes: usize,
    pub(crate) within: Duration,
}

impl MinimumRate {
    /// Creates a minimum from a rate in bytes per second.
    pub(crate) fn new(rate: u32, within: Duration) -> Self {
        let bytes = within.as_millis().saturating_mul(rate.into()) / 1000;
        Self {
            bytes: usize::try_from(bytes).unwrap_or(usize::MAX).max(1),
            within,
        }
    }
}

/// Bytes transferred since the last progress.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RateMeter<I = Instant> {
    /// Time of the last progress, or the start.
    pub(crate) since: I,
    bytes: usize,
}

impl<I> RateMeter<I> {
    pub(crate) fn new(now: I) -> Self {
        Self {
            since: now,
            bytes: 0,
        }
    }

    /// Counts transferred bytes. `least` bytes are progress.
    pub(crate) fn add(&mut self, bytes: usize, least: usize, now: I) {
        self.bytes = self.bytes.saturating_add(bytes);
        if self.bytes >= least {
            *self = Self::new(now);
        }
    }
}
