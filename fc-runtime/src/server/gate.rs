//! Large frames: one at a time, and not in the way of everybody else.
//!
//! To check, inflate and read a frame of many MiB takes many milliseconds, in which a thread serves
//! nobody else. A server does so for one connection at a time, so that neither all of its threads
//! nor the memory for a body of every connection are taken up.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};
use tokio::runtime::{Handle, RuntimeFlavor};
use tokio::task::block_in_place;

/// From this much work on, in bytes, a frame is large.
pub(crate) const LARGE: u64 = 256 * 1024;

/// What all connections of a server share.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gate(Arc<Mutex<State>>);

#[derive(Debug, Default)]
struct State {
    taken: bool,
    waiting: Vec<Waker>,
}

impl Gate {
    /// Leave to deal with a large frame. It is not queued for: a connection that is woken asks again, so that
    /// one who cannot go on meanwhile keeps nobody waiting.
    pub(crate) fn poll_pass(&self, cx: &mut Context<'_>) -> Poll<Pass> {
        let mut state = self.lock();
        if !state.taken {
            state.taken = true;
            return Poll::Ready(Pass(self.clone()));
        }
        if !state
            .waiting
            .iter()
            .any(|waker| waker.will_wake(cx.waker()))
        {
            state.waiting.push(cx.waker().clone());
        }
        Poll::Pending
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Leave to deal with one frame, now.
pub(crate) struct Pass(Gate);

impl Pass {
    /// Does the work; the runtime lets another thread see to the other tasks meanwhile, provided
    /// that it has several.
    pub(crate) fn through<T>(self, work: impl FnOnce() -> T) -> T {
        let runtime = Handle::try_current().map(|runtime| runtime.runtime_flavor());
        let done = if matches!(runtime, Ok(RuntimeFlavor::MultiThread)) {
            block_in_place(work)
        } else {
            work()
        };
        drop(self);
        done
    }
}

impl Drop for Pass {
    fn drop(&mut self) {
        let waiting = {
            let mut state = self.0.lock();
            state.taken = false;
            std::mem::take(&mut state.waiting)
        };
        waiting.into_iter().for_each(Waker::wake);
    }
}
