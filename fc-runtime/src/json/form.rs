//! Values that are sent in another form than that of their type, and forms that a lenient decoder accepts.

use super::number::Integer;
use super::{Allowance, BodyError, BodyErrorKind, FromJson, Reader, Writer};
use std::marker::PhantomData;
use std::num::IntErrorKind;

/// A form in which a `T` is read.
#[diagnostic::on_unimplemented(
    message = "a field of type `{T}` cannot be read in this form",
    note = "`empty_is_absent` needs an `Option`"
)]
pub trait Form<T> {
    /// Reads the next value.
    ///
    /// # Errors
    /// The error of the value.
    fn read(reader: &mut Reader<'_>) -> Result<T, BodyError>;
}

/// The form of the type itself.
#[derive(Clone, Copy, Debug)]
pub struct Plain;

impl<T: FromJson> Form<T> for Plain {
    #[inline]
    fn read(reader: &mut Reader<'_>) -> Result<T, BodyError> {
        T::read(reader)
    }
}

/// `wire = "string"`: a number or bool inside a JSON string (`"0.5"`, `"true"`).
#[derive(Clone, Copy, Debug)]
pub struct Quoted;

impl<T: Quotable> Form<T> for Quoted {
    fn read(reader: &mut Reader<'_>) -> Result<T, BodyError> {
        T::read_quoted(reader)
    }
}

/// `wire = "number"`: a bool as `1` or `0`.
#[derive(Clone, Copy, Debug)]
pub struct Numeric;

impl<T: AsNumber> Form<T> for Numeric {
    fn read(reader: &mut Reader<'_>) -> Result<T, BodyError> {
        T::read_number(reader)
    }
}

/// `lenient(number)`: a number is read from a JSON number, a decimal string or a `0x` string.
#[derive(Clone, Copy, Debug)]
pub struct LenientNumber;

impl<T: ReadLenientNumber> Form<T> for LenientNumber {
    fn read(reader: &mut Reader<'_>) -> Result<T, BodyError> {
        T::read_lenient(reader)
    }
}

/// `lenient(bool)`: a bool is read from `true`, `false`, their strings, `0` or `1`.
#[derive(Clone, Copy, Debug)]
pub struct LenientBool;

impl<T: ReadLenientBool> Form<T> for LenientBool {
    fn read(reader: &mut Reader<'_>) -> Result<T, BodyError> {
        T::read_lenient(reader)
    }
}

/// `empty_is_absent`: `null`, `{}`, `[]` and `""` are read as an absent optional field, any other value in the form
/// `F`.
#[derive(Clone, Copy, Debug)]
pub struct EmptyIsAbsent<F = Plain>(PhantomData<F>);

impl<T, F: Form<T>> Form<Option<T>> for EmptyIsAbsent<F> {
    fn read(reader: &mut Reader<'_>) -> Result<Option<T>, BodyError> {
        if reader.take_empty() {
            return Ok(None);
        }
        F::read(reader).map(Some)
    }
}

impl Reader<'_> {
    /// Reads `null`, `{}`, `[]` or `""` if it is the next value.
    pub fn take_empty(&mut self) -> bool {
        let start = self.clone();
        let empty = match self.peek() {
            Some(b'n') => self.take_null(),
            Some(b'"') => self.take("\"\""),
            Some(b'{') => self.begin_object().is_ok() && self.end_object(),
            Some(b'[') => self.begin_array().is_ok() && self.end_array(),
            _ => false,
        };
        if !empty {
            *self = start;
        }
        empty
    }

