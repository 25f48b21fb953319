//! Locks, wakers and timers of tasks that share state.

use std::pin::Pin;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::task::{Context, Waker};
use std::time::{Duration, Instant};
use tokio::time::{Sleep, sleep};

/// Locks a mutex, even after a panic of a holder. So every holder must leave the data consistent, whatever panics.
pub(crate) fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Registers the task of `cx`, in place of any earlier one.
pub(crate) fn register(waker: &mut Option<Waker>, cx: &Context<'_>) {
    match waker {
        Some(waker) => waker.clone_from(cx.waker()),
        none => *none = Some(cx.waker().clone()),
    }
}

/// A timer that wakes its task at a time or earlier.
///
/// Most deadlines move on before they pass. So the timer is reset only for an earlier time.
pub(crate) struct Alarm {
    sleep: Pin<Box<Sleep>>,
    at: Option<Instant>,
}

impl Alarm {
    pub(crate) fn new() -> Self {
        Self {
            sleep: Box::pin(sleep(Duration::ZERO)),
            at: None,
        }
    }

    /// Returns the time at which the timer is set to wake the task.
    #[cfg(feature = "client")]
    pub(crate) fn at(&self) -> Option<Instant> {
        self.at
    }

    /// Forgets a time that has passed.
    #[cfg(feature = "client")]
    pub(crate) fn forget_past(&mut self, now: Instant) {
        self.at = self.at.filter(|at| *at > now);
    }

    /// Wakes the task of `cx` at `due` or earlier.
    pub(crate) fn set(&mut self, cx: &mut Context<'_>, due: Instant) {
        if self.at.is_none_or(|at| due < at) {
            self.sleep.as_mut().reset(due.into());
            self.at = Some(due);
        }
        if self.sleep.as_mut().poll(cx).is_ready() {
            self.at = None;
            cx.waker().wake_by_ref();
        }
    }
}
