//! Numbers of JSON text.

use super::{BodyError, BodyErrorKind, Reader};

/// An integer type that JSON integers are read into and written from.
pub trait Integer: Copy + Sized {
    /// Returns the value with this sign and magnitude, or `None` if the type cannot represent it.
    fn from_parts(negative: bool, magnitude: u64) -> Option<Self>;
    /// Smallest and largest value, for error texts.
    const RANGE: (i128, i128);
}

macro_rules! integer {
    (signed: $($signed:ty)*; unsigned: $($unsigned:ty)*) => {
        $(impl Integer for $signed {
            #[inline]
            fn from_parts(negative: bool, magnitude: u64) -> Option<Self> {
                if negative {
                    0_i64.checked_sub_unsigned(magnitude)?.try_into().ok()
                } else {
                    magnitude.try_into().ok()
                }
            }
            const RANGE: (i128, i128) = (<$signed>::MIN as i128, <$signed>::MAX as i128);
        })*
        $(impl Integer for $unsigned {
            #[inline]
            fn from_parts(negative: bool, magnitude: u64) -> Option<Self> {
                if negative && magnitude != 0 {
                    None
                } else {
                    magnitude.try_into().ok()
                }
            }
            const RANGE: (i128, i128) = (0, <$unsigned>::MAX as i128);
        })*
    };
}

integer!(signed: i8 i16 i32 i64; unsigned: u8 u16 u32 u64);

/// Number of decimal digits that always fit into a `u64`.
const SAFE_DIGITS: usize = 19;

impl Reader<'_> {
    /// Reads an integer in any notation: `1.0` and `1e2` are integers, as in JSON Schema.
    ///
    /// # Errors
    /// `wrong_type`, also for a number that is not integral; `out_of_range`; `bad_json`.
    #[inline]
    pub fn integer<T: Integer>(&mut self) -> Result<T, BodyError> {
        let Some(b'-' | b'0'..=b'9') = self.peek() else {
            return Err(self.unexpected("an integer"));
        };
        let start = self.at;
        let negative = self.minus();
        let (magnitude, count) = self.whole_digits()?;
        if let Some(b'.' | b'e' | b'E') = self.byte() {
            return self.in_another_notation(start);
        }
        let magnitude = if count <= SAFE_DIGITS {
            Some(magnitude)
        } else {
            // Parse the digits again with a check for overflow.
            self.since(self.at - count).parse().ok()
        };
        let value = magnitude.and_then(|magnitude| T::from_parts(negative, magnitude));
        value.ok_or_else(|| {
            self.at = start;
            self.out_of_range::<T>()
        })
    }

    #[cold]
    pub(super) fn out_of_range<T: Integer>(&self) -> BodyError {
        let (min, max) = T::RANGE;
        self.fault(
            BodyErrorKind::OutOfRange,
            format!("the number must be from {min} to {max}"),
        )
    }

    /// Reads an integer that is written with a fraction or an exponent.
    #[cold]
    fn in_another_notation<T: Integer>(&mut self, start: usize) -> Result<T, BodyError> {
        self.at = start;
        self.skip_number()?;
        let text = self.since(start);
        let value = match amount(text) {
            Amount::Integer(magnitude) => T::from_parts(text.starts_with('-'), magnitude),
            Amount::TooLarge => None,
            Amount::Fraction => {
                self.at = start;
                return Err(self.fault(
                    BodyErrorKind::WrongType,
                    "found a number that is not integral; send an integer",
                ));
            }
        };
        value.ok_or_else(|| {
            self.at = start;
            self.out_of_range::<T>()
        })
    }

    #[inline]
    fn minus(&mut self) -> bool {
        let minus = self.byte() == Some(b'-');
        self.at += usize::from(minus);
        minus
    }

    /// Reads the digits before a fraction: `0`, or digits that do not start with `0`. Returns their value modulo 2^64
    /// and their number.
    #[inline]
    fn whole_digits(&mut self) -> Result<(u64, usize), BodyError> {
        let start = self.at;
        let (value, count) = self.digits(0);
        if count == 0 {
            return Err(self.bad_json("a digit is expected here"));
        }
        if count > 1 && self.text.as_bytes().get(start) == Some(&b'0') {
            self.at = start;
            return Err(self.bad_json("a number must not start with `0`"));
        }
        Ok((value, count))
    }

    /// Reads digits that continue those of `value`. Returns the value of all digits modulo 2^64, and the number of
    /// digits read here.
    #[inline]
    fn digits(&mut self, mut value: u64) -> (u64, usize) {
        let rest = self.rest();
        let mut count = 0;
        while let Some(byte @ b'0'..=b'9') = rest.get(count) {
            value = value.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
            count += 1;
        }
        self.at += count;
        (value, count)
    }

    /// Skips a number.
    pub(super) fn skip_number(&mut self) -> Result<(), BodyError> {
        self.minus();
        self.whole_digits()?;
        if self.byte() == Some(b'.') {
            self.at += 1;
            self.skip_digits()?;
        }
        if let Some(b'e' | b'E') = self.byte() {
            self.at += 1;
            if let Some(b'+' | b'-') = self.byte() {
                self.at += 1;
            }
            self.skip_digits()?;
        }
        Ok(())
    }

    fn skip_digits(&mut self) -> Result<(), BodyError> {
        match self.digits(0) {
            (_, 0) => Err(self.bad_json("a digit is expected here")),
            _ => Ok(()),
        }
    }

    /// Reads a number as the nearest `f64`.
    ///
    /// # Errors
    /// `wrong_type`; `out_of_range` if the nearest value is infinite; `bad_json`.
    #[inline]
    pub fn f64(&mut self) -> Result<f64, BodyError> {
        let start = self.begin_float()?;
        match self.short_float()? {
            Some(value) => Ok(value),
            None => self.long_float(start, f64::is_finite),
        }
    }

    /// Reads a number as the nearest `f32`.
    ///
    /// # Errors
    /// `wrong_type`; `out_of_range` if the nearest value is infinite; `bad_json`.
    pub fn f32(&mut self) -> Result<f32, BodyError> {
        let start = self.begin_float()?;
        self.skip_number()?;
        self.long_float(start, f32::is_finite)
    }

    #[inline]
    fn begin_float(&mut self) -> Result<usize, BodyError> {
        match self.peek() {
            Some(b'-' | b'0'..=b'9') => Ok(self.at),
            _ => Err(self.unexpected("a number")),
        }
    }

    /// Reads a number. Returns its value if one division of two exact floats yields it: such a quotient is the nearest
    /// float (Clinger).
    #[inline]
    fn short_float(&mut self) -> Result<Option<f64>, BodyError> {
        /// The powers of ten that are exact as `f64`.
        const POWERS: [f64; 23] = [
            1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
            1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
        ];
        /// Integers up to this value are exact as `f64`.
        const EXACT: u64 = 1 << 53;

        let start = self.at;
        let negative = self.minus();
        let (mut value, whole) = self.whole_digits()?;
        let mut decimals = 0;
        if self.byte() == Some(b'.') {
            self.at += 1;
            (value, decimals) = self.digits(value);
            if decimals == 0 {
                return Err(self.bad_json("a digit is expected after `.`"));
            }
        }
        if let Some(b'e' | b'E') = self.byte() {
            self.at = start;
            self.skip_number()?;
            return Ok(None);
        }
        let Some(power) = POWERS.get(decimals) else {
            return Ok(None);
        };
        if whole + decimals > SAFE_DIGITS || value > EXACT {
            return Ok(None);
        }
        #[allow(
            clippy::cast_precision_loss,
            reason = "checked above: the value is exact"
        )]
        let value = value as f64 / power;
        Ok(Some(if negative { -value } else { value }))
    }

    /// Converts the number that has been read since `start`.
    fn long_float<T: Copy + std::str::FromStr>(
        &mut self,
        start: usize,
        is_finite: fn(T) -> bool,
    ) -> Result<T, BodyError> {
        match self.since(start).parse::<T>() {
            Ok(value) if is_finite(value) => Ok(value),
            _ => {
                self.at = start;
                Err(self.fault(
                    BodyErrorKind::OutOfRange,
                    "the number is too large for the floating-point type of the field",
                ))
            }
        }
    }
}

