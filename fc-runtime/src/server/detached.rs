//! Handlers that run on without a waiting app.

use super::budget::Charge;
use super::running_handler::RunningHandler;
use crate::sync::lock;
use std::sync::{Arc, Mutex, MutexGuard};
use std::task::{Context, Poll, ready};
use tokio::runtime::Handle;
use tokio::task::JoinSet;

/// The detached handlers of all connections of a server.
pub(super) struct DetachedHandlers {
    limit: usize,
    /// Cloned for each running handler.
    running: Arc<()>,
    /// `None` after the end of the server.
    tasks: Mutex<Option<JoinSet<()>>>,
}

impl DetachedHandlers {
    /// Creates the set. Up to `limit` handlers may run on before no more of their kind are started. With 0, none runs
    /// on.
    pub(super) fn new(limit: usize) -> Self {
        Self {
            limit,
            running: Arc::default(),
            tasks: Mutex::new(Some(JoinSet::new())),
        }
    }

    /// Returns `true` at the limit. No handler that might run on is started then, so that no started one must be
    /// dropped.
    pub(super) fn is_full(&self) -> bool {
        self.limit > 0 && Arc::strong_count(&self.running) > self.limit
    }

    /// Lets a handler run on in its own task to its end or to that of the server. Returns `false` if this is not
    /// possible; the handler has been dropped.
    pub(super) fn take_over(&self, mut handler: Box<dyn RunningHandler>, request: Charge) -> bool {
        // Without a runtime the server has ended.
        let Ok(runtime) = Handle::try_current() else {
            return false;
        };
        if self.limit == 0 {
            return false;
        }
        let count = Arc::clone(&self.running);
        let task = async move {
            std::future::poll_fn(|cx| handler.poll(cx, false)).await;
            drop((handler, request, count));
        };
        let mut guard = self.lock();
        let Some(tasks) = guard.as_mut() else {
            // Unlock first, because dropping the handler runs code of the user.
            drop(guard);
            return false;
        };
        // Remove ended tasks, because they take memory.
        while tasks.try_join_next().is_some() {}
        tasks.spawn_on(task, &runtime);
        true
    }

    /// Ready when no handler runs.
    pub(super) fn poll_ended(&self, cx: &mut Context<'_>) -> Poll<()> {
        if let Some(tasks) = self.lock().as_mut() {
            while ready!(tasks.poll_join_next(cx)).is_some() {}
        }
        Poll::Ready(())
    }

    /// Drops all handlers, also those added later.
    pub(super) fn abort(&self) {
        let tasks = self.lock().take();
        drop(tasks);
    }

    fn lock(&self) -> MutexGuard<'_, Option<JoinSet<()>>> {
        lock(&self.tasks)
    }
}
