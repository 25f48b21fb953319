//! Reports on their way to the app.

use super::state::Handle;
use crate::protocol::Protocol;
use crate::raw::RawReport;
use futures_core::Stream;
use std::collections::VecDeque;
use std::fmt;
use std::pin::Pin;
use std::task::{Context, Poll, Waker};

/// The bounded queue between driver and app.
#[derive(Debug)]
pub(super) struct Queue {
    reports: VecDeque<RawReport>,
    limit: usize,
    bytes: usize,
    bytes_limit: usize,
    /// Whom to wake when there is a report, by receiver.
    waiting: Vec<(u64, Waker)>,
    receivers: usize,
    next_receiver: u64,
    /// Somebody has asked for reports and has gone.
    abandoned: bool,
}

/// What the queue did with a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Admission {
    /// Queued, or dropped because nobody wants reports any more: acknowledge it.
    Taken,
    /// No room: leave it to the robot to send it again.
    Full,
}

impl Queue {
    pub(super) fn new(limit: usize, bytes_limit: usize) -> Self {
        Self {
            reports: VecDeque::new(),
            limit,
            bytes: 0,
            bytes_limit,
            waiting: Vec::new(),
            receivers: 0,
            next_receiver: 0,
            abandoned: false,
        }
    }

    pub(super) fn push(&mut self, report: RawReport, wakers: &mut Vec<Waker>) -> Admission {
        if self.abandoned {
            return Admission::Taken;
        }
        let bytes = self.bytes + report.text.len();
        if self.reports.len() >= self.limit || bytes > self.bytes_limit {
            return Admission::Full;
        }
        self.bytes = bytes;
        self.reports.push_back(report);
        self.wake(wakers);
        Admission::Taken
    }

    fn pop(&mut self) -> Option<RawReport> {
        let report = self.reports.pop_front()?;
        self.bytes -= report.text.len();
        Some(report)
    }

    /// Wakes all that wait, as when the connection is closed.
    pub(super) fn wake(&mut self, wakers: &mut Vec<Waker>) {
        wakers.extend(self.waiting.drain(..).map(|(_, waker)| waker));
    }
}

/// The reports of a connection, in the order they came.
///
/// Reports wait in a queue of `queued_reports` and `queued_bytes`, from the first moment of the connection on. A report
/// is acknowledged when it is queued. While the queue is full, reports are *not* acknowledged, so
/// that the robot sends them again. What is not a JSON object with a proper envelope is refused and
/// never queued; what a report's own keys are is for the app to judge. A report that comes again after it was queued is acknowledged
/// and not queued twice.
///
/// Several receivers share one queue: each report goes to one of them. When the last one is dropped,
/// reports are acknowledged and thrown away, until there is a new one.
///
/// The stream goes on over reconnecting and ends when the connection is closed and the queue empty.
pub struct RawReports<P: Protocol> {
    handle: Handle<P>,
    id: u64,
}

impl<P: Protocol> RawReports<P> {
    pub(super) fn new(handle: Handle<P>) -> Self {
        let id = {
            let queue = &mut handle.lock().reports;
            queue.receivers += 1;
            queue.abandoned = false;
            queue.next_receiver += 1;
            queue.next_receiver
        };
        Self { handle, id }
    }

    /// The next report; `None` once the connection is closed and no report is left.
    ///
    /// Cancellation safe: a report is taken from the queue only when it is returned.
    pub async fn recv(&mut self) -> Option<RawReport> {
        std::future::poll_fn(|cx| self.poll_recv(cx)).await
    }

    /// Polls for the next report.
    pub fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Option<RawReport>> {
        let mut state = self.handle.lock();
        if let Some(report) = state.reports.pop() {
            return Poll::Ready(Some(report));
        }
        if state.is_over() {
            return Poll::Ready(None);
        }
        let waiting = &mut state.reports.waiting;
        match waiting.iter_mut().find(|(id, _)| *id == self.id) {
            Some((_, waker)) => waker.clone_from(cx.waker()),
            None => waiting.push((self.id, cx.waker().clone())),
        }
        Poll::Pending
    }
}

impl<P: Protocol> Stream for RawReports<P> {
    type Item = RawReport;

    fn poll_next(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<RawReport>> {
        self.get_mut().poll_recv(cx)
    }
}

impl<P: Protocol> Drop for RawReports<P> {
    fn drop(&mut self) {
        let queue = &mut self.handle.lock().reports;
        queue.waiting.retain(|(id, _)| *id != self.id);
        queue.receivers -= 1;
        if queue.receivers == 0 {
            queue.abandoned = true;
            queue.reports.clear();
            queue.bytes = 0;
        }
    }
}

impl<P: Protocol> fmt::Debug for RawReports<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RawReports").finish_non_exhaustive()
    }
}