/// The magnitude of a number.
enum Amount {
    Integer(u64),
    /// An integer of more than 64 bits.
    TooLarge,
    /// Not an integer.
    Fraction,
}

/// Returns the exact magnitude of a number in any notation. A float would map `9007199254740993.0` and its neighbour to
/// the same value.
fn amount(number: &str) -> Amount {
    let number = number.trim_start_matches('-');
    let (mantissa, exponent) = match number.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, power(exponent)),
        None => (number, 0),
    };
    let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = whole.bytes().chain(part.bytes());
    let zeros = digits.clone().rev().take_while(|digit| *digit == b'0');
    let zeros = zeros.count();
    let significant = whole.len() + part.len() - zeros;
    if significant == 0 {
        return Amount::Integer(0);
    }
    // Trailing zeros count as powers of ten.
    let signed = |length: usize| i64::try_from(length).unwrap_or(i64::MAX);
    let power = exponent.saturating_add(signed(zeros) - signed(part.len()));
    let Ok(power) = u32::try_from(power.min(u32::MAX.into())) else {
        return Amount::Fraction;
    };
    let digit = |value: u64, digit: u8| {
        let tens = value.checked_mul(10)?;
        tens.checked_add(u64::from(digit - b'0'))
    };
    let mut digits = digits.take(significant);
    let magnitude = digits.try_fold(0, digit).and_then(|value| {
        let scale = 10_u64.checked_pow(power)?;
        value.checked_mul(scale)
    });
    magnitude.map_or(Amount::TooLarge, Amount::Integer)
}

/// Returns the value of an exponent. Beyond 64 bits only its sign matters, so it is clamped.
fn power(exponent: &str) -> i64 {
    let far = if exponent.starts_with('-') {
        i64::MIN
    } else {
        i64::MAX
    };
    exponent.parse().unwrap_or(far)
}
