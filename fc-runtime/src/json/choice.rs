//! Enums: values told apart by what travels, and messages told apart by their keys.

use super::{BodyError, BodyErrorKind, Form, Reader};
use crate::message::Key;
use std::fmt::Display;

/// Reads a value of an open enum that travels as a `W` in the form `F`.
///
/// # Errors
/// What is wrong with the value.
pub fn open<F: Form<W>, W, T: From<W>>(reader: &mut Reader<'_>) -> Result<T, BodyError> {
    F::read(reader).map(T::from)
}

/// Reads a value of a closed enum that travels as a `W` in the form `F`.
///
/// # Errors
/// What is wrong with the value; `unknown_value`.
pub fn closed<F: Form<W>, W, T: TryFrom<W, Error = BodyError>>(
    reader: &mut Reader<'_>,
) -> Result<T, BodyError> {
    reader.peek();
    let start = reader.offset();
    T::try_from(F::read(reader)?).map_err(|error| error.at(start))
}

/// Reads a value of an open enum that travels as a string.
///
/// # Errors
/// What is wrong with the value.
pub fn open_str<T: for<'s> From<&'s str>>(reader: &mut Reader<'_>) -> Result<T, BodyError> {
    reader.string().map(|text| T::from(&*text))
}

/// Reads a value of a closed enum that travels as a string.
///
/// # Errors
/// What is wrong with the value; `unknown_value`.
pub fn closed_str<T: for<'s> TryFrom<&'s str, Error = BodyError>>(
    reader: &mut Reader<'_>,
) -> Result<T, BodyError> {
    reader.peek();
    let start = reader.offset();
    T::try_from(&*reader.string()?).map_err(|error| error.at(start))
}

/// The error of a value that a closed enum does not have.
#[cold]
pub fn unknown_value(value: impl Display) -> BodyError {
    BodyError::new(
        BodyErrorKind::UnknownValue,
        format!("`{value}` is none of the values of this field"),
    )
}

impl Reader<'_> {
    /// Finds, without reading it, the first of some messages whose required keys the next value has
    /// all. Gives its index.
    ///
    /// # Errors
    /// `no_variant`; what is wrong with the JSON.
    pub fn choose(&mut self, messages: &[&[Key]]) -> Result<usize, BodyError> {
        self.peek();
        let mut ahead = self.clone();
        let mut present = Vec::new();
        ahead.begin_object()?;
        while !ahead.end_object() {
            present.push(ahead.key()?);
            ahead.skip_value()?;
            ahead.end_value()?;
        }
        let has = |key: &Key| {
            let named = |name: &str| name == key.name || key.also.contains(&name);
            !key.required || present.iter().any(|name| named(name))
        };
        let chosen = messages.iter().position(|keys| keys.iter().all(has));
        chosen.ok_or_else(|| {
            let wanted: Vec<_> = messages.iter().map(|keys| required(keys)).collect();
            self.fault(
                BodyErrorKind::NoVariant,
                format!("send an object with the keys {}", wanted.join(", or ")),
            )
        })
    }
}

fn required(keys: &[Key]) -> String {
    let names = keys
        .iter()
        .filter(|key| key.required)
        .map(|key| format!("`{}`", key.name));
    names.collect::<Vec<_>>().join(" and ")
}
