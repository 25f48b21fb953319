//! Why there is no connection.

use crate::frame::FrameError;
use std::io;

/// Why a connection was lost, or why there is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Loss {
    /// There has been no connection yet, and the first attempt to make one is not over.
    #[error("the first connection is still being made")]
    NotYet,
    /// The robot has closed the connection after it had sent something.
    #[error("the robot has closed the connection")]
    Closed,
    /// The robot has closed the connection, and not one frame had come over it. A robot with too
    /// many connections does so, and one that fails at the first request; the protocol has nothing
    /// by which to tell them apart.
    #[error(
        "the robot has closed the connection before it sent anything; it may have too many \
         connections, or fail at the request"
    )]
    Unheard,
    /// The connection broke.
    #[error("the connection broke: {0}")]
    Broken(io::ErrorKind),
    /// What the robot sent cannot be told into frames: a wrong head, an impossible length, or an end
    /// inside a frame.
    #[error("the robot's bytes are no frames: {0}")]
    Frame(FrameError),
    /// A frame began and did not go on, or came slower than it may; see
    /// [`ClientConfig::stall_timeout`](super::ClientConfig::stall_timeout).
    #[error("a frame stalled: {received} bytes have come of {total}; is its length right?")]
    Stalled {
        /// How much of the frame has come, header included, in bytes.
        received: usize,
        /// How long it claims to be, in bytes; the length of a header while that has not come.
        total: usize,
    },
    /// The robot did not read what was sent to it within the stall timeout.
    #[error("the robot does not read")]
    Unread,
    /// The network says no to a new connection.
    #[error("cannot connect: {0}")]
    Unreachable(io::ErrorKind),
    /// A new connection was not made within the connect timeout.
    #[error("cannot connect in time")]
    ConnectTimeout,
    /// The command connection was made again, and the data connection, which belongs to it, is as well.
    #[error("the command connection was made again, and the data connection with it")]
    Renewed,
    /// This side has closed the connection.
    #[error("the connection was closed by this side")]
    Here,
    /// The tokio runtime, or the task of the connection, has ended.
    #[error("the runtime of the connection has ended")]
    Ended,
}

impl Loss {
    /// The reason's fixed name; for [`Frame`](Self::Frame) that of the error.
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

    /// What an error of the socket means on a connection over which the robot was `heard`, or not.
    pub(super) fn broken(error: &io::Error, heard: bool) -> Self {
        use io::ErrorKind::{BrokenPipe, ConnectionAborted, ConnectionReset};
        match error.kind() {
            // A socket that is closed while a request lies unread in it is reset.
            BrokenPipe | ConnectionAborted | ConnectionReset if !heard => Self::Unheard,
            kind => Self::Broken(kind),
        }
    }
}
