//! What can be wrong with a frame or a body, by the names that every product of a spec gives it.

use crate::id::FrameId;
use fc_runtime::json::BodyError;
use std::fmt;

/// Declares a closed set of names: each is written once.
macro_rules! named {
    (
        $(#[$about:meta])*
        $set:ident { $($(#[$doc:meta])* $variant:ident = $name:literal,)* }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $set {
            $($(#[$doc])* $variant,)*
        }

        impl $set {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// Its name, the same in every product of the spec.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }
        }
    };
}

named! {
    /// What is wrong with a frame.
    FrameFault {
        /// The bytes where a frame has to begin are no head.
        BadHead = "bad_head",
        /// The total length is less than that of a header.
        ShortFrame = "short_frame",
        /// The total length exceeds the limit.
        FrameTooLong = "frame_too_long",
        /// The input ends inside the frame.
        Truncated = "truncated",
        /// The kind is none of the protocol's.
        UnknownKind = "unknown_kind",
        /// The kind is reserved for later versions of the protocol.
        ReservedKind = "reserved_kind",
        /// The data is packed in a way that the protocol does not know.
        UnknownEncoding = "unknown_encoding",
        /// The digest is not that of the data.
        BadDigest = "bad_digest",
        /// The data is not one whole gzip member.
        BadGzip = "bad_gzip",
        /// The data has another length than the header says it has before compression.
        PlainLengthMismatch = "plain_length_mismatch",
        /// The data would be longer than the limit after decompression.
        InflatedTooLong = "inflated_too_long",
        /// The data would grow by more than text does when it is inflated.
        InflatesTooMuch = "inflates_too_much",
    }
}

/// A frame that cannot be taken apart, or made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameError {
    /// What is wrong.
    pub fault: FrameFault,
    /// Which message the frame belongs to; `None` where not even its end is known, so that a stream
    /// of frames cannot go on behind it.
    pub frame: Option<FrameId>,
    /// What was found and what is wanted.
    pub detail: String,
}

impl FrameError {
    pub(crate) fn new(
        fault: FrameFault,
        frame: Option<FrameId>,
        detail: impl Into<String>,
    ) -> Self {
        Self {
            fault,
            frame,
            detail: detail.into(),
        }
    }
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.fault.name(), self.detail)?;
        match self.frame {
            Some(frame) => write!(f, " ({frame})"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for FrameError {}

/// What is wrong with a frame or with the body in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The frame cannot be taken apart.
    Frame(FrameError),
    /// The frame is right, and its body is not.
    Body {
        /// Which message it is.
        frame: FrameId,
        /// What is wrong with it.
        error: BodyError,
    },
}

impl Error {
    /// The fault's name, the same in every product of the spec.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Frame(error) => error.fault.name(),
            Self::Body { error, .. } => error.name(),
        }
    }

    /// Where in the body; empty for the body as a whole and for a frame.
    #[must_use]
    pub fn path(&self) -> &str {
        match self {
            Self::Frame(_) => "",
            Self::Body { error, .. } => error.path(),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frame(error) => error.fmt(f),
            Self::Body { frame, error } => write!(f, "{error} ({frame})"),
        }
    }
}

impl std::error::Error for Error {}

impl From<FrameError> for Error {
    fn from(error: FrameError) -> Self {
        Self::Frame(error)
    }
}
