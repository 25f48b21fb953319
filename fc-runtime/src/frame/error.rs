//! Errors of frames.

use crate::protocol::Protocol;
use crate::wire::Header;
use std::fmt;

/// Identifies the message of a frame. A response repeats it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FrameId {
    /// `true` if the frame starts with the head of responses.
    pub response: bool,
    /// Kind of the data.
    pub kind: u8,
    /// Command code.
    pub code: u16,
    /// Message id.
    pub id: u32,
}

impl FrameId {
    /// Returns the id of the response to this frame, which repeats all but the head.
    #[must_use]
    pub fn answer(self) -> Self {
        Self {
            response: true,
            ..self
        }
    }

    /// Returns the id in a header.
    #[must_use]
    pub fn of<P: Protocol>(header: &P::Header) -> Self {
        Self {
            response: header.head() == P::RESPONSE_HEAD,
            kind: header.kind(),
            code: header.code(),
            id: header.id(),
        }
    }
}

impl fmt::Display for FrameId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = if self.response { "response" } else { "request" };
        write!(
            f,
            "{what} of kind 0x{:02X}, code 0x{:04X}, id {}",
            self.kind, self.code, self.id
        )
    }
}

/// A frame cannot be delivered.
///
/// After a *fatal* error the position of the next frame is unknown, so the connection must be closed. After any other
/// error the frame has been skipped and the stream is still in sync. [`frame`](Self::frame) returns the skipped frame,
/// which may be answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    /// The bytes at the start of a frame are not a head.
    #[error("no frame begins here: the head is wrong; close the connection and connect again")]
    BadHead,
    /// The total length is shorter than a header.
    #[error(
        "the frame claims {total} bytes in all, less than its header of {header}; the peer counts \
         the length without the header"
    )]
    ShortFrame {
        /// Claimed total length in bytes.
        total: u32,
        /// Length of a header in bytes.
        header: usize,
    },
    /// The total length exceeds the limit.
    #[error("the frame has {total} bytes, more than the limit of {limit}; raise `frame_bytes`")]
    FrameTooLong {
        /// Total length in bytes.
        total: u64,
        /// The limit in bytes.
        limit: u32,
    },
    /// The input ended inside a frame.
    #[error("the stream ended inside a frame, with {bytes} bytes of it received")]
    Truncated {
        /// Number of received bytes of the frame.
        bytes: usize,
    },
    /// The protocol does not have this kind.
    #[error("unknown kind in the {frame}")]
    UnknownKind {
        /// The frame.
        frame: FrameId,
    },
    /// The kind is reserved for later versions of the protocol.
    #[error("reserved kind in the {frame}")]
    ReservedKind {
        /// The frame.
        frame: FrameId,
    },
    /// The protocol does not have this encoding.
    #[error("unknown encoding {encoding} in the {frame}")]
    UnknownEncoding {
        /// The frame.
        frame: FrameId,
        /// The encoding.
        encoding: u8,
    },
    /// The digest does not match the data.
    #[error("the digest does not fit the data of the {frame}; it was damaged on its way")]
    BadDigest {
        /// The frame.
        frame: FrameId,
    },
    /// The data is not one complete gzip member.
    #[error("the data of the {frame} is not one intact gzip member")]
    BadGzip {
        /// The frame.
        frame: FrameId,
    },
    /// The length of the data before compression differs from the header.
    #[error("the data of the {frame} has not the plain length of {plain} bytes in its header")]
    PlainLengthMismatch {
        /// The frame.
        frame: FrameId,
        /// Claimed plain length in bytes.
        plain: u32,
    },
    /// The decompressed data would exceed the limit.
    #[error(
        "the {frame} inflates to {plain} bytes, more than the limit of {limit}; raise \
         `inflated_bytes`"
    )]
    InflatedTooLong {
        /// The frame.
        frame: FrameId,
        /// Claimed plain length in bytes.
        plain: u32,
        /// The limit in bytes.
        limit: u32,
    },
    /// The decompressed data would grow by a larger factor than text does.
    #[error(
        "the {frame} inflates from {packed} bytes to {plain}, more than {limit} times as many; \
         raise `inflate_ratio`"
    )]
    InflatesTooMuch {
        /// The frame.
        frame: FrameId,
        /// Claimed plain length in bytes.
        plain: u32,
        /// Length of the compressed data in bytes.
        packed: usize,
        /// The limit, as a factor.
        limit: u32,
    },
}

impl FrameError {
    /// Returns the fixed name of the error, which is the same in all implementations.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::BadHead => "bad_head",
            Self::ShortFrame { .. } => "short_frame",
            Self::FrameTooLong { .. } => "frame_too_long",
            Self::Truncated { .. } => "truncated",
            Self::UnknownKind { .. } => "unknown_kind",
            Self::ReservedKind { .. } => "reserved_kind",
            Self::UnknownEncoding { .. } => "unknown_encoding",
            Self::BadDigest { .. } => "bad_digest",
            Self::BadGzip { .. } => "bad_gzip",
            Self::PlainLengthMismatch { .. } => "plain_length_mismatch",
            Self::InflatedTooLong { .. } => "inflated_too_long",
            Self::InflatesTooMuch { .. } => "inflates_too_much",
        }
    }

    /// Returns `true` if the position of the next frame is unknown.
    #[must_use]
    pub fn is_fatal(&self) -> bool {
        self.frame().is_none()
    }

    /// Returns the skipped frame, or `None` after a fatal error.
    #[must_use]
    pub fn frame(&self) -> Option<FrameId> {
        match *self {
            Self::BadHead
            | Self::ShortFrame { .. }
            | Self::FrameTooLong { .. }
            | Self::Truncated { .. } => None,
            Self::UnknownKind { frame }
            | Self::ReservedKind { frame }
            | Self::UnknownEncoding { frame, .. }
            | Self::BadDigest { frame }
            | Self::BadGzip { frame }
            | Self::PlainLengthMismatch { frame, .. }
            | Self::InflatedTooLong { frame, .. }
            | Self::InflatesTooMuch { frame, .. } => Some(frame),
        }
    }
}
