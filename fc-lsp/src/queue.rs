//! The queue of the worker: the newest snapshot to check, and the requests behind it.

use lsp_server::RequestId;
use std::collections::VecDeque;

/// The maximum number of waiting requests.
const REQUESTS: usize = 64;

/// The queue. A newer snapshot replaces a waiting one.
#[derive(Debug)]
pub struct Queue<S, R> {
    newest: Option<S>,
    requests: VecDeque<(RequestId, R)>,
}

/// The next job of the worker.
#[derive(Debug, PartialEq, Eq)]
pub enum Work<S, R> {
    /// Check a snapshot.
    Check(S),
    /// Answer a request.
    Answer(RequestId, R),
}

impl<S, R> Default for Queue<S, R> {
    fn default() -> Self {
        Self {
            newest: None,
            requests: VecDeque::new(),
        }
    }
}

impl<S, R> Queue<S, R> {
    /// Queues a snapshot in place of the waiting one.
    pub fn check(&mut self, snapshot: S) {
        self.newest = Some(snapshot);
    }

    /// Queues a request behind the check. Returns `Err` if the queue is full.
    pub fn ask(&mut self, id: RequestId, request: R) -> Result<(), RequestId> {
        if self.requests.len() >= REQUESTS {
            return Err(id);
        }
        self.requests.push_back((id, request));
        Ok(())
    }

    /// Removes a request. Returns `true` if it was waiting.
    pub fn cancel(&mut self, id: &RequestId) -> bool {
        let before = self.requests.len();
        self.requests.retain(|(known, _)| known != id);
        self.requests.len() < before
    }

    /// Empties the queue and returns the requests that were waiting.
    pub fn clear(&mut self) -> Vec<RequestId> {
        self.newest = None;
        self.requests.drain(..).map(|(id, _)| id).collect()
    }

    /// Returns the next job. The check comes first, because requests depend on it.
    pub fn next(&mut self) -> Option<Work<S, R>> {
        if let Some(newest) = self.newest.take() {
            return Some(Work::Check(newest));
        }
        let (id, request) = self.requests.pop_front()?;
        Some(Work::Answer(id, request))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(id: i32) -> RequestId {
        id.into()
    }

    #[test]
    fn newest_snapshot_is_checked_before_requests() {
        let mut queue = Queue::default();
        queue.check("old");
        assert_eq!(queue.ask(id(1), "first"), Ok(()));
        queue.check("new");
        assert_eq!(queue.ask(id(2), "second"), Ok(()));
        assert_eq!(queue.next(), Some(Work::Check("new")));
        assert_eq!(queue.next(), Some(Work::Answer(id(1), "first")));
        queue.check("newer");
        assert_eq!(queue.next(), Some(Work::Check("newer")));
        assert_eq!(queue.next(), Some(Work::Answer(id(2), "second")));
        assert_eq!(queue.next(), None);
    }

    #[test]
    fn cancelled_request_is_not_answered() {
        let mut queue = Queue::<(), _>::default();
        for at in 1..=3 {
            assert_eq!(queue.ask(id(at), at), Ok(()));
        }
        assert!(queue.cancel(&id(2)));
        assert!(!queue.cancel(&id(2)));
        assert_eq!(queue.next(), Some(Work::Answer(id(1), 1)));
        assert!(!queue.cancel(&id(1)));
        assert_eq!(queue.clear(), [id(3)]);
        assert_eq!(queue.next(), None);
    }

    #[test]
    fn no_more_wait_than_can() {
        let mut queue = Queue::<(), _>::default();
        let all: Vec<i32> = (0..).take(REQUESTS).collect();
        for at in &all {
            assert_eq!(queue.ask(id(*at), ()), Ok(()));
        }
        assert_eq!(queue.ask(id(-1), ()), Err(id(-1)));
        assert!(queue.cancel(&id(0)));
        assert_eq!(queue.ask(id(-1), ()), Ok(()));
    }
}
