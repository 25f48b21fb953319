//! What can be wrong with a frame or a body, by the names that every product of a spec gives it.

use crate::FrameId;
use std::borrow::Cow;
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

named! {
    /// What is wrong with a body.
    ///
    /// One name of the typed runtime is missing: `lists_too_large` is about the memory that the
    /// items of its types take, and there are no such types here.
    BodyFault {
        /// The bytes are not UTF-8.
        NotUtf8 = "not_utf8",
        /// The text is not JSON (RFC 8259).
        BadJson = "bad_json",
        /// The body is JSON, but not an object.
        NotAnObject = "not_an_object",
        /// A value of another kind than the field's.
        WrongType = "wrong_type",
        /// A required key is missing.
        MissingField = "missing_field",
        /// A known key that comes twice in its object.
        DuplicateKey = "duplicate_key",
        /// Half of a surrogate pair that stands alone in a string or key that is read.
        LoneSurrogate = "lone_surrogate",
        /// A number outside the range of its type or of its constraint.
        OutOfRange = "out_of_range",
        /// A string, list or run of bytes of a length outside its constraint.
        BadLength = "bad_length",
        /// A string that does not match its pattern.
        BadPattern = "bad_pattern",
        /// A value that a closed enum does not have.
        UnknownValue = "unknown_value",
        /// An object that has the required keys of no variant of a choice.
        NoVariant = "no_variant",
        /// Nested deeper than the limit.
        TooDeep = "too_deep",
        /// More keys and items than the limit.
        TooManyValues = "too_many_values",
        /// A string that is not base64 (RFC 4648, standard alphabet).
        BadBase64 = "bad_base64",
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

/// A body that could not be read, or that breaks its constraints.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BodyError {
    /// What is wrong.
    pub fault: BodyFault,
    /// Where in the body, such as `data.stations[3].x`; empty for the body itself.
    pub path: String,
    /// Bytes of the body before the fault.
    pub offset: usize,
    /// What was found and what is wanted.
    pub detail: Cow<'static, str>,
}

impl BodyError {
    pub(crate) fn new(
        fault: BodyFault,
        offset: usize,
        detail: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self {
            fault,
            path: String::new(),
            offset,
            detail: detail.into(),
        }
    }

    /// The error of what an object at `offset` says, or does not say, under `key`.
    pub(crate) fn of_key(
        fault: BodyFault,
        offset: usize,
        key: &str,
        detail: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self {
            path: key.to_owned(),
            ..Self::new(fault, offset, detail)
        }
    }
}

impl fmt::Display for BodyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.fault.name())?;
        if !self.path.is_empty() {
            write!(f, " at `{}`", self.path)?;
        }
        write!(f, " (byte {}): {}", self.offset, self.detail)
    }
}

impl std::error::Error for BodyError {}

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
            Self::Body { error, .. } => error.fault.name(),
        }
    }

    /// Where in the body; empty for the body as a whole and for a frame.
    #[must_use]
    pub fn path(&self) -> &str {
        match self {
            Self::Frame(_) => "",
            Self::Body { error, .. } => &error.path,
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
