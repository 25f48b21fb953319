//! JSON forms of the primitive types.

use super::{BodyError, BodyErrorKind, FromJson, Reader, ToJson, Writer};

macro_rules! scalars {
    ($method:ident: $($scalar:ty)*) => {$(
        impl FromJson for $scalar {
            #[inline]
            fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
                reader.$method()
            }
        }

        impl ToJson for $scalar {
            #[inline]
            fn write(&self, writer: &mut Writer<'_>) {
                writer.$method(*self);
            }
        }
    )*};
}

scalars!(integer: i8 i16 i32 i64 u8 u16 u32 u64);
scalars!(bool: bool);

macro_rules! floats {
    ($($float:ident)*) => {$(
        impl FromJson for $float {
            #[inline]
            fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
                reader.$float()
            }
        }

        /// The check rejects NaN and infinities: JSON does not have them, and `null` in their place would be read as an
        /// absent field.
        impl ToJson for $float {
            #[inline]
            fn write(&self, writer: &mut Writer<'_>) {
                writer.$float(*self);
            }

            #[inline]
            fn check_value(&self) -> Result<(), BodyError> {
                if self.is_finite() {
                    Ok(())
                } else {
                    Err(not_finite())
                }
            }
        }
    )*};
}

floats!(f32 f64);

#[cold]
fn not_finite() -> BodyError {
    BodyError::new(
        BodyErrorKind::OutOfRange,
        "JSON has neither NaN nor infinities; send a finite number",
    )
}

impl FromJson for String {
    #[inline]
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        reader.string().map(std::borrow::Cow::into_owned)
    }
}

impl ToJson for String {
    #[inline]
    fn write(&self, writer: &mut Writer<'_>) {
        writer.string(self);
    }
}

impl<T: FromJson> FromJson for Vec<T> {
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        reader.list(T::read)
    }
}

impl<T: ToJson> ToJson for Vec<T> {
    fn write(&self, writer: &mut Writer<'_>) {
        writer.array(self);
    }

    fn check_value(&self) -> Result<(), BodyError> {
        for (index, item) in self.iter().enumerate() {
            item.check_value().map_err(|error| error.in_item(index))?;
        }
        Ok(())
    }
}

/// `null` and an absent key are `None`; `None` is not written.
impl<T: FromJson> FromJson for Option<T> {
    const OPTIONAL: bool = true;

    #[inline]
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        if reader.take_null() {
            return Ok(None);
        }
        T::read(reader).map(Some)
    }

    #[inline]
    fn absent() -> Option<Self> {
        Some(None)
    }
}

impl<T: ToJson> ToJson for Option<T> {
    #[inline]
    fn write(&self, writer: &mut Writer<'_>) {
        match self {
            Some(value) => value.write(writer),
            // A list has no key that could be left out.
            None => writer.null(),
        }
    }

    #[inline]
    fn is_absent(&self) -> bool {
        self.is_none()
    }

    fn check_value(&self) -> Result<(), BodyError> {
        self.as_ref().map_or(Ok(()), T::check_value)
    }
}
