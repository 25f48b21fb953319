//! Errors of a data connection.

use crate::client::loss::Loss;
use crate::frame::{FrameError, FrameId};
use crate::json::BodyError;
use crate::refusal::Refusal;

/// A frame could not be sent or received.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DataError {
    /// The connection was lost, and is made again as configured. From [`send`]: this or an earlier frame may not have
    /// arrived. From [`recv`]: frames may be missing here. Each loss is reported once in each direction; several losses
    /// between two calls are reported as one.
    ///
    /// [`recv`]: super::DataConnection::recv
    /// [`send`]: super::DataConnection::send
    #[error("the data connection was lost: {0}; what was on its way may be lost with it")]
    Lost(#[source] Loss),
    /// No connection in time. The frame has not been sent.
    #[error("there was no data connection in time: {0}")]
    NotConnected(#[source] Loss),
    /// The connection is closed. The frame has not been sent.
    #[error("the data connection is closed: {0}")]
    Closed(#[source] Loss),
    /// A received frame could not be read and was skipped, or a frame to be sent is too long. The connection stays
    /// open.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The robot refused a frame. The connection stays open.
    #[error("the robot has refused the {frame}: {refusal}")]
    Refused {
        /// The frame.
        frame: FrameId,
        /// The robot's answer.
        refusal: Refusal,
    },
    /// The received frame is not a stream frame. It was skipped, and the connection stays open.
    #[error("no stream: {0}")]
    Unexpected(FrameId),
    /// The content of a received frame is invalid for its stream, or the content to be sent violates a constraint and
    /// was not sent. The connection stays open.
    #[error("the content of a stream is invalid: {0}")]
    Invalid(#[source] BodyError),
}

impl DataError {
    /// Returns the fixed name of the error; for [`Frame`](Self::Frame) and [`Invalid`](Self::Invalid), the name of the
    /// cause.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Lost(_) => "lost",
            Self::NotConnected(_) => "not_connected",
            Self::Closed(_) => "closed",
            Self::Frame(error) => error.name(),
            Self::Refused { .. } => "refused",
            Self::Unexpected(_) => "unexpected_frame",
            Self::Invalid(error) => error.name(),
        }
    }

    /// Returns the reason why there is no connection, if that is the error.
    #[must_use]
    pub fn loss(&self) -> Option<Loss> {
        match *self {
            Self::Lost(loss) | Self::NotConnected(loss) | Self::Closed(loss) => Some(loss),
            _ => None,
        }
    }
}
