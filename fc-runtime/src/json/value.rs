//! JSON values that are kept without being read.

use super::{Allowance, BodyError, FromJson, Reader, ToJson, Writer, from_str};
use std::fmt;

/// One JSON value, kept as its exact text.
///
/// Two values are equal if their texts are equal: `1.0` and `1` differ.
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Json(Box<str>);

impl Json {
    /// Creates a value from a text that is one JSON value. Surrounding whitespace is dropped.
    ///
    /// # Errors
    /// `bad_json` if the text is not JSON; `too_deep` if it is nested deeper than [`MAX_DEPTH`](super::MAX_DEPTH).
    pub fn new(text: &str) -> Result<Self, BodyError> {
        from_str(text, Allowance::ANY)
    }

    /// Returns the value `null`.
    #[must_use]
    pub fn null() -> Self {
        Self("null".into())
    }

    /// Returns the text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Reads the value as a serde type. Needs the feature `serde`.
    ///
    /// # Errors
    /// The error of `serde_json`.
    #[cfg(feature = "serde")]
    pub fn parse<T: serde::de::DeserializeOwned>(&self) -> Result<T, serde_json::Error> {
        self.borrowed().parse()
    }

    /// Reads the value as a runtime type, such as a generated message.
    ///
    /// # Errors
    /// The error of the value with its position in the value, also if it exceeds [`Allowance::DEFAULT`].
    pub fn read_as<T: FromJson>(&self) -> Result<T, BodyError> {
        self.borrowed().read_as()
    }

    /// Borrows the value.
    #[must_use]
    pub fn borrowed(&self) -> JsonRef<'_> {
        JsonRef(&self.0)
    }
}

impl std::str::FromStr for Json {
    type Err = BodyError;

    fn from_str(text: &str) -> Result<Self, BodyError> {
        Self::new(text)
    }
}

#[cfg(feature = "serde")]
impl From<serde_json::Value> for Json {
    fn from(value: serde_json::Value) -> Self {
        Self(value.to_string().into())
    }
}

impl fmt::Display for Json {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl fmt::Debug for Json {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl FromJson for Json {
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        reader.value_text().map(|text| Self(text.into()))
    }
}

impl ToJson for Json {
    fn write(&self, writer: &mut Writer<'_>) {
        writer.raw(&self.0);
    }
}

/// One JSON value in a borrowed text, such as one in [`Extra`](super::Extra).
///
/// Two values are equal if their texts are equal, as with [`Json`].
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct JsonRef<'a>(pub(super) &'a str);

impl<'a> JsonRef<'a> {
    /// Returns the text.
    #[must_use]
    pub fn as_str(self) -> &'a str {
        self.0
    }

    /// Copies the value.
    #[must_use]
    pub fn to_json(self) -> Json {
        Json(self.0.into())
    }

    /// Reads the value as a serde type. Needs the feature `serde`.
    ///
    /// # Errors
    /// The error of `serde_json`.
    #[cfg(feature = "serde")]
    pub fn parse<T: serde::de::DeserializeOwned>(self) -> Result<T, serde_json::Error> {
        serde_json::from_str(self.0)
    }

    /// Reads the value as a runtime type, such as a generated message.
    ///
    /// # Errors
    /// The error of the value with its position in the value, also if it exceeds [`Allowance::DEFAULT`].
    pub fn read_as<T: FromJson>(self) -> Result<T, BodyError> {
        from_str(self.0, Allowance::DEFAULT)
    }
}

impl fmt::Display for JsonRef<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}

impl fmt::Debug for JsonRef<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}
