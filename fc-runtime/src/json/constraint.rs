//! The constraints of the spec: `min`, `max`, `length`, `pattern`, `only`.

use super::{BodyError, BodyErrorKind, Bytes64};
use regex_lite::Regex;
use std::cmp::Ordering;
use std::fmt;
use std::sync::OnceLock;

/// The smallest or largest value of a number, as written in the spec.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// An integer.
    Int(i128),
    /// A decimal fraction.
    Float(f64),
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Int(value) => write!(f, "{value}"),
            Self::Float(value) => write!(f, "{value:?}"),
        }
    }
}

/// Numbers that can be compared with a limit. An absent value satisfies every constraint; a list satisfies it if all
/// items do.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a number",
    note = "`min` and `max` are for numbers, and options and lists of them"
)]
pub trait Bounded {
    /// Returns `true` if every number inside is equal to `limit`, or compares to it as `wanted`. NaN never does.
    fn all_within(&self, limit: Limit, wanted: Ordering) -> bool;
}

macro_rules! bounded {
    ($wide:ty: $($number:ty)*) => {$(
        impl Bounded for $number {
            #[inline]
            fn all_within(&self, limit: Limit, wanted: Ordering) -> bool {
                #[allow(
                    clippy::cast_precision_loss,
                    clippy::cast_lossless,
                    reason = "a float, or a limit with a fraction, is compared as a float"
                )]
                let order = match limit {
                    Limit::Int(limit) => <$wide>::from(*self).partial_cmp(&(limit as $wide)),
                    Limit::Float(limit) => (*self as f64).partial_cmp(&limit),
                };
                order.is_some_and(|order| order == wanted || order == Ordering::Equal)
            }
        }
    )*};
}

bounded!(i128: i8 i16 i32 i64 u8 u16 u32 u64);
bounded!(f64: f32 f64);

impl<T: Bounded> Bounded for Option<T> {
    #[inline]
    fn all_within(&self, limit: Limit, wanted: Ordering) -> bool {
        self.as_ref()
            .is_none_or(|value| value.all_within(limit, wanted))
    }
}

impl<T: Bounded> Bounded for Vec<T> {
    fn all_within(&self, limit: Limit, wanted: Ordering) -> bool {
        self.iter().all(|value| value.all_within(limit, wanted))
    }
}

/// Checks `min`.
///
/// # Errors
/// `out_of_range`.
#[inline]
pub fn min<T: Bounded>(key: &'static str, value: &T, limit: Limit) -> Result<(), BodyError> {
    if value.all_within(limit, Ordering::Greater) {
        Ok(())
    } else {
        Err(out_of_range(key, "at least", limit))
    }
}

/// Checks `max`.
///
/// # Errors
/// `out_of_range`.
#[inline]
pub fn max<T: Bounded>(key: &'static str, value: &T, limit: Limit) -> Result<(), BodyError> {
    if value.all_within(limit, Ordering::Less) {
        Ok(())
    } else {
        Err(out_of_range(key, "at most", limit))
    }
}

#[cold]
fn out_of_range(key: &'static str, relation: &str, limit: Limit) -> BodyError {
    BodyError::new(
        BodyErrorKind::OutOfRange,
        format!("the number must be {relation} {limit}"),
    )
    .in_key(key)
}

/// Values that have a length.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no length",
    note = "`length` is for `String`, `Vec` and `Bytes64`, and options of them"
)]
pub trait Measured {
    /// Returns the number of characters of a string, items of a list, or bytes of base64; `None` for an absent value.
    fn measure(&self) -> Option<usize>;
}

impl Measured for String {
    fn measure(&self) -> Option<usize> {
        Some(self.chars().count())
    }
}

impl Measured for Bytes64 {
    fn measure(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

impl<T> Measured for Vec<T> {
    fn measure(&self) -> Option<usize> {
        Some(self.len())
    }
}

impl<T: Measured> Measured for Option<T> {
    fn measure(&self) -> Option<usize> {
        self.as_ref().and_then(T::measure)
    }
}

/// Checks `length`, both ends included.
///
/// # Errors
/// `bad_length`.
pub fn length<T: Measured>(
    key: &'static str,
    value: &T,
    least: usize,
    most: usize,
) -> Result<(), BodyError> {
    match value.measure() {
        Some(length) if !(least..=most).contains(&length) => {
            let wanted = if least == most {
                format!("{least}")
            } else if most == usize::MAX {
                format!("at least {least}")
            } else {
                format!("from {least} to {most}")
            };
            Err(BodyError::new(
                BodyErrorKind::BadLength,
                format!("the length is {length}; it must be {wanted}"),
            )
            .in_key(key))
        }
        _ => Ok(()),
    }
}

/// A regular expression that must match a whole string. It is compiled at first use.
#[derive(Debug)]
pub struct Pattern {
    source: &'static str,
    compiled: OnceLock<Option<Regex>>,
}

impl Pattern {
    /// Creates a pattern. An invalid regular expression matches nothing; the derive reports it.
    #[must_use]
    pub const fn new(source: &'static str) -> Self {
        Self {
            source,
            compiled: OnceLock::new(),
        }
    }

    fn matches(&self, text: &str) -> bool {
        let compiled = self
            .compiled
            .get_or_init(|| Regex::new(&format!("^(?:{})$", self.source)).ok());
        compiled.as_ref().is_some_and(|regex| regex.is_match(text))
    }
}

/// Values that a pattern can be matched against.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not text",
    note = "`pattern` is for `String`, and options and lists of it"
)]
pub trait Patterned {
    /// Returns `true` if every string inside satisfies `matches`.
    fn all_match(&self, matches: &dyn Fn(&str) -> bool) -> bool;
}

