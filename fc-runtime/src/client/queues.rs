//! Reports on their way to the app: what waits for each of its receivers.

use crate::raw::RawReport;
use std::collections::VecDeque;
use std::task::Waker;

/// A bounded queue for each receiver.
#[derive(Debug)]
pub(super) struct Queues {
    receivers: Vec<Queue>,
    limit: usize,
    bytes_limit: usize,
    next: u64,
}

/// What waits for one receiver.
#[derive(Debug)]
pub(super) struct Queue {
    receiver: u64,
    reports: VecDeque<RawReport>,
    bytes: usize,
    /// Since it was last asked.
    pub(super) missed: u64,
    pub(super) waker: Option<Waker>,
}

impl Queues {
    pub(super) fn new(limit: usize, bytes_limit: usize) -> Self {
        Self {
            receivers: Vec::new(),
            limit,
            bytes_limit,
            next: 0,
        }
    }

    /// Gives a report to all receivers that have room for it: acknowledge it. Says how many had none.
    /// `None` if nobody has got it: leave it to the robot to send it again.
    pub(super) fn push(&mut self, report: RawReport, wakers: &mut Vec<Waker>) -> Option<u64> {
        let bytes = report.text.len();
        let (limit, bytes_limit) = (self.limit, self.bytes_limit);
        let has_room = |queue: &Queue| {
            queue.reports.len() < limit && queue.bytes.saturating_add(bytes) <= bytes_limit
        };
        let mut takers = self
            .receivers
            .iter()
            .filter(|queue| has_room(queue))
            .count();
        if takers == 0 {
            return None;
        }
        let mut missed = 0;
        let mut report = Some(report);
        for queue in &mut self.receivers {
            if !has_room(queue) {
                queue.missed += 1;
                missed += 1;
                continue;
            }
            takers -= 1;
            // The last one takes what the others have copies of.
            let given = if takers == 0 {
                report.take()
            } else {
                report.clone()
            };
            queue.bytes += bytes;
            queue.reports.extend(given);
            wakers.extend(queue.waker.take());
        }
        Some(missed)
    }

    /// Wakes all that wait, as when the connection is closed.
    pub(super) fn wake(&mut self, wakers: &mut Vec<Waker>) {
        wakers.extend(
            self.receivers
                .iter_mut()
                .filter_map(|queue| queue.waker.take()),
        );
    }

    /// One more receiver, by the number that it has from now on.
    pub(super) fn enter(&mut self) -> u64 {
        self.next += 1;
        self.receivers.push(Queue {
            receiver: self.next,
            reports: VecDeque::new(),
            bytes: 0,
            missed: 0,
            waker: None,
        });
        self.next
    }

    pub(super) fn leave(&mut self, receiver: u64) {
        self.receivers.retain(|queue| queue.receiver != receiver);
    }

    /// What waits for this receiver.
    pub(super) fn of(&mut self, receiver: u64) -> Option<&mut Queue> {
        self.receivers
            .iter_mut()
            .find(|queue| queue.receiver == receiver)
    }
}

impl Queue {
    /// The oldest report.
    pub(super) fn pop(&mut self) -> Option<RawReport> {
        let report = self.reports.pop_front()?;
        self.bytes -= report.text.len();
        Some(report)
    }
}
