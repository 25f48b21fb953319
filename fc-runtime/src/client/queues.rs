//! Reports on their way to the app: what waits for each of its receivers.

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

/// What waits for one receiver.
#[derive(Debug)]
pub(super) struct Queue {
    receiver: u64,
    /// The only code that it takes; `None` for any.
    code: Option<u16>,
    /// Each with what was before it.
    reports: VecDeque<(Before, RawReport)>,
    /// What has been since the last of them.
    since: Before,
    /// Whether there has been no connection since it was lost.
    is_cut: bool,
    bytes: usize,
    /// Since it was last asked.
    pub(super) missed: u64,
    pub(super) waker: Option<Waker>,
}

/// What a receiver has not got, between one report and the next.
#[derive(Debug, Default)]
struct Before {
    /// Reports for which it had no room.
    missed: u64,
    /// The connection was lost.
    lost: Option<Loss>,
    /// There was a connection again.
    connected: bool,
}

/// An event of a process that is being followed.
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

    /// Gives a report to all receivers that have room for it: acknowledge it. Says how many had none.
    /// `None` if nobody has got it: leave it to the robot to send it again.
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
            // The last one takes what the others have copies of.
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

    /// Wakes all that wait, as when the connection is closed.
    pub(super) fn wake(&mut self, wakers: &mut Vec<Waker>) {
        wakers.extend(
            self.receivers
                .iter_mut()
                .filter_map(|queue| queue.waker.take()),
        );
    }

    /// The connection has been lost: notes it where the next report will come.
    pub(super) fn lost(&mut self, why: Loss, wakers: &mut Vec<Waker>) {
        for queue in &mut self.receivers {
            queue.is_cut = true;
            queue.since.lost = Some(why);
            queue.since.connected = false;
        }
        self.wake(wakers);
    }

    /// There is a connection again.
    pub(super) fn connected(&mut self, wakers: &mut Vec<Waker>) {
        for queue in &mut self.receivers {
            queue.since.connected |= std::mem::take(&mut queue.is_cut);
        }
        self.wake(wakers);
    }

    /// One more receiver, of reports of this code or of any, by the number that it has from now on.
    pub(super) fn enter(&mut self, code: Option<u16>) -> u64 {
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
        let (_, report) = self.reports.pop_front()?;
        self.bytes -= report.text.len();
        Some(report)
    }

    /// What comes next, the reports and what was between them.
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