impl Patterned for String {
    fn all_match(&self, matches: &dyn Fn(&str) -> bool) -> bool {
        matches(self)
    }
}

impl<T: Patterned> Patterned for Option<T> {
    fn all_match(&self, matches: &dyn Fn(&str) -> bool) -> bool {
        self.as_ref().is_none_or(|value| value.all_match(matches))
    }
}

impl<T: Patterned> Patterned for Vec<T> {
    fn all_match(&self, matches: &dyn Fn(&str) -> bool) -> bool {
        self.iter().all(|value| value.all_match(matches))
    }
}

/// Checks `pattern`.
///
/// # Errors
/// `bad_pattern`.
pub fn matches<T: Patterned>(
    key: &'static str,
    value: &T,
    pattern: &Pattern,
) -> Result<(), BodyError> {
    if value.all_match(&|text| pattern.matches(text)) {
        return Ok(());
    }
    Err(BodyError::new(
        BodyErrorKind::BadPattern,
        format!("the string must match `{}` as a whole", pattern.source),
    )
    .in_key(key))
}

/// Enum values that can be compared with the values allowed for a field.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an enum of values",
    note = "`only` is for enums with `#[derive(OpenEnum)]`, and options and lists of them; `when` and `unless` ask for integers, bools and strings as well"
)]
pub trait Chosen {
    /// The type that is sent: an integer or a string.
    type Wire: Copy + fmt::Display + 'static;

    /// Returns `true` if the sent form of every value inside is one of `taken`.
    fn all_among(&self, taken: &[Self::Wire]) -> bool;
}

impl<T: Chosen> Chosen for Option<T> {
    type Wire = T::Wire;

    #[inline]
    fn all_among(&self, taken: &[T::Wire]) -> bool {
        self.as_ref().is_none_or(|value| value.all_among(taken))
    }
}

impl<T: Chosen> Chosen for Vec<T> {
    type Wire = T::Wire;

    fn all_among(&self, taken: &[T::Wire]) -> bool {
        self.iter().all(|value| value.all_among(taken))
    }
}

/// Checks `only`. An unknown value of an open enum is never allowed.
///
/// # Errors
/// `out_of_range`.
#[inline]
pub fn only<T: Chosen>(
    key: &'static str,
    value: &T,
    taken: &'static [T::Wire],
) -> Result<(), BodyError> {
    if value.all_among(taken) {
        Ok(())
    } else {
        Err(not_taken(key, taken))
    }
}

#[cold]
fn not_taken<W: fmt::Display>(key: &'static str, taken: &[W]) -> BodyError {
    let taken: Vec<String> = taken.iter().map(W::to_string).collect();
    BodyError::new(
        BodyErrorKind::OutOfRange,
        format!("the value must be one of: {}", taken.join(", ")),
    )
    .in_key(key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[fc_test::test]
    fn limits_compare_exactly() {
        assert!(min("x", &u64::MAX, Limit::Int(i64::MAX.into())).is_ok());
        assert!(max("x", &u64::MAX, Limit::Int(i64::MAX.into())).is_err());
        assert!(min("x", &0_u8, Limit::Int(-1)).is_ok());
        assert!(min("x", &-1_i8, Limit::Int(0)).is_err());
        assert!(max("x", &0.5_f32, Limit::Float(0.5)).is_ok());
        assert!(max("x", &1_i32, Limit::Float(0.5)).is_err());
        assert!(min("x", &f64::NAN, Limit::Int(0)).is_err());
        assert!(max("x", &f64::NAN, Limit::Int(0)).is_err());
        assert!(max("x", &None::<u8>, Limit::Int(0)).is_ok());
        assert!(max("x", &vec![0, 1_u8], Limit::Int(0)).is_err());
    }

    #[fc_test::test]
    fn a_pattern_matches_the_whole_string() {
        let digits = Pattern::new("[0-9]+|x");
        assert!(matches("x", &String::from("12"), &digits).is_ok());
        for wrong in ["", "12a", "a12", "12\n", "x2"] {
            assert!(
                matches("x", &String::from(wrong), &digits).is_err(),
                "{wrong}"
            );
        }
        assert!(matches("x", &None::<String>, &digits).is_ok());
        assert!(matches("x", &String::from("("), &Pattern::new("(")).is_err());
    }

    #[fc_test::test]
    fn length_counts_characters_items_and_bytes() {
        assert!(length("x", &String::from("机器人"), 3, 3).is_ok());
        assert!(length("x", &vec![1, 2], 0, 1).is_err());
        assert!(length("x", &Bytes64(vec![1, 2]), 2, usize::MAX).is_ok());
        assert!(length("x", &None::<String>, 1, 1).is_ok());
    }
}