    /// Reads a string and parses its whole content with `parse`.
    fn quoted<T>(
        &mut self,
        wanted: &str,
        parse: impl FnOnce(&mut Reader<'_>) -> Result<T, BodyError>,
    ) -> Result<T, BodyError> {
        if self.peek() != Some(b'"') {
            return Err(self.unexpected(wanted));
        }
        let start = self.clone();
        let text = self.string()?;
        let mut inside = Reader::new(&text, Allowance::depth(0));
        let value = parse(&mut inside);
        // Whitespace around a number in a string is an error.
        let begins = !text.starts_with([' ', '\t', '\n', '\r']);
        match value {
            Ok(value) if begins && inside.byte().is_none() => Ok(value),
            Err(error)
                if error.kind() == BodyErrorKind::OutOfRange && begins && is_number(&text) =>
            {
                Err(start.fault(BodyErrorKind::OutOfRange, error.detail().to_owned()))
            }
            _ => Err(start.fault(
                BodyErrorKind::WrongType,
                format!("the string does not hold {wanted}"),
            )),
        }
    }

    /// Reads the number 1 as true and 0 as false, in any notation.
    fn zero_or_one(&mut self, wanted: &str) -> Result<bool, BodyError> {
        self.peek();
        let mut start = self.clone();
        match self.integer::<u64>() {
            Ok(0) => Ok(false),
            Ok(1) => Ok(true),
            _ => Err(start.unexpected(wanted)),
        }
    }

    /// Reads an integer from a number, a decimal string or a `0x` string.
    ///
    /// # Errors
    /// `wrong_type`, `out_of_range`.
    pub fn lenient_integer<T: Integer>(&mut self) -> Result<T, BodyError> {
        if self.peek() != Some(b'"') {
            return self.integer();
        }
        self.quoted("an integer", |inside| match inside.hexadecimal() {
            Some(value) => value,
            None => inside.integer(),
        })
    }

    /// Reads the whole text as an integer if it starts with `0x`.
    fn hexadecimal<T: Integer>(&mut self) -> Option<Result<T, BodyError>> {
        let prefixed = self.text.strip_prefix("0x");
        let digits = prefixed.or_else(|| self.text.strip_prefix("0X"))?;
        // The parser of the standard library accepts a sign, which is not allowed after `0x`.
        if digits.starts_with('+') {
            return None;
        }
        let value = u64::from_str_radix(digits, 16).map(|value| T::from_parts(false, value));
        Some(match value {
            Ok(Some(value)) => {
                self.at = self.text.len();
                Ok(value)
            }
            Ok(None) => Err(self.out_of_range::<T>()),
            Err(error) if *error.kind() == IntErrorKind::PosOverflow => {
                Err(self.out_of_range::<T>())
            }
            Err(_) => Err(self.unexpected("an integer")),
        })
    }
}

/// Returns `true` if the whole text is a number. A number that is out of range may end before its text does.
#[cold]
fn is_number(text: &str) -> bool {
    let prefixed = text.strip_prefix("0x");
    if let Some(digits) = prefixed.or_else(|| text.strip_prefix("0X")) {
        return digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    }
    let mut reader = Reader::new(text, Allowance::depth(0));
    reader.skip_value().is_ok() && reader.byte().is_none()
}

/// A value that can be sent inside a JSON string.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot travel inside a string",
    note = "`wire = \"string\"` is for numbers and bools, and options and lists of them"
)]
pub trait Quotable: Sized {
    /// Reads it from a string.
    ///
    /// # Errors
    /// `wrong_type`, `out_of_range`.
    fn read_quoted(reader: &mut Reader<'_>) -> Result<Self, BodyError>;
    /// Writes it as a string.
    fn write_quoted(&self, writer: &mut Writer<'_>);
}

/// A value that can be sent as a number although it is not a number.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot travel as 1 or 0",
    note = "`wire = \"number\"` is for `bool`, and options and lists of it"
)]
pub trait AsNumber: Sized {
    /// Reads it from 1 or 0.
    ///
    /// # Errors
    /// `wrong_type`.
    fn read_number(reader: &mut Reader<'_>) -> Result<Self, BodyError>;
    /// Writes it as 1 or 0.
    fn write_number(&self, writer: &mut Writer<'_>);
}

/// A value that `lenient(number)` can read.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a number",
    note = "`lenient(number)` is for numbers and integer enums, and options and lists of them"
)]
pub trait ReadLenientNumber: Sized {
    /// Reads it from a number or a string.
    ///
    /// # Errors
    /// `wrong_type`, `out_of_range`.
    fn read_lenient(reader: &mut Reader<'_>) -> Result<Self, BodyError>;
}

/// A value that `lenient(bool)` can read.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a bool",
    note = "`lenient(bool)` is for `bool`, and options and lists of it"
)]
pub trait ReadLenientBool: Sized {
    /// Reads it from a bool, a string, `0` or `1`.
    ///
    /// # Errors
    /// `wrong_type`.
    fn read_lenient(reader: &mut Reader<'_>) -> Result<Self, BodyError>;
}

macro_rules! quotable {
    ($wanted:literal: $($scalar:ty)*) => {$(
        impl Quotable for $scalar {
            fn read_quoted(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
                reader.quoted($wanted, Self::read)
            }

            fn write_quoted(&self, writer: &mut Writer<'_>) {
                writer.quoted(self);
            }
        }
    )*};
}

quotable!("a bool as a string": bool);
quotable!("an integer as a string": i8 i16 i32 i64 u8 u16 u32 u64);
quotable!("a number as a string": f32 f64);

macro_rules! lenient_integers {
    ($($integer:ty)*) => {$(
        impl ReadLenientNumber for $integer {
            fn read_lenient(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
                reader.lenient_integer()
            }
        }
    )*};
}

lenient_integers!(i8 i16 i32 i64 u8 u16 u32 u64);

macro_rules! lenient_floats {
    ($($float:ident)*) => {$(
        impl ReadLenientNumber for $float {
            fn read_lenient(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
                if reader.peek() != Some(b'"') {
                    return reader.$float();
                }
                reader.quoted("a number", |inside| match inside.hexadecimal::<u64>() {
                    // The integer is converted to the nearest float.
                    #[allow(
                        clippy::cast_precision_loss,
                        reason = "the nearest value is what is wanted"
                    )]
                    Some(value) => value.map(|value| value as $float),
                    None => Self::read(inside),
                })
            }
        }
    )*};
}

lenient_floats!(f32 f64);

impl AsNumber for bool {
    fn read_number(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        reader.zero_or_one("0 or 1")
    }

    fn write_number(&self, writer: &mut Writer<'_>) {
        writer.integer(u8::from(*self));
    }
}

impl ReadLenientBool for bool {
    fn read_lenient(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        match reader.peek() {
            Some(b'"') => reader.quoted("true or false", Self::read),
            Some(b'-' | b'0'..=b'9') => reader.zero_or_one("true, false, 0 or 1"),
            _ => reader.bool(),
        }
    }
}

macro_rules! containers {
    ($($form:ident: $read:ident $($write:ident)?;)*) => {$(
        impl<T: $form> $form for Option<T> {
            fn $read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
                if reader.take_null() {
                    return Ok(None);
                }
                T::$read(reader).map(Some)
            }

            $(fn $write(&self, writer: &mut Writer<'_>) {
                match self {
                    Some(value) => value.$write(writer),
                    None => writer.null(),
                }
            })?
        }

        impl<T: $form> $form for Vec<T> {
            fn $read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
                reader.list(T::$read)
            }

            $(fn $write(&self, writer: &mut Writer<'_>) {
                writer.list(self, T::$write);
            })?
        }
    )*};
}

containers! {
    Quotable: read_quoted write_quoted;
    AsNumber: read_number write_number;
    ReadLenientNumber: read_lenient;
    ReadLenientBool: read_lenient;
}
