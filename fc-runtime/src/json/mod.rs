//! Reads JSON into typed values and writes it from them, in one pass.
//!
//! The type directs the reader. A derived message compares the text with the literal `"key":` of its next field, and
//! looks the key up only if they differ. The grammar is exactly RFC 8259, and errors agree with `serde_json`. Where the
//! grammar leaves the meaning of a text open, the reader follows I-JSON (RFC 7493). The golden frames (`json.json`)
//! test these rules in every implementation:
//!
//! - A known key that occurs twice in its object is `duplicate_key`, whatever its values.
//! - Unknown keys are kept as text ([`Extra`]), or skipped if the message has no field for them. Their values are
//!   checked against the grammar only and are never changed.
//! - `null` is read as an absent [`Option`]. An absent `Option` is not written.
//! - A number with an integral value is an integer, as in JSON Schema: `5`, `5.0` and `50e-1` are all exactly `5`, and
//!   are written as `5`. `-0` is `0`.
//! - A float is the nearest value of its type. A number beyond the type's range is `out_of_range`.
//! - Half of a surrogate pair, such as `"\ud800"`, is not text. It is `lone_surrogate` in a string that is read, and in
//!   a key of an object that is read as a message.
//! - A text that is not JSON is `bad_json` or `too_deep`, even if it has other errors.
//! - A text beyond its [`Allowance`] is an error, whatever follows.
//! - A body that is not an object is `not_an_object`. The same inside a body is `wrong_type`.

// The writer, the fields and the values import each other: a value specifies how it is written, and the writer of an
// object writes values. Only a module with all of their traits could avoid this.
mod allowance;
mod base64;
mod choice;
mod constraint;
mod decimal;
mod document;
mod error;
mod extra;
mod fields;
mod form;
mod locate;
mod number;
mod primitive;
mod reader;
mod reader_state;
mod scan;
#[cfg(feature = "serde")]
mod serde;
mod string;
mod value;
mod writer;

pub use self::allowance::Allowance;
pub use self::base64::Bytes64;
pub use self::choice::{closed, closed_str, open, open_str, unknown_value};
pub use self::constraint::*;
pub(crate) use self::document::enveloped;
pub use self::document::{decode, from_slice, from_str, read_object, to_vec};
pub use self::error::{BodyError, BodyErrorKind};
pub use self::extra::Extra;
pub use self::fields::{Lacking, lacking};
pub use self::form::{
    AsNumber, EmptyIsAbsent, Form, LenientBool, LenientNumber, Numeric, Plain, Quotable, Quoted,
    ReadLenientBool, ReadLenientNumber,
};
pub use self::number::Integer;
pub use self::reader::Reader;
#[cfg(feature = "serde")]
pub use self::serde::Serde;
pub use self::value::{Json, JsonRef};
pub use self::writer::{ObjectWriter, Writer};

/// The deepest nesting that any reader accepts, whatever its limit. It bounds the stack, and is the limit of
/// `serde_json`.
pub const MAX_DEPTH: usize = 127;

/// A type that a JSON value can be read as.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be read from JSON",
    note = "derive `Message`, `OpenEnum` or `OneOf`; wrap a serde type in `Serde` (feature `serde`)"
)]
pub trait FromJson: Sized {
    /// `true` if the key of a field of this type may be missing.
    const OPTIONAL: bool = false;

    /// Reads the next value.
    ///
    /// # Errors
    /// The error of the value.
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError>;

    /// Returns the value of a field whose key is missing, or `None` if the key is required.
    #[must_use]
    fn absent() -> Option<Self> {
        None
    }
}

/// A type that can be written as a JSON value.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be written as JSON",
    note = "derive `Message`, `OpenEnum` or `OneOf`; wrap a serde type in `Serde` (feature `serde`)"
)]
pub trait ToJson {
    /// Writes the value.
    fn write(&self, writer: &mut Writer<'_>);

    /// Returns `true` if the key of a field with this value is not written.
    fn is_absent(&self) -> bool {
        false
    }

    /// Checks the constraints of all messages inside, and that every float is finite.
    ///
    /// # Errors
    /// The first violation.
    fn check_value(&self) -> Result<(), BodyError> {
        Ok(())
    }
}

/// Checks the messages and floats inside a field.
///
/// # Errors
/// The first violated constraint; `out_of_range` for NaN and infinities.
#[inline]
pub fn inside<T: ToJson>(key: &'static str, value: &T) -> Result<(), BodyError> {
    match value.check_value() {
        Ok(()) => Ok(()),
        Err(error) => Err(error.in_key(key)),
    }
}
