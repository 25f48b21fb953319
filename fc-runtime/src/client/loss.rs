//! The reason why there is no connection.

use crate::frame::FrameError;
use std::io;

/// The reason why a connection was lost, or why there is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Loss {
    /// The first attempt to connect has not finished yet.
    #[error("the first connection is still being made")]
    NotYet,
    /// The robot closed the connection after it had sent something.
    #[error("the robot has closed the connection")]
    Closed,
    /// The robot closed the connection before any frame was received. A robot does so if it has too many connections,
    /// or if it fails at the first request. The protocol cannot distinguish these cases.
    #[error(
        "the robot has closed the connection before it sent anything; it may have too many \
         connections, or fail at the request"
    )]
    Unheard,
    /// The connection broke.
    #[error("the connection broke: {0}")]
    Broken(io::ErrorKind),
    /// The robot's bytes are not frames: a wrong head, an impossible length, or an end inside a frame.
    #[error("the robot's bytes are no frames: {0}")]
    Frame(FrameError),
    /// A frame stalled, or arrived too slowly; see [`ClientConfig::stall_timeout`](super::ClientConfig::stall_timeout).
    #[error("a frame stalled: {received} bytes have come of {total}; is its length right?")]
    Stalled {
        /// Received bytes of the frame, header included.
        received: usize,
        /// Announced length of the frame in bytes, or the length of a header if it is unknown.
        total: usize,
    },
    /// The robot did not read within the stall timeout.
    #[error("the robot does not read")]
    Unread,
    /// The network refused a new connection.
    #[error("cannot connect: {0}")]
    Unreachable(io::ErrorKind),
    /// Connecting took longer than the connect timeout.
    #[error("cannot connect in time")]
    ConnectTimeout,
    /// The command connection was made again, and its data connection with it.
    #[error("the command connection was made again, and the data connection with it")]
    Renewed,
    /// This side closed the connection.
    #[error("the connection was closed by this side")]
    Here,
    /// The tokio runtime, or the task of the connection, has ended.
    #[error("the runtime of the connection has ended")]
    Ended,
}

impl Loss {
    /// Returns the fixed name of the reason; for [`Frame`](Self::Frame), the name of the error.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::NotYet => "not_yet",
            Self::Closed => "closed_by_robot",
            Self::Unheard => "closed_unheard",
            Self::Broken(_) => "broken",
            Self::Frame(error) => error.name(),
            Self::Stalled { .. } => "stalled",
            Self::Unread => "unread",
            Self::Unreachable(_) => "unreachable",
            Self::ConnectTimeout => "connect_timeout",
            Self::Renewed => "renewed",
            Self::Here => "closed_here",
            Self::Ended => "ended",
        }
    }

    /// Returns the loss for an error of the socket. `heard` is `true` if a frame was received.
    pub(super) fn broken(error: &io::Error, heard: bool) -> Self {
        use io::ErrorKind::{BrokenPipe, ConnectionAborted, ConnectionReset};
        match error.kind() {
            // A socket is reset if it is closed while a request is unread.
            BrokenPipe | ConnectionAborted | ConnectionReset if !heard => Self::Unheard,
            kind => Self::Broken(kind),
        }
    }
}
