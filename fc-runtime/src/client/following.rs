//! Following the reports that a command sets off to their end.

use super::loss::Loss;
use super::queues::{Event, Queue};
use super::reports::Receiver;
use crate::clock;
use crate::json::BodyError;
use crate::operation::{Report, SetsOff, State};
use crate::protocol::Protocol;
use futures_core::{FusedStream, Stream};
use std::fmt;
use std::marker::PhantomData;
use std::pin::Pin;
use std::task::{Context, Poll, ready};

/// An event of a process that is being followed.
#[derive(Clone, Debug, PartialEq)]
pub enum Followed<R> {
    /// The process goes on.
    Going(R),
    /// The process has ended with a final state. The last event of the stream.
    Ended(R),
    /// The report means a failure. The last event of the stream.
    Failed(R),
    /// Number of reports that did not fit into this queue while another receiver took them.
    Missed(u64),
    /// The connection was lost. The stream continues with the reports after the next connection.
    Interrupted(Loss),
    /// There is a connection again. Reports in between may be lost, so query the state of the robot.
    Resumed,
}

impl<R> Followed<R> {
    /// Returns the report, or `None` for other events.
    #[must_use]
    pub fn report(&self) -> Option<&R> {
        match self {
            Self::Going(report) | Self::Ended(report) | Self::Failed(report) => Some(report),
            Self::Missed(_) | Self::Interrupted(_) | Self::Resumed => None,
        }
    }

    /// Returns the report, or `None` for other events.
    #[must_use]
    pub fn into_report(self) -> Option<R> {
        match self {
            Self::Going(report) | Self::Ended(report) | Self::Failed(report) => Some(report),
            Self::Missed(_) | Self::Interrupted(_) | Self::Resumed => None,
        }
    }

    /// Returns `true` for the last event of the stream: the process has ended or failed.
    #[must_use]
    pub fn is_over(&self) -> bool {
        matches!(self, Self::Ended(_) | Self::Failed(_))
    }
}

/// The reason why a process cannot be followed any further. The process may go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FollowError {
    /// The connection is closed.
    #[error("the connection is closed: {0}; the process may go on")]
    Closed(#[source] Loss),
    /// The report cannot be read as its type. Only connections of another protocol's types have such reports, because
    /// reports are checked before they are acknowledged.
    #[error("the report is invalid: {0}")]
    Invalid(#[source] BodyError),
}

impl FollowError {
    /// Returns the fixed name of the error. The cause of [`Invalid`](Self::Invalid) and a [`Loss`] have their own
    /// names.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Closed(_) => "closed",
            Self::Invalid(_) => "invalid_report",
        }
    }
}

/// An answered command and the reports `R` that it sets off, as a stream.
///
/// The stream ends after [`Followed::Ended`], [`Followed::Failed`] or a [`FollowError`]. If the protocol specifies
/// neither final states nor failures, it continues until it is dropped or the connection is closed. Limit the wait for
/// a report yourself, for example with `tokio::time::timeout`.
///
/// It has its own queue for reports with this code, like [`RawReports`](super::RawReports). Reports are acknowledged
/// when they are in it, and other receivers get them as well. After its end it takes no more reports. If no fields link
/// a report to a call, it gets every report with this code, also those of other calls.
///
/// A report whose state does not follow the previous one, as the protocol specifies, is delivered like any other. It is
/// also logged and counted as `reports_out_of_order`.
pub struct Following<P: Protocol, C: SetsOff<R>, R: Report> {
    /// Set until the end. Reports after it would not be read.
    receiver: Option<Receiver<P>>,
    request: C,
    answer: C::Response,
    /// The last reported state.
    last: Option<R::State>,
    reports: PhantomData<fn() -> R>,
}

impl<P: Protocol, C: SetsOff<R>, R: Report> Following<P, C, R> {
    pub(super) fn new(receiver: Receiver<P>, request: C, answer: C::Response) -> Self {
        Self {
            receiver: Some(receiver),
            request,
            answer,
            last: None,
            reports: PhantomData,
        }
    }

    /// Returns the robot's response to the command.
    #[must_use]
    pub fn answer(&self) -> &C::Response {
        &self.answer
    }

    /// Returns the next event, or `None` after the end.
    ///
    /// Cancellation safe: a report is taken from the queue only when it is returned.
    pub async fn recv(&mut self) -> Option<Result<Followed<R>, FollowError>> {
        std::future::poll_fn(|cx| self.poll_recv(cx)).await
    }

    /// Polls for the next event.
    pub fn poll_recv(
        &mut self,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Followed<R>, FollowError>>> {
        let Some(receiver) = &self.receiver else {
            return Poll::Ready(None);
        };
        let next = loop {
            match ready!(receiver.poll_next(cx, Queue::next)) {
                Err(why) => break Err(FollowError::Closed(why)),
                Ok(Event::Missed(missed)) => break Ok(Followed::Missed(missed)),
                Ok(Event::Lost(why)) => break Ok(Followed::Interrupted(why)),
                Ok(Event::Connected) => break Ok(Followed::Resumed),
                Ok(Event::Report(raw)) => match raw.read::<P, R>() {
                    Err(error) => break Err(FollowError::Invalid(error)),
                    Ok(report) if !self.request.has_set_off(&self.answer, &report) => {}
                    Ok(report) => {
                        let state = report.state();
                        if let (Some(last), Some(state)) = (&self.last, &state)
                            && !state.is_in_order(last)
                        {
                            note_out_of_order::<P, R>(receiver);
                        }
                        let next = classify(report, state.as_ref());
                        self.last = state.or(self.last.take());
                        break Ok(next);
                    }
                },
            }
        };
        if next.as_ref().map_or(true, Followed::is_over) {
            self.receiver = None;
        }
        Poll::Ready(Some(next))
    }
}

/// Counts and logs a report that came out of order.
fn note_out_of_order<P: Protocol, R: Report>(receiver: &Receiver<P>) {
    let line = {
        let mut state = receiver.handle.lock();
        state.counters.reports_out_of_order += 1;
        state.limiters.out_of_order.admit(clock::now())
    };
    if let Some(held) = line {
        let (protocol, name, held) = (P::NAME, R::NAME, held.shown());
        tracing::info!(protocol, name, code = R::CODE, held, "report out of order");
    }
}

/// Returns the event for a report.
fn classify<R: Report>(report: R, state: Option<&R::State>) -> Followed<R> {
    if report.is_failure() {
        Followed::Failed(report)
    } else if state.is_some_and(State::is_end) {
        Followed::Ended(report)
    } else {
        Followed::Going(report)
    }
}

// No field is pinned.
impl<P: Protocol, C: SetsOff<R>, R: Report> Unpin for Following<P, C, R> {}

impl<P: Protocol, C: SetsOff<R>, R: Report> Stream for Following<P, C, R> {
    type Item = Result<Followed<R>, FollowError>;

    fn poll_next(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        self.get_mut().poll_recv(cx)
    }
}

impl<P: Protocol, C: SetsOff<R>, R: Report> FusedStream for Following<P, C, R> {
    fn is_terminated(&self) -> bool {
        self.receiver.is_none()
    }
}

impl<P: Protocol, C: SetsOff<R>, R: Report> fmt::Debug for Following<P, C, R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Following")
            .field("command", &C::NAME)
            .field("report", &R::NAME)
            .field("is_over", &self.receiver.is_none())
            .finish_non_exhaustive()
    }
}
