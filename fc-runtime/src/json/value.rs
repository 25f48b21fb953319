//! JSON that is carried along without being understood.

use super::{BodyError, FromJson, Reader, ToJson, Writer, from_str};
use std::fmt;

/// One JSON value, kept as its exact text.
///
/// Equality is equality of the text: `1.0` and `1` differ.
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Json(Box<str>);

impl Json {
    /// Takes `text` if it is one JSON value; whitespace around it is dropped.
    ///
    /// # Errors
    /// `bad_json` if it is not, `too_deep` if it is nested deeper than [`MAX_DEPTH`](super::MAX_DEPTH).
    pub fn new(text: &str) -> Result<Self, BodyError> {
        from_str(text, super::MAX_DEPTH)
    }

    /// The value `null`.
    #[must_use]
    pub fn null() -> Self {
        Self("null".into())
    }

    /// The text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Reads the value as a serde type. Needs the feature `serde`.
    ///
    /// # Errors
    /// Whatever `serde_json` finds wrong.
    #[cfg(feature = "serde")]
    pub fn parse<T: serde::de::DeserializeOwned>(&self) -> Result<T, serde_json::Error> {
        serde_json::from_str(&self.0)
    }

    /// Reads the value as a runtime type, such as a generated message.
    ///
    /// # Errors
    /// What is wrong with the value, placed within it.
    pub fn read_as<T: FromJson>(&self) -> Result<T, BodyError> {
        from_str(&self.0, super::MAX_DEPTH)
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

/// The keys of an object that its type does not know, in the order in which they came.
#[derive(Clone, Default, PartialEq, Eq, Hash)]
pub struct Extra(Vec<(Box<str>, Json)>);

impl Extra {
    /// No keys.
    #[must_use]
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// Keys and values in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Json)> {
        self.0.iter().map(|(key, value)| (&**key, value))
    }

    /// The value of a key; of its last occurrence if it came more than once.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&Json> {
        let entry = self.0.iter().rev().find(|(name, _)| **name == *key);
        entry.map(|(_, value)| value)
    }

    /// Sets a key, in place of all its former values, which are dropped. A key of the message's own
    /// belongs into its field: here it would be sent twice.
    pub fn insert(&mut self, key: impl Into<Box<str>>, value: Json) {
        let key = key.into();
        let mut place = self.0.len();
        let mut index = 0;
        self.0.retain(|(name, _)| {
            let keep = *name != key;
            if !keep {
                place = place.min(index);
            }
            index += 1;
            keep
        });
        self.0.insert(place.min(self.0.len()), (key, value));
    }

    /// Whether there are no keys.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Number of keys.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Reads the value of an unknown key and keeps it. Derived messages call it.
    ///
    /// # Errors
    /// What is wrong with the JSON.
    pub fn keep(&mut self, key: &str, reader: &mut Reader<'_>) -> Result<(), BodyError> {
        let value = Json::read(reader)?;
        self.0.push((key.into(), value));
        Ok(())
    }
}

impl fmt::Debug for Extra {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_map().entries(self.iter()).finish()
    }
}
