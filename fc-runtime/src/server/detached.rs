//! Handlers that run on though nobody waits for their answer any more.

use super::budget::Charge;
use super::running_handler::RunningHandler;
use crate::sync::lock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::task::{Context, Poll, ready};
use tokio::runtime::Handle;
use tokio::task::JoinSet;

/// What all connections of a server share.
pub(super) struct DetachedHandlers {
    limit: usize,
    running: Arc<AtomicUsize>,
    /// `None` once the server is over.
    tasks: Mutex<Option<JoinSet<()>>>,
}

impl DetachedHandlers {
    /// So many may run on before no more of their kind are begun; with 0, none runs on.
    pub(super) fn new(limit: usize) -> Self {
        Self {
            limit,
            running: Arc::default(),
            tasks: Mutex::new(Some(JoinSet::new())),
        }
    }

    /// Whether as many run on as may: no handler that might join them is begun then, so that none
    /// that has begun must be dropped.
    pub(super) fn is_full(&self) -> bool {
        self.limit > 0 && self.running.load(Ordering::Relaxed) >= self.limit
    }

    /// Lets a handler run on in a task of its own, to its end or to that of the server. `false` if
    /// none may, and it has been dropped.
    pub(super) fn take_over(&self, mut handler: Box<dyn RunningHandler>, request: Charge) -> bool {
        // Without a runtime there is no server any more either.
        let Ok(runtime) = Handle::try_current() else {
            return false;
        };
        if self.limit == 0 {
            return false;
        }
        let count = RunningHandlerCount::take(&self.running);
        let task = async move {
            std::future::poll_fn(|cx| handler.poll(cx, false)).await;
            drop((handler, request, count));
        };
        let mut guard = self.lock();
        let Some(tasks) = guard.as_mut() else {
            // Not under the lock: what is dropped is the user's.
            drop(guard);
            return false;
        };
        // Those that have ended are of no interest, but they take room.
        while tasks.try_join_next().is_some() {}
        tasks.spawn_on(task, &runtime);
        true
    }

    /// Ready once none runs on.
    pub(super) fn poll_ended(&self, cx: &mut Context<'_>) -> Poll<()> {
        if let Some(tasks) = self.lock().as_mut() {
            while ready!(tasks.poll_join_next(cx)).is_some() {}
        }
        Poll::Ready(())
    }

    /// Drops all of them, and all that are still to come.
    pub(super) fn abort(&self) {
        let tasks = self.lock().take();
        drop(tasks);
    }

    fn lock(&self) -> MutexGuard<'_, Option<JoinSet<()>>> {
        lock(&self.tasks)
    }
}

/// One of those that run on.
struct RunningHandlerCount(Arc<AtomicUsize>);

impl RunningHandlerCount {
    fn take(running: &Arc<AtomicUsize>) -> Self {
        running.fetch_add(1, Ordering::Relaxed);
        Self(Arc::clone(running))
    }
}

impl Drop for RunningHandlerCount {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}
