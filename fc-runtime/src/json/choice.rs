//! Enums, distinguished by their values, and one-ofs, distinguished by their keys.

use super::error::shortened;
use super::fields::{Lacking, read_name};
use super::{BodyError, BodyErrorKind, Form, Reader};
use std::fmt::Display;

/// Reads a value of an open enum that is sent as a `W` in the form `F`.
///
/// # Errors
/// The error of the value.
pub fn open<F: Form<W>, W, T: From<W>>(reader: &mut Reader<'_>) -> Result<T, BodyError> {
    F::read(reader).map(T::from)
}

/// Reads a value of a closed enum that is sent as a `W` in the form `F`.
///
/// # Errors
/// The error of the value; `unknown_value`.
pub fn closed<F: Form<W>, W, T: TryFrom<W, Error = BodyError>>(
    reader: &mut Reader<'_>,
) -> Result<T, BodyError> {
    reader.peek();
    let start = reader.offset();
    T::try_from(F::read(reader)?).map_err(|error| error.at(start))
}

/// Reads a value of an open enum that is sent as a string.
///
/// # Errors
/// The error of the value.
pub fn open_str<T: for<'s> From<&'s str>>(reader: &mut Reader<'_>) -> Result<T, BodyError> {
    reader.string().map(|text| T::from(&*text))
}

/// Reads a value of a closed enum that is sent as a string.
///
/// # Errors
/// The error of the value; `unknown_value`.
pub fn closed_str<T: for<'s> TryFrom<&'s str, Error = BodyError>>(
    reader: &mut Reader<'_>,
) -> Result<T, BodyError> {
    reader.peek();
    let start = reader.offset();
    T::try_from(&*reader.string()?).map_err(|error| error.at(start))
}

/// Returns the error of a value that a closed enum does not have.
#[cold]
pub fn unknown_value(value: impl Display) -> BodyError {
    BodyError::new(
        BodyErrorKind::UnknownValue,
        format!("`{}` is none of the values of this field", shortened(value)),
    )
}

impl Reader<'_> {
    /// Returns the index of the first message whose required keys are all in the next value. Does not read the value.
    /// Each message is given by its [`lacking`](super::lacking).
    ///
    /// # Errors
    /// `no_variant`, or the error of the JSON text.
    pub fn choose(&mut self, messages: &[Lacking]) -> Result<usize, BodyError> {
        self.peek();
        let present = self.clone().required_keys(messages)?;
        let chosen = messages
            .iter()
            .position(|lacking| lacking(&present).is_empty());
        chosen.ok_or_else(|| {
            let wanted: Vec<_> = messages.iter().map(|lacking| required(*lacking)).collect();
            self.fault(
                BodyErrorKind::NoVariant,
                format!("send an object with the keys {}", wanted.join(", or ")),
            )
        })
    }
}

fn required(lacking: Lacking) -> String {
    let names = lacking(&[]).into_iter();
    let names = names.map(|name| format!("`{}`", read_name(name)));
    names.collect::<Vec<_>>().join(" and ")
}
