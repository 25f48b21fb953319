//! What can go wrong with connecting and with calls.

use super::loss::Loss;
use crate::frame::FrameError;
use crate::json::BodyError;
use crate::operation::Command;
use crate::refusal::Refusal;
use crate::session::Busy;
use std::io;

/// Why a connection could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ConnectError {
    /// The network says no.
    #[error("cannot connect to {address}: {source}")]
    Io {
        /// Host and port.
        address: String,
        /// The network's reason.
        source: io::Error,
    },
    /// No connection in time.
    #[error(
        "no connection to {address} in time; is the robot switched on and in the same network?"
    )]
    Timeout {
        /// Host and port.
        address: String,
    },
}

impl ConnectError {
    /// The error's fixed name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Io { .. } => "io",
            Self::Timeout { .. } => "timeout",
        }
    }
}

/// Why there is no connection, when it could not be made.
impl From<&ConnectError> for Loss {
    fn from(error: &ConnectError) -> Self {
        match error {
            ConnectError::Io { source, .. } => Self::Unreachable(source.kind()),
            ConnectError::Timeout { .. } => Self::ConnectTimeout,
        }
    }
}

/// Why a call has no typed response.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CallError {
    /// The peer has answered, with another result than success.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// No answer in time over a connection that is still there. Whether the peer has acted is not
    /// known.
    #[error("no response in time")]
    Timeout,
    /// No connection in time; the call has not been sent.
    #[error("not sent, for there was no connection in time: {0}")]
    NotConnected(#[source] Loss),
    /// The connection is closed for good; the call has not been sent.
    #[error("not sent, for the connection is closed: {0}; connect again")]
    Closed(#[source] Loss),
    /// The connection was lost while the call was on its way. Whether the peer has acted is not
    /// known.
    #[error("the connection was lost before the response arrived: {0}; query the peer's state")]
    Lost(#[source] Loss),
    /// Too many calls are in flight; the call has not been sent.
    #[error(transparent)]
    Busy(#[from] Busy),
    /// The request breaks one of its own constraints; it has not been sent.
    #[error("the request is invalid: {0}")]
    Invalid(#[source] BodyError),
    /// The peer has answered something else than such a response.
    #[error("the response is invalid: {0}")]
    Response(#[source] BodyError),
    /// The request does not fit into a frame, or the answer came in a broken one.
    #[error(transparent)]
    Frame(#[from] FrameError),
}

impl CallError {
    /// The error's fixed name; for [`Invalid`](Self::Invalid), [`Response`](Self::Response) and
    /// [`Frame`](Self::Frame) the cause has one of its own, and so has a [`Loss`].
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Refused(_) => "refused",
            Self::Timeout => "timeout",
            Self::NotConnected(_) => "not_connected",
            Self::Closed(_) => "closed",
            Self::Lost(_) => "lost",
            Self::Busy(_) => "busy",
            Self::Invalid(_) => "invalid_request",
            Self::Response(_) => "invalid_response",
            Self::Frame(_) => "frame",
        }
    }

    /// Which of the errors that the command declares the peer has answered with; `None` for any other result,
    /// and if there was no answer.
    #[must_use]
    pub fn declared<C: Command>(&self) -> Option<C::Error> {
        match self {
            Self::Refused(refusal) => refusal.declared::<C>(),
            _ => None,
        }
    }

    /// Why there was no connection (any more), if that is what ended the call.
    #[must_use]
    pub fn loss(&self) -> Option<Loss> {
        match *self {
            Self::NotConnected(loss) | Self::Closed(loss) | Self::Lost(loss) => Some(loss),
            _ => None,
        }
    }
}
