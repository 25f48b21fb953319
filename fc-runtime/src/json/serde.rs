//! Handwritten serde types in messages.

use super::error::shortened;
use super::{BodyError, BodyErrorKind, FromJson, Reader, ToJson, Writer};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A serde type as the value of a field. It uses `serde_json`, so it is slower than other values.
///
/// A value that `serde_json` cannot write, such as a map with keys that are not strings, is sent as `null`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Serde<T>(pub T);

impl<T: DeserializeOwned> FromJson for Serde<T> {
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        reader.peek();
        let start = reader.clone();
        let text = reader.value_text()?;
        serde_json::from_str(text)
            .map(Self)
            .map_err(|error| start.fault(BodyErrorKind::WrongType, shortened(error)))
    }
}

impl<T: Serialize> ToJson for Serde<T> {
    fn write(&self, writer: &mut Writer<'_>) {
        match serde_json::to_string(&self.0) {
            Ok(text) => writer.raw(&text),
            Err(_) => writer.null(),
        }
    }
}
