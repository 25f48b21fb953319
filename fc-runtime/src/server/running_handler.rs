//! Running handlers, independent of protocol and response.

use crate::operation::Effect;
use std::task::{Context, Poll};

/// Returns `true` if a handler must not stop when its app is gone, because it may move something.
pub(super) fn outlives(effect: Effect) -> bool {
    matches!(effect, Effect::Motion | Effect::Unknown)
}

/// A handler that was not ready at once.
pub(super) trait RunningHandler: Send {
    /// Continues the handler. When it ends, its response is sent if `waits` is `true`. Does not panic.
    fn poll(&mut self, cx: &mut Context<'_>, waits: bool) -> Poll<()>;

    /// Returns `true` if the handler runs to its end without a waiting app.
    fn outlives(&self) -> bool;
}

/// A running handler, and the memory of its request in bytes.
pub(super) struct StartedHandler {
    pub(super) handler: Box<dyn RunningHandler>,
    pub(super) weight: usize,
}
