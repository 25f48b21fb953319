//! Reports on their way to apps.

use super::budget::Charge;
use super::connection_id::ConnectionId;
use crate::frame::{FrameError, Prepared};
use crate::json::BodyError;
use crate::operation::AckPolicy;
use crate::refusal::Refusal;
use crate::sync::{lock, register};
use std::sync::{Arc, Mutex, MutexGuard};
use std::task::{Context, Poll, Waker};

/// Whom to send to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Audience {
    /// Every app connected at this moment.
    All,
    /// One app, by its command connection. For a stream also one data connection, by its own id; see
    /// [`send_stream`](super::ServerHandle::send_stream) for which data connections are those of an app.
    One(ConnectionId),
}

/// What has become of a report at one app.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Acknowledgement {
    /// The app.
    pub connection: ConnectionId,
    /// How it ended.
    pub outcome: AckOutcome,
}

/// How a report ended at one app.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AckOutcome {
    /// The app has acknowledged it.
    Acknowledged,
    /// The app has answered with another result than success.
    Refused(Refusal),
    /// The app has answered with something that is not an acknowledgement.
    Invalid(BodyError),
    /// No acknowledgement has come, and the report was repeated as often as it may be.
    TimedOut,
    /// The app was so slow that the report gave way to newer ones before it was sent.
    Dropped,
    /// The connection ended first.
    Closed,
}

/// Why a report was not even queued.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PushError {
    /// The report, or the content of a stream, breaks one of its own constraints.
    #[error("what is to be sent is invalid: {0}")]
    Invalid(#[source] BodyError),
    /// The report does not fit into a frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// There is no such connection any more; for a stream: no data connection of that app.
    #[error("there is no connection {0} to send to")]
    NoConnection(ConnectionId),
    /// A stream: its address has data connections, but several command connections have come from
    /// there, and nothing tells whose they are. Nothing was sent.
    #[error(
        "several apps share the address of {0}, and nothing tells whose data connection is whose"
    )]
    Ambiguous(ConnectionId),
}

impl PushError {
    /// The error's fixed name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Invalid(_) => "invalid_report",
            Self::Frame(_) => "frame",
            Self::NoConnection(_) => "no_connection",
            Self::Ambiguous(_) => "ambiguous",
        }
    }
}

/// A report waiting for one app, or in flight to it.
#[derive(Debug)]
pub(super) struct Queued {
    pub(super) code: u16,
    pub(super) policy: AckPolicy,
    pub(super) body: Prepared,
    /// `None` before it is queued.
    pub(super) charge: Option<Charge>,
    ticket: Ticket,
}

impl Queued {
    pub(super) fn new(code: u16, policy: AckPolicy, body: Prepared, ticket: Ticket) -> Self {
        Self {
            code,
            policy,
            body,
            charge: None,
            ticket,
        }
    }

    pub(super) fn end(mut self, outcome: AckOutcome) {
        self.ticket.settle(outcome);
    }
}

/// One app's part of a push. Settles itself as closed if it is dropped.
#[derive(Debug)]
pub(super) struct Ticket {
    push: Arc<Push>,
    connection: ConnectionId,
    settled: bool,
}

impl Ticket {
    fn settle(&mut self, outcome: AckOutcome) {
        if self.settled {
            return;
        }
        self.settled = true;
        let waker = {
            let mut state = self.push.lock();
            state.open -= 1;
            state.ended.push(Acknowledgement {
                connection: self.connection,
                outcome,
            });
            if state.open == 0 {
                state.waker.take()
            } else {
                None
            }
        };
        if let Some(waker) = waker {
            waker.wake();
        }
    }
}

impl Drop for Ticket {
    fn drop(&mut self) {
        self.settle(AckOutcome::Closed);
    }
}

/// One report on its way to any number of apps.
#[derive(Debug, Default)]
pub(super) struct Push {
    state: Mutex<PushState>,
}

#[derive(Debug, Default)]
struct PushState {
    open: usize,
    ended: Vec<Acknowledgement>,
    waker: Option<Waker>,
}

impl Push {
    pub(super) fn ticket(self: &Arc<Self>, connection: ConnectionId) -> Ticket {
        self.lock().open += 1;
        Ticket {
            push: Arc::clone(self),
            connection,
            settled: false,
        }
    }

    /// Ready once every ticket is settled.
    pub(super) fn poll(&self, cx: &mut Context<'_>) -> Poll<Vec<Acknowledgement>> {
        let mut state = self.lock();
        if state.open == 0 {
            return Poll::Ready(std::mem::take(&mut state.ended));
        }
        register(&mut state.waker, cx);
        Poll::Pending
    }

    fn lock(&self) -> MutexGuard<'_, PushState> {
        lock(&self.state)
    }
}
