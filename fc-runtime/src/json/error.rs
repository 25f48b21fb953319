//! What can be wrong with a body, and where.

use std::borrow::Cow;
use std::fmt::{self, Write as _};

/// What is wrong with a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BodyErrorKind {
    /// The bytes are not UTF-8.
    NotUtf8,
    /// The text is not JSON (RFC 8259).
    BadJson,
    /// The body is JSON, but not an object.
    NotAnObject,
    /// A value of another kind than the field's.
    WrongType,
    /// A required key is missing.
    MissingField,
    /// A known key that comes twice in its object.
    DuplicateKey,
    /// Half of a surrogate pair that stands alone in a string or key that is read: no text has it.
    LoneSurrogate,
    /// A number outside the range of its type or of its constraint, or a value of an enum that its field does not take.
    OutOfRange,
    /// A string, list or run of bytes of a length outside its constraint.
    BadLength,
    /// A string that does not match its pattern.
    BadPattern,
    /// A value that a closed enum does not have.
    UnknownValue,
    /// An object that has the required keys of no variant of a one-of.
    NoVariant,
    /// Nested deeper than the limit.
    TooDeep,
    /// More keys and items than the limit.
    TooManyValues,
    /// The items of lists take more memory than the limit.
    ListsTooLarge,
    /// A string that is not base64 (RFC 4648, standard alphabet).
    BadBase64,
}

impl BodyErrorKind {
    /// Its name, the same in every product of the project.
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

/// Longest quotation in a detail, in bytes: what is quoted comes from the peer, and goes back to it.
const LONGEST_QUOTATION: usize = 200;

/// The beginning of a text that may be long, which is never whole in memory.
pub(super) fn shortened(text: impl fmt::Display) -> String {
    struct Short(String);

    impl fmt::Write for Short {
        fn write_str(&mut self, piece: &str) -> fmt::Result {
            let room = LONGEST_QUOTATION - self.0.len();
            if piece.len() <= room {
                self.0.push_str(piece);
                return Ok(());
            }
            let whole = |end: &usize| piece.is_char_boundary(*end);
            let end = (0..=room).rev().find(whole).unwrap_or(0);
            self.0.push_str(piece.get(..end).unwrap_or_default());
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

/// A body that could not be read, or that breaks its constraints.
///
/// One pointer wide, so that results stay small on the path where nothing is wrong.
#[derive(Clone, PartialEq, Eq)]
pub struct BodyError(Box<Fault>);

#[derive(Clone, PartialEq, Eq)]
struct Fault {
    kind: BodyErrorKind,
    detail: Cow<'static, str>,
    /// `None` until a reader has met the error, and for a message that was never text.
    offset: Option<usize>,
    path: String,
}

impl BodyError {
    /// An error of this kind; `detail` says what was found and what is wanted.
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

    /// The error of a required key that is not there.
    #[cold]
    #[must_use]
    pub fn missing(key: &str) -> Self {
        Self::new(BodyErrorKind::MissingField, "the key is required; send it").in_key(key)
    }

    /// What is wrong.
    #[must_use]
    pub fn kind(&self) -> BodyErrorKind {
        self.0.kind
    }

    /// The kind's name, the same in every product of the project.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.0.kind.name()
    }

    /// Where in the body, such as `data.stations[3].x`; empty for the body itself.
    #[must_use]
    pub fn path(&self) -> &str {
        &self.0.path
    }

    /// Bytes of the body before the fault; 0 for a message that was never text.
    #[must_use]
    pub fn offset(&self) -> usize {
        self.0.offset.unwrap_or(0)
    }

    /// What was found and what is wanted.
    #[must_use]
    pub fn detail(&self) -> &str {
        &self.0.detail
    }

    /// The error as seen from the object that holds it under `key`.
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

    /// The error as seen from the list that holds it at `index`.
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

    /// Notes where the text was being read, unless a deeper place has been noted.
    #[cold]
    #[must_use]
    pub(crate) fn at(mut self, offset: usize) -> Self {
        self.0.offset.get_or_insert(offset);
        self
    }

    /// The offset, if a reader has noted one.
    pub(crate) fn noted_offset(&self) -> Option<usize> {
        self.0.offset
    }

    /// Puts the place known from the text before the path known from the message.
    #[cold]
    #[must_use]
    pub(crate) fn placed(mut self, offset: usize, path: String) -> Self {
        self.0.offset = Some(offset);
        self.0.path = path;
        self
    }

    /// Changes what is wrong, keeping the place.
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
