//! When a wait is over.

use std::time::{Duration, Instant};

/// As good as never.
const FAR: Duration = Duration::from_secs(60 * 60 * 24 * 365);

/// The time `wait` after `now`; a wait too long for the clock is cut to one that nobody lives to see.
pub(crate) fn after(now: Instant, wait: Duration) -> Instant {
    now.checked_add(wait)
        .unwrap_or_else(|| now.checked_add(FAR).unwrap_or(now))
}
