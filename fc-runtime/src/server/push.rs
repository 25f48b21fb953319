//! Reports for apps.

use super::budget::Charge;
use super::connection_id::ConnectionId;
use crate::frame::{FrameError, Prepared};
use crate::json::BodyError;
use crate::operation::AckPolicy;
use crate::refusal::Refusal;
use tokio::sync::oneshot;

/// The receivers of a report or stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Audience {
    /// All connected apps.
    All,
    /// One app, identified by its command connection. For a stream also one data connection, by its id;
    /// [`send_stream`](super::ServerHandle::send_stream) describes the data connections of an app.
    One(ConnectionId),
}

/// The outcome of a report at one app.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Acknowledgement {
    /// The app.
    pub connection: ConnectionId,
    /// The outcome.
    pub outcome: AckOutcome,
}

/// The outcome of a report at one app.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AckOutcome {
    /// The app acknowledged it.
    Acknowledged,
    /// The app responded with a result other than success.
    Refused(Refusal),
    /// The app's response is not an acknowledgement.
    Invalid(BodyError),
    /// No acknowledgement after all repetitions.
    TimedOut,
    /// The app was slow, and the report was dropped for newer ones before it was sent.
    Dropped,
    /// The connection ended before.
    Closed,
}

/// A report or stream was not queued.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PushError {
    /// The report, or the content of a stream, violates a constraint.
    #[error("what is to be sent is invalid: {0}")]
    Invalid(#[source] BodyError),
    /// The report does not fit into a frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The connection does not exist any more; for a stream, the app has no data connection.
    #[error("there is no connection {0} to send to")]
    NoConnection(ConnectionId),
    /// For a stream: there are data connections from the app's address, but several command connections came from
    /// there, so their owners are unknown, and no frame was sent.
    #[error(
        "several apps share the address of {0}, and nothing tells whose data connection is whose"
    )]
    Ambiguous(ConnectionId),
}

impl PushError {
    /// Returns the fixed name of the error.
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

/// A report that is queued or in flight for one app.
#[derive(Debug)]
pub(super) struct Queued {
    pub(super) code: u16,
    pub(super) policy: AckPolicy,
    pub(super) body: Prepared,
    /// `None` before the report is queued.
    pub(super) charge: Option<Charge>,
    outcome: oneshot::Sender<AckOutcome>,
}

impl Queued {
    /// Returns the report, and its outcome at the app.
    pub(super) fn new(
        code: u16,
        policy: AckPolicy,
        body: Prepared,
        connection: ConnectionId,
    ) -> (Self, Outcome) {
        let (outcome, ended) = oneshot::channel();
        let queued = Self {
            code,
            policy,
            body,
            charge: None,
            outcome,
        };
        (queued, Outcome { connection, ended })
    }

    pub(super) fn end(self, outcome: AckOutcome) {
        // The push may wait no longer.
        let _ = self.outcome.send(outcome);
    }
}

/// The outcome of a report at one app, once it has ended.
pub(super) struct Outcome {
    connection: ConnectionId,
    ended: oneshot::Receiver<AckOutcome>,
}

impl Outcome {
    /// Waits for the outcome. A report that is dropped ends as closed.
    pub(super) async fn ended(self) -> Acknowledgement {
        Acknowledgement {
            connection: self.connection,
            outcome: self.ended.await.unwrap_or(AckOutcome::Closed),
        }
    }
}
