//! A handler at handler as those see it who go on with it: neither its protocol nor its answer is told.

use crate::operation::Effect;
use std::task::{Context, Poll};

/// What moves must not stop because an app is gone, and what nobody knows may move.
pub(super) fn outlives(effect: Effect) -> bool {
    matches!(effect, Effect::Motion | Effect::Unknown)
}

/// A handler that was not ready at once.
pub(super) trait RunningHandler: Send {
    /// Goes on with it; once it has ended, its answer is sent if somebody `waits` for it. Does not
    /// panic.
    fn poll(&mut self, cx: &mut Context<'_>, waits: bool) -> Poll<()>;

    /// Whether it runs to its end also when nobody waits for its answer any more.
    fn outlives(&self) -> bool;
}

/// A handler at handler, and how much memory its request takes, in bytes.
pub(super) struct StartedHandler {
    pub(super) handler: Box<dyn RunningHandler>,
    pub(super) weight: usize,
}
