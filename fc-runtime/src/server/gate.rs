//! Large frames: one at a time, and not in the way of everybody else.
//!
//! To check, inflate and read a frame of many MiB takes many milliseconds, in which a thread serves
//! nobody else. A server does so for one connection at a time, so that neither all of its threads
//! nor the memory for a body of every connection are taken up.

use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use tokio::runtime::{Handle, RuntimeFlavor};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::task::block_in_place;

/// From this much work on, in bytes, a frame is large.
pub(super) const LARGE: usize = 256 * 1024;

/// What all connections of a server share: who comes first has his turn first.
#[derive(Clone, Debug)]
pub(super) struct Gate(Arc<Semaphore>);

impl Default for Gate {
    fn default() -> Self {
        Self(Arc::new(Semaphore::new(1)))
    }
}

impl Gate {
    /// Waits for leave to deal with a large frame.
    pub(super) async fn pass(self) -> Pass {
        // It is never closed; were it, nobody would have to wait.
        Pass(self.0.acquire_owned().await.ok())
    }
}

/// The place of a connection in the queue before the gate.
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

    /// Leave to deal with a large frame.
    pub(super) fn poll_pass(&mut self, cx: &mut Context<'_>) -> Poll<Pass> {
        self.asked = true;
        let waiting = self
            .waiting
            .get_or_insert_with(|| Box::pin(self.gate.clone().pass()));
        let pass = ready!(waiting.as_mut().poll(cx));
        self.waiting = None;
        Poll::Ready(pass)
    }

    /// Whether it waits for its turn.
    pub(super) fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    /// Leaves the queue if it has not asked since this was last called: one who cannot go on
    /// meanwhile keeps nobody waiting.
    pub(super) fn keep_if_asked(&mut self) {
        if !std::mem::take(&mut self.asked) {
            self.waiting = None;
        }
    }
}

/// Leave to deal with one frame, now.
pub(super) struct Pass(#[allow(dead_code, reason = "held")] Option<OwnedSemaphorePermit>);

/// Does the work on a frame. If that is large, the runtime lets another thread see to the other tasks
/// meanwhile, provided that it has several.
pub(super) fn through<T>(pass: Option<&Pass>, work: impl FnOnce() -> T) -> T {
    let runtime = pass.and_then(|_| Handle::try_current().ok());
    match runtime.map(|runtime| runtime.runtime_flavor()) {
        Some(RuntimeFlavor::MultiThread) => block_in_place(work),
        _ => work(),
    }
}
