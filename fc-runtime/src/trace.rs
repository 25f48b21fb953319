//! A fast check for enabled spans.

use tracing::level_filters::LevelFilter;

/// Returns `true` if a subscriber may accept spans at debug level.
///
/// `tracing` checks the same before it creates a span. But if another crate enables its feature `log`, the fields of a
/// span are evaluated in every call even without a subscriber.
#[inline]
pub(crate) fn is_traced() -> bool {
    LevelFilter::current() >= LevelFilter::DEBUG
}
