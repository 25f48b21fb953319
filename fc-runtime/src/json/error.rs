//! Errors of a body, with their position.

use std::borrow::Cow;
use std::fmt::{self, Write as _};

/// The kind of an error of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BodyErrorKind {
    /// The bytes are not UTF-8.
    NotUtf8,
    /// The text is not JSON (RFC 8259).
    BadJson,
    /// The body is JSON, but not an object.
    NotAnObject,
    /// The value has another kind than the field.
    WrongType,
    /// A required key is missing.
    MissingField,
    /// A known key occurs twice in its object.
    DuplicateKey,
    /// Half of a surrogate pair without the other half, in a string or key that is read.
    LoneSurrogate,
    /// A number is outside the range of its type or constraint, or an enum value is not allowed for its field.
    OutOfRange,
    /// A string, list or byte string has a length outside its constraint.
    BadLength,
    /// A string does not match its pattern.
    BadPattern,
    /// A closed enum does not have this value.
    UnknownValue,
    /// An object lacks required keys of every variant of a one-of.
    NoVariant,
    /// The text is nested deeper than the limit.
    TooDeep,
    /// The text has more keys and items than the limit.
    TooManyValues,
    /// The items of lists take more memory than the limit.
    ListsTooLarge,
    /// A string is not base64 (RFC 4648, standard alphabet).
    BadBase64,
}

impl BodyErrorKind {
    /// Returns the name, which is the same in all implementations.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NotUtf8 => "not_utf8",
            Self::BadJson => "bad_json",
            Self::NotAnObject => "not_an_object",
            Self::WrongType => "wrong_type",
            Self::MissingField => "missing_field",
            Self::DuplicateKey => "duplicate_key",
            Self::LoneSurrogate => "lone_surrogate",
            Self::OutOfRange => "out_of_range",
            Self::BadLength => "bad_length",
            Self::BadPattern => "bad_pattern",
            Self::UnknownValue => "unknown_value",
            Self::NoVariant => "no_variant",
            Self::TooDeep => "too_deep",
            Self::TooManyValues => "too_many_values",
            Self::ListsTooLarge => "lists_too_large",
            Self::BadBase64 => "bad_base64",
        }
    }
}

/// Longest quotation in a detail, in bytes. It comes from the peer and may be sent back.
const LONGEST_QUOTATION: usize = 200;

/// Returns at most the first `length` bytes of a text, cut between characters.
pub(super) fn prefix(text: &str, length: usize) -> &str {
    let mut ends = (0..=length.min(text.len())).rev();
    let end = ends.find(|end| text.is_char_boundary(*end));
    text.get(..end.unwrap_or(0)).unwrap_or_default()
}

/// Returns the beginning of a text, without keeping the whole text in memory.
pub(super) fn shortened(text: impl fmt::Display) -> String {
    struct Short(String);

    impl fmt::Write for Short {
        fn write_str(&mut self, piece: &str) -> fmt::Result {
            let room = LONGEST_QUOTATION - self.0.len();
            if piece.len() <= room {
                self.0.push_str(piece);
                return Ok(());
            }
            self.0.push_str(prefix(piece, room));
            Err(fmt::Error)
        }
    }

    let mut short = Short(String::new());
    let all = write!(short, "{text}");
    if all.is_err() {
        short.0.push('…');
    }
    short.0
}

/// A body that cannot be read or violates a constraint.
///
/// One pointer wide, so that results without an error stay small.
#[derive(Clone, PartialEq, Eq)]
pub struct BodyError(Box<Fault>);

#[derive(Clone, PartialEq, Eq)]
struct Fault {
    kind: BodyErrorKind,
    detail: Cow<'static, str>,
    /// `None` until a reader adds it, and for a message that was never text.
    offset: Option<usize>,
    path: String,
}

impl BodyError {
    /// Creates an error. `detail` describes the found and the expected value.
    #[cold]
    #[must_use]
    pub fn new(kind: BodyErrorKind, detail: impl Into<Cow<'static, str>>) -> Self {
        Self(Box::new(Fault {
            kind,
            detail: detail.into(),
            offset: None,
            path: String::new(),
        }))
    }

    /// Creates the error of a missing required key.
    #[cold]
    #[must_use]
    pub fn missing(key: &str) -> Self {
        Self::new(BodyErrorKind::MissingField, "the key is required; send it").in_key(key)
    }

    /// Returns the kind.
    #[must_use]
    pub fn kind(&self) -> BodyErrorKind {
        self.0.kind
    }

    /// Returns the name of the kind, which is the same in all implementations.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.0.kind.name()
    }

    /// Returns the path in the body, such as `data.stations[3].x`, or an empty string for the body itself.
    #[must_use]
    pub fn path(&self) -> &str {
        &self.0.path
    }

    /// Returns the byte offset of the error in the body, or 0 for a message that was never text.
    #[must_use]
    pub fn offset(&self) -> usize {
        self.0.offset.unwrap_or(0)
    }

    /// Returns the description of the found and the expected value.
    #[must_use]
    pub fn detail(&self) -> &str {
        &self.0.detail
    }

    /// Adds the key of the enclosing object to the path.
    #[cold]
    #[must_use]
    pub fn in_key(mut self, key: &str) -> Self {
        let path = &mut self.0.path;
        if !path.is_empty() && !path.starts_with('[') {
            path.insert(0, '.');
        }
        path.insert_str(0, key);
        self
    }

    /// Adds the index of the enclosing list to the path.
    #[cold]
    #[must_use]
    pub fn in_item(mut self, index: usize) -> Self {
        let path = &mut self.0.path;
        if !path.is_empty() && !path.starts_with('[') {
            path.insert(0, '.');
        }
        path.insert_str(0, &format!("[{index}]"));
        self
    }

    /// Adds the offset of the reader, unless an inner one is known.
    #[cold]
    #[must_use]
    pub(crate) fn at(mut self, offset: usize) -> Self {
        self.0.offset.get_or_insert(offset);
        self
    }

    /// Returns the offset, or `None` if no reader has added one.
    pub(crate) fn noted_offset(&self) -> Option<usize> {
        self.0.offset
    }

    /// Sets the offset and the whole path.
    #[cold]
    #[must_use]
    pub(crate) fn placed(mut self, offset: usize, path: String) -> Self {
        self.0.offset = Some(offset);
        self.0.path = path;
        self
    }

    /// Changes the kind and keeps the position.
    #[cold]
    #[must_use]
    pub(crate) fn with_kind(mut self, kind: BodyErrorKind) -> Self {
        self.0.kind = kind;
        self
    }
}

impl fmt::Display for BodyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Fault {
            kind,
            detail,
            offset,
            path,
        } = &*self.0;
        write!(f, "{}", kind.name())?;
        if !path.is_empty() {
            write!(f, " at `{path}`")?;
        }
        if let Some(offset) = offset {
            write!(f, " (byte {offset})")?;
        }
        write!(f, ": {detail}")
    }
}

impl fmt::Debug for BodyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("BodyError")
            .field("kind", &self.0.kind)
            .field("path", &self.0.path)
            .field("offset", &self.0.offset)
            .field("detail", &self.0.detail)
            .finish()
    }
}

impl std::error::Error for BodyError {}
