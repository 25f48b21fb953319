//! What can go wrong with connecting and with calls.

use crate::frame::FrameError;
use crate::json::BodyError;
use crate::raw::Refusal;
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

/// Why a call has no typed response.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CallError {
    /// The peer has answered, with another result than success.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// No answer in time. Whether the peer has acted is not known.
    #[error("no response in time")]
    Timeout,
    /// The connection is closed, or not made; the call has not been sent.
    #[error("the connection is closed; connect again")]
    Closed,
    /// The connection was lost while the call was on its way. Whether the peer has acted is not
    /// known.
    #[error("the connection was lost before the response arrived; query the peer's state")]
    Lost,
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
    /// [`Frame`](Self::Frame) the cause has one of its own.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Refused(_) => "refused",
            Self::Timeout => "timeout",
            Self::Closed => "closed",
            Self::Lost => "lost",
            Self::Busy(_) => "busy",
            Self::Invalid(_) => "invalid_request",
            Self::Response(_) => "invalid_response",
            Self::Frame(_) => "frame",
        }
    }
}
