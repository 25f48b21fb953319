//! The reports of a connection, as a stream for the app.

use super::loss::Loss;
use super::queues::Queue;
use super::state::Handle;
use crate::protocol::Protocol;
use crate::raw::RawReport;
use crate::sync::register;
use futures_core::Stream;
use std::fmt;
use std::pin::Pin;
use std::task::{Context, Poll};

/// The reports of a connection from the receiver's creation on, in the order they came.
///
/// Each receiver has a queue of its own, of `queued_reports` and `queued_bytes`, and gets every
/// report. A report is acknowledged when at least one receiver has it in its queue; a receiver that
/// had no room then has missed it, and [`missed`](Self::missed) says so. While no receiver has room,
/// or there is none, reports are *not* acknowledged, so that the robot sends them again.
///
/// What the app could not read is never queued: a report that does not read as what its code says
/// in [`Protocol::operations`], or has no proper envelope, is refused with the protocol's result for
/// invalid bodies and counted as `reports_invalid`. A report with another code is queued as it is. A
/// report that comes again after it was queued is acknowledged and not queued twice.
///
/// The stream goes on over reconnecting and ends when the connection is closed and the queue empty.
pub struct RawReports<P: Protocol>(Receiver<P>);

impl<P: Protocol> RawReports<P> {
    pub(super) fn new(handle: Handle<P>) -> Self {
        Self(Receiver::new(handle, None))
    }

    /// The next report; `None` once the connection is closed and no report is left.
    ///
    /// Cancellation safe: a report is taken from the queue only when it is returned.
    pub async fn recv(&mut self) -> Option<RawReport> {
        std::future::poll_fn(|cx| self.poll_recv(cx)).await
    }

    /// Polls for the next report.
    pub fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Option<RawReport>> {
        self.0.poll_next(cx, Queue::pop).map(Result::ok)
    }

    /// How many reports this receiver has missed since this was last asked, because its queue was
    /// full while another receiver took them.
    pub fn missed(&mut self) -> u64 {
        let mut state = self.0.handle.lock();
        let queue = state.reports.of(self.0.id);
        queue.map_or(0, |queue| std::mem::take(&mut queue.missed))
    }
}

impl<P: Protocol> Stream for RawReports<P> {
    type Item = RawReport;

    fn poll_next(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<RawReport>> {
        self.get_mut().poll_recv(cx)
    }
}

impl<P: Protocol> fmt::Debug for RawReports<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RawReports").finish_non_exhaustive()
    }
}

/// A queue of reports, which is removed when this is dropped.
pub(super) struct Receiver<P: Protocol> {
    pub(super) handle: Handle<P>,
    id: u64,
}

impl<P: Protocol> Receiver<P> {
    /// Creates a queue for the reports of a code, or for all reports.
    pub(super) fn new(handle: Handle<P>, code: Option<u16>) -> Self {
        let id = handle.lock().reports.enter(code);
        Self { handle, id }
    }

    /// Polls for the next item that `take` finds in the queue. The error says why there will be none.
    pub(super) fn poll_next<T>(
        &self,
        cx: &mut Context<'_>,
        take: fn(&mut Queue) -> Option<T>,
    ) -> Poll<Result<T, Loss>> {
        let mut state = self.handle.lock();
        let now = state.connection.now();
        let ended = || Poll::Ready(Err(now.why().unwrap_or(Loss::Ended)));
        let Some(queue) = state.reports.of(self.id) else {
            return ended();
        };
        if let Some(next) = take(queue) {
            return Poll::Ready(Ok(next));
        }
        if now.is_closed() {
            return ended();
        }
        register(&mut queue.waker, cx);
        Poll::Pending
    }
}

impl<P: Protocol> Drop for Receiver<P> {
    fn drop(&mut self) {
        self.handle.lock().reports.leave(self.id);
    }
}
