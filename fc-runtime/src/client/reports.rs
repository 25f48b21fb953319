//! The reports of a connection as a stream.

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

/// The reports of a connection from the creation of the receiver on, in the order received.
///
/// Each receiver gets every report and has its own queue, limited by `queued_reports` and `queued_bytes`. A report is
/// acknowledged when it is in the queue of at least one receiver. A receiver without room misses it, and
/// [`missed`](Self::missed) counts it. If no receiver has room, or there is no receiver, the report is *not*
/// acknowledged, so that the robot sends it again.
///
/// Reports that the app cannot read are never queued. A report without a valid envelope, or one that cannot be read as
/// the type of its code in [`Protocol::operations`], is refused with the protocol's result for invalid bodies. It is
/// counted as `reports_invalid`. A report with an unknown code is queued unchanged. A repetition of a queued report is
/// acknowledged but not queued again.
///
/// The stream continues after reconnections. It ends when the connection is closed and the queue is empty.
pub struct RawReports<P: Protocol>(Receiver<P>);

impl<P: Protocol> RawReports<P> {
    pub(super) fn new(handle: Handle<P>) -> Self {
        Self(Receiver::new(handle, None))
    }

    /// Returns the next report, or `None` if the connection is closed and the queue is empty.
    ///
    /// Cancellation safe: a report is taken from the queue only when it is returned.
    pub async fn recv(&mut self) -> Option<RawReport> {
        std::future::poll_fn(|cx| self.poll_recv(cx)).await
    }

    /// Polls for the next report.
    pub fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Option<RawReport>> {
        self.0.poll_next(cx, Queue::pop).map(Result::ok)
    }

    /// Returns the number of reports this receiver has missed since the last call. It misses a report if its queue is
    /// full while another receiver takes the report.
    pub fn missed(&mut self) -> u64 {
        let mut state = self.0.handle.lock();
        let queue = state.reports.get(self.0.id);
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
        let id = handle.lock().reports.add(code);
        Self { handle, id }
    }

    /// Polls for the next item that `take` returns from the queue. The error is the reason why there will be none.
    pub(super) fn poll_next<T>(
        &self,
        cx: &mut Context<'_>,
        take: fn(&mut Queue) -> Option<T>,
    ) -> Poll<Result<T, Loss>> {
        let mut state = self.handle.lock();
        let now = state.connection.now();
        let ended = || Poll::Ready(Err(now.why().unwrap_or(Loss::Ended)));
        let Some(queue) = state.reports.get(self.id) else {
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
        self.handle.lock().reports.remove(self.id);
    }
}
