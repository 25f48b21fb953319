//! The thread that checks snapshots, and answers the requests that need a check.

use crate::dispatch::{answer, refusal};
use crate::event::Event;
use crate::queue::{Queue, Work};
use crate::snapshot::Snapshot;
use lsp_server::{ErrorCode, Request, RequestId};
use std::panic::resume_unwind;
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

pub struct Worker {
    shared: Arc<Shared>,
    thread: JoinHandle<()>,
}

/// Tells the loop that the thread has ended, even after a panic.
struct Leaving(SyncSender<Event>);

impl Drop for Leaving {
    fn drop(&mut self) {
        // If the loop has ended, the event is not needed.
        let _ = self.0.send(Event::End);
    }
}

/// A request and its snapshot.
type Asked = (Request, Arc<Snapshot>);

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    queue: Queue<Arc<Snapshot>, Asked>,
    is_over: bool,
}

impl Shared {
    /// Locks the state. Every change under the lock is complete, so a poisoned lock is safe to use.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for the next job. Returns `None` after [`Worker::end`].
    fn next(&self) -> Option<Work<Arc<Snapshot>, Asked>> {
        let mut state = self.state();
        loop {
            if state.is_over {
                return None;
            }
            if let Some(work) = state.queue.next() {
                return Some(work);
            }
            let woken = self.changed.wait(state);
            state = woken.unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Worker {
    /// Starts the thread. It sends its results to `events`.
    pub fn start(events: SyncSender<Event>) -> Self {
        let shared = Arc::new(Shared::default());
        let own = Arc::clone(&shared);
        let thread = std::thread::spawn(move || {
            let events = Leaving(events);
            while let Some(work) = own.next() {
                if !work_on(work, &events.0) {
                    return;
                }
            }
        });
        Self { shared, thread }
    }

    /// Queues a snapshot in place of the waiting one.
    pub fn check(&self, snapshot: Arc<Snapshot>) {
        self.shared.state().queue.check(snapshot);
        self.shared.changed.notify_one();
    }

    /// Queues a request behind the check of its snapshot. Returns `Err` if the queue is full.
    pub fn ask(&self, request: Request, snapshot: Arc<Snapshot>) -> Result<(), RequestId> {
        let id = request.id.clone();
        self.shared.state().queue.ask(id, (request, snapshot))?;
        self.shared.changed.notify_one();
        Ok(())
    }

    /// Removes a request. Returns `true` if it was waiting, so that the caller must answer it.
    pub fn cancel(&self, id: &RequestId) -> bool {
        self.shared.state().queue.cancel(id)
    }

    /// Empties the queue and returns the requests that were waiting.
    pub fn clear(&self) -> Vec<RequestId> {
        self.shared.state().queue.clear()
    }

    /// Ends the thread and waits for it. Resumes a panic of the thread here.
    pub fn end(self) {
        self.shared.state().is_over = true;
        self.shared.changed.notify_one();
        if let Err(panic) = self.thread.join() {
            resume_unwind(panic);
        }
    }
}

/// Does one job. Returns `false` if the loop no longer receives.
fn work_on(work: Work<Arc<Snapshot>, Asked>, events: &SyncSender<Event>) -> bool {
    let event = match work {
        Work::Check(snapshot) => {
            let _ = snapshot.analysis();
            if events.send(Event::Checked(Arc::clone(&snapshot))).is_err() {
                return false;
            }
            // Lenses show the differences from the last release. The loop does not wait for this comparison.
            let _ = snapshot.known().findings();
            Event::Compared(snapshot)
        }
        Work::Answer(_, (request, snapshot)) if snapshot.is_checked() => {
            Event::Answered(answer(request, Some(&snapshot)))
        }
        // A newer snapshot was checked instead.
        Work::Answer(id, _) => {
            let code = ErrorCode::ContentModified;
            Event::Answered(refusal(id, code, "the text has changed since"))
        }
    };
    events.send(event).is_ok()
}
