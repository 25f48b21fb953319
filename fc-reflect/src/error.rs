//! Errors of frames and bodies. Every product of a spec uses the same names for them.

use crate::id::FrameId;
use fc_runtime::json::BodyError;
use std::fmt;

/// Declares an enum of errors and writes each name once.
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
            /// All values.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// Returns the name, the same in every product of the spec.
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
    /// A kind of error in a frame.
    FrameFault {
        /// The frame does not begin with a head of the protocol.
        BadHead = "bad_head",
        /// The total length is less than that of a header.
        ShortFrame = "short_frame",
        /// The total length exceeds the limit.
        FrameTooLong = "frame_too_long",
        /// The input ends inside the frame.
        Truncated = "truncated",
        /// The protocol has no such kind.
        UnknownKind = "unknown_kind",
        /// The kind is reserved for later versions of the protocol.
        ReservedKind = "reserved_kind",
        /// The protocol has no such encoding.
        UnknownEncoding = "unknown_encoding",
        /// The digest does not match the data.
        BadDigest = "bad_digest",
        /// The data is not one complete gzip member.
        BadGzip = "bad_gzip",
        /// The length of the data differs from the plain length in the header.
        PlainLengthMismatch = "plain_length_mismatch",
        /// The decompressed data would exceed the limit.
        InflatedTooLong = "inflated_too_long",
        /// The decompressed data would be larger than the ratio limit allows.
        InflatesTooMuch = "inflates_too_much",
    }
}

/// An error in reading or writing a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameError {
    /// The kind of error.
    pub fault: FrameFault,
    /// The message of the frame. `None` if the length of the frame is unknown, so that reading a stream of frames
    /// cannot continue.
    pub frame: Option<FrameId>,
    /// The actual and the expected content.
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

/// An error in a frame or in its body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The frame is invalid.
    Frame(FrameError),
    /// The frame is valid, and its body is not.
    Body {
        /// The message of the frame.
        frame: FrameId,
        /// The error in the body.
        error: BodyError,
    },
}

impl Error {
    /// Returns the name of the error, the same in every product of the spec.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Frame(error) => error.fault.name(),
            Self::Body { error, .. } => error.name(),
        }
    }

    /// Returns the place in the body. It is empty for an error of the whole body or of the frame.
    #[must_use]
    pub fn path(&self) -> &str {
        match self {
            Self::Frame(_) => "",
            Self::Body { error, .. } => error.path(),
        }
    }

    /// Returns the actual and the expected content.
    #[must_use]
    pub fn detail(&self) -> &str {
        match self {
            Self::Frame(error) => &error.detail,
            Self::Body { error, .. } => error.detail(),
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
