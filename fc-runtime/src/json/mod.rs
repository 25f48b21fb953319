//! JSON read and written straight from and to typed values.
//!
//! The type directs the reading: a derived message compares the text with the literal `"key":` of
//! its next field and only where that fails looks the key up. The grammar is that of RFC 8259,
//! exactly; what is not JSON is refused as `serde_json` refuses it. Where that leaves open what a
//! text means, the rules are those of I-JSON (RFC 7493), and they are the protocol's: its vectors
//! (`json.json`) hold every implementation to them.
//!
//! - A known key that comes more than once in its object is `duplicate_key`, whatever its values.
//! - Unknown keys are kept as their text ([`Extra`]), or skipped where a message keeps none. Nothing but
//!   the grammar is asked of their values, and nothing is changed in them: who knows the key judges.
//! - `null` is read as an absent [`Option`]; an absent `Option` is not written.
//! - An integer is what amounts to one, as in JSON Schema: `5`, `5.0` and `50e-1` are the same `5`,
//!   exactly, and it is written as `5`. `-0` is `0`.
//! - A float is the nearest to the number; one beyond its type is `out_of_range`.
//! - Half of a surrogate pair, `"\ud800"`, is no text: `lone_surrogate` in a string that is read, and in a
//!   key of an object that is read as a message.
//! - A text that is not JSON is `bad_json` (or `too_deep`) whatever else is wrong with it.
//! - A text that costs more than its [`Allowance`] is refused, whatever comes behind that place.
//! - A body that is not an object is `not_an_object`; inside a body the same is `wrong_type`.

// The writer, the fields and the values import each other: a value says how it is written, and the writer of an object
// writes values. A file below them all would have to hold their traits without what the traits are about.
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
mod halt;
mod locate;
mod number;
mod primitive;
mod reader;
mod scan;
#[cfg(feature = "serde")]
mod serde;
mod string;
mod value;
mod writer;

pub use self::allowance::Allowance;
pub use self::base64::Bytes64;
pub use self::choice::{closed, closed_str, open, open_str, unknown_value};
pub use self::constraint::{
    Bounded, Chosen, Limit, Measured, Pattern, Patterned, length, matches, max, min, only,
};
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

/// The deepest nesting that any reader enters, whatever limit it is given: it bounds the stack, and
/// `serde_json` reads as deep.
pub const MAX_DEPTH: usize = 127;

/// A type that a JSON value can be read as.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be read from JSON",
    note = "derive `Message`, `OpenEnum` or `OneOf`; wrap a serde type in `Serde` (feature `serde`)"
)]
pub trait FromJson: Sized {
    /// Whether the key of a field of this type may be missing.
    const OPTIONAL: bool = false;

    /// Reads the next value.
    ///
    /// # Errors
    /// What is wrong with it.
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError>;

    /// The value of a field whose key is missing, if it may be.
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

    /// Whether the key of a field of this value is left out.
    fn is_absent(&self) -> bool {
        false
    }

    /// Whether it can be sent: the constraints of all messages inside hold, and every float is a number.
    ///
    /// # Errors
    /// The first that does not, or is not.
    fn check_value(&self) -> Result<(), BodyError> {
        Ok(())
    }
}

/// Checks the messages and floats inside a field.
///
/// # Errors
/// The first constraint that does not hold; `out_of_range` of NaN and infinities.
#[inline]
pub fn inside<T: ToJson>(key: &'static str, value: &T) -> Result<(), BodyError> {
    match value.check_value() {
        Ok(()) => Ok(()),
        Err(error) => Err(error.in_key(key)),
    }
}
