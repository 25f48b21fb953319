//! Processing of large frames, one at a time.
//!
//! Checking, inflating and reading a frame of many MiB occupies a thread for many milliseconds. A server does this for
//! one connection at a time. So large frames occupy neither all threads nor the memory for one body per connection.

use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use tokio::runtime::{Handle, RuntimeFlavor};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::task::block_in_place;

/// Amount of work from which a frame is large, in bytes.
pub(super) const LARGE: usize = 256 * 1024;

/// The gate of a server, which its connections pass in order of arrival.
#[derive(Clone, Debug)]
pub(super) struct Gate(Arc<Semaphore>);

impl Default for Gate {
    fn default() -> Self {
        Self(Arc::new(Semaphore::new(1)))
    }
}

impl Gate {
    /// Waits for the permission to process a large frame.
    pub(super) async fn pass(self) -> Pass {
        // The semaphore is never closed. If it were, no connection would have to wait.
        Pass(self.0.acquire_owned().await.ok())
    }
}

/// The place of a connection in the queue at the gate.
pub(super) struct GateQueue {
    gate: Gate,
    waiting: Option<Pin<Box<dyn Future<Output = Pass> + Send>>>,
    asked: bool,
}

impl GateQueue {
    pub(super) fn new(gate: Gate) -> Self {
        Self {
            gate,
            waiting: None,
            asked: false,
        }
    }

    /// Polls for the permission to process a large frame.
    pub(super) fn poll_pass(&mut self, cx: &mut Context<'_>) -> Poll<Pass> {
        self.asked = true;
        let waiting = self
            .waiting
            .get_or_insert_with(|| Box::pin(self.gate.clone().pass()));
        let pass = ready!(waiting.as_mut().poll(cx));
        self.waiting = None;
        Poll::Ready(pass)
    }

    /// Returns `true` if the connection waits for its turn.
    pub(super) fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    /// Leaves the queue if the connection has not polled since the last call. A connection that cannot continue must
    /// not block others.
    pub(super) fn keep_if_asked(&mut self) {
        if !std::mem::take(&mut self.asked) {
            self.waiting = None;
        }
    }
}

/// The permission to process one frame.
pub(super) struct Pass(#[allow(dead_code, reason = "held")] Option<OwnedSemaphorePermit>);

/// Processes a frame. For a large frame on a multi-threaded runtime, other tasks move to another thread.
pub(super) fn process_frame<T>(pass: Option<&Pass>, work: impl FnOnce() -> T) -> T {
    let runtime = pass.and_then(|_| Handle::try_current().ok());
    match runtime.map(|runtime| runtime.runtime_flavor()) {
        Some(RuntimeFlavor::MultiThread) => block_in_place(work),
        _ => work(),
    }
}
