//! How the fields of an envelope are made from what the runtime knows, and back.
//! `#[derive(Envelope)]` calls this.

/// A field of an envelope that holds a `T`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be a field of an envelope with this role",
    note = "a time is `i64`, a result code an integer, a result text `String`; each may be an `Option`"
)]
pub trait Part<T> {
    /// The field with this value.
    fn make(value: T) -> Self;
}

/// A field of an envelope from which a `T` can be taken.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be a field of an envelope with this role",
    note = "a time is `i64`, a result code an integer, a result text `String`; each may be an `Option`"
)]
pub trait Taken<T> {
    /// Its value.
    fn take(&self) -> T;
}

/// A field of an envelope that holds a text.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be the result text of an envelope",
    note = "a result text is `String` or `Option<String>`"
)]
pub trait Text {
    /// The text, empty if there is none.
    fn as_text(&self) -> &str;
}

macro_rules! codes {
    ($($integer:ty)*) => {$(
        /// A code that the field cannot hold becomes the nearest that it can.
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
