//! Whether bytes come, or go, as fast as they have to.

use std::time::{Duration, Instant};

/// So many bytes in so much time are progress; fewer are none. A byte now and then would otherwise
/// hold whatever has come before it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MinimumRate {
    pub(crate) bytes: usize,
    pub(crate) within: Duration,
}

impl MinimumRate {
    /// `rate` in bytes per second.
    pub(crate) fn new(rate: u32, within: Duration) -> Self {
        let bytes = within.as_millis().saturating_mul(rate.into()) / 1000;
        Self {
            bytes: usize::try_from(bytes).unwrap_or(usize::MAX).max(1),
            within,
        }
    }
}

/// How far it has come since there was enough of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RateMeter<I = Instant> {
    /// When there was, or when it began to matter.
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

    /// Counts bytes that have come, or gone.
    pub(crate) fn add(&mut self, bytes: usize, least: usize, now: I) {
        self.bytes = self.bytes.saturating_add(bytes);
        if self.bytes >= least {
            *self = Self::new(now);
        }
    }
}
