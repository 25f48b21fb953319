//! Conversions between the fields of an envelope and the values of the runtime. `#[derive(Envelope)]` calls them.

/// A field of an envelope that is created from a `T`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be a field of an envelope with this role",
    note = "a time is `i64`, a result code an integer, a result text `String`; each may be an `Option`"
)]
pub trait Part<T> {
    /// Creates the field.
    fn make(value: T) -> Self;
}

/// A field of an envelope that is read as a `T`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be a field of an envelope with this role",
    note = "a time is `i64`, a result code an integer, a result text `String`; each may be an `Option`"
)]
pub trait Taken<T> {
    /// Returns the value.
    fn take(&self) -> T;
}

/// A field of an envelope that contains a string.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be the result text of an envelope",
    note = "a result text is `String` or `Option<String>`"
)]
pub trait Text {
    /// Returns the string, or an empty one if the field is absent.
    fn as_text(&self) -> &str;
}

macro_rules! codes {
    ($($integer:ty)*) => {$(
        /// A code outside the range of the field is clamped.
        impl Part<i64> for $integer {
            fn make(value: i64) -> Self {
                let nearest = if value < 0 { Self::MIN } else { Self::MAX };
                Self::try_from(value).unwrap_or(nearest)
            }
        }

        impl Part<i64> for Option<$integer> {
            fn make(value: i64) -> Self {
                Some(<$integer>::make(value))
            }
        }

        impl Taken<Option<i64>> for $integer {
            fn take(&self) -> Option<i64> {
                Some(i64::try_from(*self).unwrap_or(i64::MAX))
            }
        }

        impl Taken<Option<i64>> for Option<$integer> {
            fn take(&self) -> Option<i64> {
                self.as_ref().and_then(Taken::take)
            }
        }
    )*};
}

codes!(i8 i16 i32 i64 u8 u16 u32 u64);

impl Part<&str> for String {
    fn make(value: &str) -> Self {
        value.to_owned()
    }
}

impl Part<&str> for Option<String> {
    fn make(value: &str) -> Self {
        Some(value.to_owned())
    }
}

impl Text for String {
    fn as_text(&self) -> &str {
        self
    }
}

impl Text for Option<String> {
    fn as_text(&self) -> &str {
        self.as_deref().unwrap_or_default()
    }
}
