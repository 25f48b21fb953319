//! The current time.

use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Returns the milliseconds since 1970-01-01T00:00:00Z.
#[must_use]
pub(crate) fn unix_ms() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |since| {
        i64::try_from(since.as_millis()).unwrap_or(i64::MAX)
    })
}

/// Returns the time for deadlines. It comes from tokio, so that tests can stop it.
#[must_use]
pub(crate) fn now() -> Instant {
    tokio::time::Instant::now().into_std()
}

/// Returns the first message id: the local time of day as the decimal digits `HHmmssSSS`.
#[must_use]
pub(crate) fn first_id() -> u32 {
    let time = jiff::Zoned::now().time();
    let part = |part: i8| u32::try_from(part).unwrap_or(0);
    let milliseconds = u32::try_from(time.millisecond()).unwrap_or(0);
    ((part(time.hour()) * 100 + part(time.minute())) * 100 + part(time.second())) * 1000
        + milliseconds
}
