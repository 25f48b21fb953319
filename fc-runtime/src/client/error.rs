//! Errors of connecting and of calls.

use super::loss::Loss;
use crate::frame::FrameError;
use crate::json::BodyError;
use crate::operation::Command;
use crate::refusal::Refusal;
use crate::session::Busy;
use std::io;

/// A connection could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ConnectError {
    /// The network refused the connection.
    #[error("cannot connect to {address}: {source}")]
    Io {
        /// Host and port.
        address: String,
        /// Error of the network.
        source: io::Error,
    },
    /// Connecting took too long.
    #[error(
        "no connection to {address} in time; is the robot switched on and in the same network?"
    )]
    Timeout {
        /// Host and port.
        address: String,
    },
}

impl ConnectError {
    /// Returns the fixed name of the error.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Io { .. } => "io",
            Self::Timeout { .. } => "timeout",
        }
    }
}

/// Converts the error into the reason why there is no connection.
impl From<&ConnectError> for Loss {
    fn from(error: &ConnectError) -> Self {
        match error {
            ConnectError::Io { source, .. } => Self::Unreachable(source.kind()),
            ConnectError::Timeout { .. } => Self::ConnectTimeout,
        }
    }
}

/// A call has no typed response.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CallError {
    /// The peer responded with a result other than success.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// No response in time, but the connection is still there. The peer may have acted.
    #[error("no response in time")]
    Timeout,
    /// No connection in time. The call has not been sent.
    #[error("not sent, for there was no connection in time: {0}")]
    NotConnected(#[source] Loss),
    /// The connection is closed. The call has not been sent.
    #[error("not sent, for the connection is closed: {0}; connect again")]
    Closed(#[source] Loss),
    /// The connection was lost while the call was in flight. The peer may have acted.
    #[error("the connection was lost before the response arrived: {0}; query the peer's state")]
    Lost(#[source] Loss),
    /// Too many calls are in flight. The call has not been sent.
    #[error(transparent)]
    Busy(#[from] Busy),
    /// The request violates a constraint. It has not been sent.
    #[error("the request is invalid: {0}")]
    Invalid(#[source] BodyError),
    /// The peer's response is not a valid response of the command.
    #[error("the response is invalid: {0}")]
    Response(#[source] BodyError),
    /// The request does not fit into a frame, or the frame of the response could not be read.
    #[error(transparent)]
    Frame(#[from] FrameError),
}

impl CallError {
    /// Returns the fixed name of the error. The causes of [`Invalid`](Self::Invalid), [`Response`](Self::Response) and
    /// [`Frame`](Self::Frame), and a [`Loss`], have their own names.
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

    /// Returns the declared error with which the peer responded, or `None` for any other result and without a response.
    #[must_use]
    pub fn declared<C: Command>(&self) -> Option<C::Error> {
        match self {
            Self::Refused(refusal) => refusal.declared::<C>(),
            _ => None,
        }
    }

    /// Returns the reason why there was no connection, if that ended the call.
    #[must_use]
    pub fn loss(&self) -> Option<Loss> {
        match *self {
            Self::NotConnected(loss) | Self::Closed(loss) | Self::Lost(loss) => Some(loss),
            _ => None,
        }
    }
}
