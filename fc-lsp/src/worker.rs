//! The thread that checks, and answers what can only be answered then.

use crate::dispatch::{answer, refusal};
use crate::queue::{Queue, Work};
use crate::serve::Event;
use crate::snapshot::Snapshot;
use lsp_server::{ErrorCode, Request, RequestId};
use std::panic::resume_unwind;
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

/// The thread.
pub struct Worker {
    shared: Arc<Shared>,
    thread: JoinHandle<()>,
}

/// Tells the loop when the thread ends, should it panic, too.
struct Leaving(SyncSender<Event>);

impl Drop for Leaving {
    fn drop(&mut self) {
        // To a loop that has ended itself nothing need be said.
        let _ = self.0.send(Event::End);
    }
}

/// A request and the snapshot that it is about.
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
    /// Nothing is left half done under the lock, so it may be taken after any fault of who had it.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for what is to be done next; `None` when it is over.
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
    /// Starts it; `events` is where it says what it has done.
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

    /// Has a snapshot checked, in place of the one that waits for it.
    pub fn check(&self, snapshot: Arc<Snapshot>) {
        self.shared.state().queue.check(snapshot);
        self.shared.changed.notify_one();
    }

    /// Has a request answered when its snapshot has been checked; `Err` where too many wait.
    pub fn ask(&self, request: Request, snapshot: Arc<Snapshot>) -> Result<(), RequestId> {
        let id = request.id.clone();
        self.shared.state().queue.ask(id, (request, snapshot))?;
        self.shared.changed.notify_one();
        Ok(())
    }

    /// Takes a request back. Whether it has waited, so that it has no answer.
    pub fn cancel(&self, id: &RequestId) -> bool {
        self.shared.state().queue.cancel(id)
    }

    /// Takes everything back; the requests that have waited.
    pub fn clear(&self) -> Vec<RequestId> {
        self.shared.state().queue.clear()
    }

    /// Ends the thread and waits for it. A panic there is one here.
    pub fn end(self) {
        self.shared.state().is_over = true;
        self.shared.changed.notify_one();
        if let Err(panic) = self.thread.join() {
            resume_unwind(panic);
        }
    }
}

/// Whether there is still a loop that hears of it.
fn work_on(work: Work<Arc<Snapshot>, Asked>, events: &SyncSender<Event>) -> bool {
    let event = match work {
        Work::Check(snapshot) => {
            let _ = snapshot.analysis();
            if events.send(Event::Checked(Arc::clone(&snapshot))).is_err() {
                return false;
            }
            // Lenses show what differs from the last release; the loop need not wait for that either.
            let _ = snapshot.known().findings();
            Event::Compared(snapshot)
        }
        Work::Answer(_, (request, snapshot)) if snapshot.is_checked() => {
            Event::Answered(answer(request, Some(&snapshot)))
        }
        // A later snapshot was checked in place of its own.
        Work::Answer(id, _) => {
            let code = ErrorCode::ContentModified;
            Event::Answered(refusal(id, code, "the text has changed since"))
        }
    };
    events.send(event).is_ok()
}
