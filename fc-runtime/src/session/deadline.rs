//! Deadlines.

use std::time::{Duration, Instant};

/// A wait that is practically endless.
const FAR: Duration = Duration::from_secs(60 * 60 * 24 * 365);

/// Returns the time `wait` after `now`. A wait beyond the range of the clock is cut to a year.
pub(crate) fn after(now: Instant, wait: Duration) -> Instant {
    now.checked_add(wait)
        .unwrap_or_else(|| now.checked_add(FAR).unwrap_or(now))
}
