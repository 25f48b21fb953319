//! Whether anybody listens to spans.

use tracing::level_filters::LevelFilter;

/// Whether a span at debug level may reach a subscriber.
///
/// `tracing` asks the same before it makes one; but where another crate has switched its `log`
/// feature on, a span that nobody listens to still has its fields looked at in every call.
#[inline]
pub(crate) fn is_traced() -> bool {
    LevelFilter::current() >= LevelFilter::DEBUG
}
