//! Queues of reports for the receivers of an app.

use super::loss::Loss;
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

/// The queue of one receiver.
#[derive(Debug)]
pub(super) struct Queue {
    receiver: u64,
    /// The only accepted code; `None` for any code.
    code: Option<u16>,
    /// Reports, each with the events before it.
    reports: VecDeque<(Before, RawReport)>,
    /// Events after the last report.
    since: Before,
    /// `true` from a loss to the next connection.
    is_cut: bool,
    bytes: usize,
    /// Missed reports since the last query.
    pub(super) missed: u64,
    pub(super) waker: Option<Waker>,
}

/// Events between two reports in a queue.
#[derive(Debug, Default)]
struct Before {
    /// Reports without room in the queue.
    missed: u64,
    /// Loss of the connection.
    lost: Option<Loss>,
    /// `true` if there was a connection again.
    connected: bool,
}

/// An event for a follower of a process.
#[derive(Debug)]
pub(super) enum Event {
    Missed(u64),
    Lost(Loss),
    Connected,
    Report(RawReport),
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

    /// Queues a report for all receivers with room for it, so that it can be acknowledged. Returns the number of
    /// receivers without room, or `None` if no receiver got it and the robot must send it again.
    pub(super) fn push(&mut self, report: RawReport, wakers: &mut Vec<Waker>) -> Option<u64> {
        let bytes = report.text.len();
        let (limit, bytes_limit) = (self.limit, self.bytes_limit);
        let code = report.code;
        let is_for = |queue: &Queue| queue.code.is_none_or(|only| only == code);
        let has_room = |queue: &Queue| {
            queue.reports.len() < limit && queue.bytes.saturating_add(bytes) <= bytes_limit
        };
        let mut takers = self
            .receivers
            .iter()
            .filter(|queue| is_for(queue) && has_room(queue))
            .count();
        if takers == 0 {
            return None;
        }
        let mut missed = 0;
        let mut report = Some(report);
        for queue in self.receivers.iter_mut().filter(|queue| is_for(queue)) {
            if !has_room(queue) {
                queue.missed += 1;
                queue.since.missed += 1;
                missed += 1;
                continue;
            }
            takers -= 1;
            // The last receiver gets the original, the others get copies.
            let given = if takers == 0 {
                report.take()
            } else {
                report.clone()
            };
            queue.bytes += bytes;
            let before = std::mem::take(&mut queue.since);
            queue.reports.extend(given.map(|report| (before, report)));
            wakers.extend(queue.waker.take());
        }
        Some(missed)
    }

    /// Wakes all receivers, such as after the end of the connection.
    pub(super) fn wake(&mut self, wakers: &mut Vec<Waker>) {
        wakers.extend(
            self.receivers
                .iter_mut()
                .filter_map(|queue| queue.waker.take()),
        );
    }

    /// Adds a loss of the connection to all queues.
    pub(super) fn lost(&mut self, why: Loss, wakers: &mut Vec<Waker>) {
        for queue in &mut self.receivers {
            queue.is_cut = true;
            queue.since.lost = Some(why);
            queue.since.connected = false;
        }
        self.wake(wakers);
    }

    /// Adds a new connection to all queues.
    pub(super) fn connected(&mut self, wakers: &mut Vec<Waker>) {
        for queue in &mut self.receivers {
            queue.since.connected |= std::mem::take(&mut queue.is_cut);
        }
        self.wake(wakers);
    }

    /// Adds a receiver for reports with this code, or for all reports. Returns its number.
    pub(super) fn add(&mut self, code: Option<u16>) -> u64 {
        self.next += 1;
        self.receivers.push(Queue {
            receiver: self.next,
            code,
            reports: VecDeque::new(),
            since: Before::default(),
            is_cut: false,
            bytes: 0,
            missed: 0,
            waker: None,
        });
        self.next
    }

    pub(super) fn remove(&mut self, receiver: u64) {
        self.receivers.retain(|queue| queue.receiver != receiver);
    }

    /// Returns the queue of a receiver.
    pub(super) fn get(&mut self, receiver: u64) -> Option<&mut Queue> {
        self.receivers
            .iter_mut()
            .find(|queue| queue.receiver == receiver)
    }
}

impl Queue {
    /// Takes the oldest report.
    pub(super) fn pop(&mut self) -> Option<RawReport> {
        let (_, report) = self.reports.pop_front()?;
        self.bytes -= report.text.len();
        Some(report)
    }

    /// Takes the next report or event.
    pub(super) fn next(&mut self) -> Option<Event> {
        let before = match self.reports.front_mut() {
            Some((before, _)) => before,
            None => &mut self.since,
        };
        let missed = std::mem::take(&mut before.missed);
        if missed > 0 {
            return Some(Event::Missed(missed));
        }
        if let Some(why) = before.lost.take() {
            return Some(Event::Lost(why));
        }
        if std::mem::take(&mut before.connected) {
            return Some(Event::Connected);
        }
        self.pop().map(Event::Report)
    }
}
