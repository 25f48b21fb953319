//! What can go wrong on a data connection.

use crate::client::loss::Loss;
use crate::frame::{FrameError, FrameId};
use crate::json::BodyError;
use crate::refusal::Refusal;

/// Why a frame of raw bytes could not be sent, or what came instead of one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DataError {
    /// The connection was lost, and is being made again as configured. From [`send`]: whether this
    /// frame, or one sent before, has arrived is not known. From [`recv`]: frames may be missing here.
    /// Each loss is told once either way; several that nobody asked about meanwhile are told as one.
    ///
    /// [`recv`]: super::DataConnection::recv
    /// [`send`]: super::DataConnection::send
    #[error("the data connection was lost: {0}; what was on its way may be lost with it")]
    Lost(#[source] Loss),
    /// No connection in time; the frame has not been sent.
    #[error("there was no data connection in time: {0}")]
    NotConnected(#[source] Loss),
    /// The connection is closed for good; the frame has not been sent.
    #[error("the data connection is closed: {0}")]
    Closed(#[source] Loss),
    /// A frame could not be read, and was skipped; or the one to be sent is too long. The connection
    /// stays open.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The robot has refused a frame sent to it. The connection stays open.
    #[error("the robot has refused the {frame}: {refusal}")]
    Refused {
        /// The frame.
        frame: FrameId,
        /// The robot's answer.
        refusal: Refusal,
    },
    /// A frame arrived that is not a stream frame. It has been skipped, and the connection stays open.
    #[error("no stream: {0}")]
    Unexpected(FrameId),
    /// What a frame carries is not what its stream does, or what is to be sent breaks a constraint; it has not been
    /// sent then. The connection stays open.
    #[error("the content of a stream is invalid: {0}")]
    Invalid(#[source] BodyError),
}

impl DataError {
    /// The error's fixed name; for [`Frame`](Self::Frame) and [`Invalid`](Self::Invalid) that of the cause.
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

    /// Why there is no connection, if that is what is wrong.
    #[must_use]
    pub fn loss(&self) -> Option<Loss> {
        match *self {
            Self::Lost(loss) | Self::NotConnected(loss) | Self::Closed(loss) => Some(loss),
            _ => None,
        }
    }
}
