//! Writes floats of measurements: few digits before and after the decimal point.

/// Digits after the point.
const DECIMALS: usize = 6;
/// Ten to the power of [`DECIMALS`].
const SCALE: u64 = 1_000_000;
/// Largest scaled value. It has 15 digits, and no two numbers of 15 digits have the same nearest float.
const LARGEST: f64 = 999_999_999_999_999.0;
/// Smaller values are written with an exponent.
const SMALLEST: f64 = 1_000.0;

/// Buffer for sign, digits and point. They are at its end.
#[derive(Debug, Default)]
pub(super) struct Decimal([u8; 24]);

/// Index of the point.
const POINT: usize = 24 - DECIMALS - 1;

impl Decimal {
    /// Returns the shortest text that reads back as `value`, or `None` if `value` has more than six digits after the
    /// point.
    ///
    /// At most one decimal of up to 15 digits reads back as `value`, so the found one is the shortest. The check
    /// divides two exact floats. Their quotient is the nearest float, which is the result of a parser.
    #[inline]
    pub(super) fn format(&mut self, value: f64) -> Option<&[u8]> {
        #[allow(clippy::cast_precision_loss, reason = "exact")]
        const SCALE_FLOAT: f64 = SCALE as f64;
        let scaled = value.abs() * SCALE_FLOAT;
        if scaled != 0.0 && !(SMALLEST..=LARGEST).contains(&scaled) {
            return None;
        }
        // Signed, because processors convert signed integers faster.
        #[allow(
            clippy::cast_possible_truncation,
            reason = "within the bounds checked above"
        )]
        let units = (scaled + 0.5) as i64;
        #[allow(clippy::cast_precision_loss, reason = "exact: below 2^53")]
        let back = units as f64 / SCALE_FLOAT;
        #[allow(clippy::float_cmp, reason = "the very same float is wanted")]
        if back != value.abs() {
            return None;
        }
        Some(self.write(value.is_sign_negative(), units.unsigned_abs()))
    }

    /// Writes `units` millionths.
    fn write(&mut self, negative: bool, units: u64) -> &[u8] {
        let Self(room) = self;
        let (mut whole, part) = (units / SCALE, units % SCALE);
        let pairs = [part / 10_000, part / 100 % 100, part % 100].map(pair);
        let decimals = pairs.as_flattened();
        if let Some(place) = room.last_chunk_mut::<DECIMALS>() {
            place.copy_from_slice(decimals);
        }
        // At least one digit remains after the point.
        let zeros = decimals
            .iter()
            .skip(1)
            .rev()
            .take_while(|&&digit| digit == b'0')
            .count();
        let end = room.len() - zeros;

        let mut start = POINT;
        put(room, start, [b'.']);
        loop {
            let pair = pair(whole % 100);
            start -= 2;
            put(room, start, pair);
            whole /= 100;
            if whole == 0 {
                start += usize::from(pair.starts_with(b"0"));
                break;
            }
        }
        if negative {
            start -= 1;
            put(room, start, [b'-']);
        }
        room.get(start..end).unwrap_or_default()
    }
}

#[inline]
fn put<const N: usize>(room: &mut [u8], start: usize, digits: [u8; N]) {
    if let Some(place) = room.get_mut(start..).and_then(<[u8]>::first_chunk_mut) {
        *place = digits;
    }
}

/// Returns the two digits of a number below 100.
#[inline]
fn pair(value: u64) -> [u8; 2] {
    const PAIRS: [[u8; 2]; 100] = pairs();
    usize::try_from(value)
        .ok()
        .and_then(|index| PAIRS.get(index))
        .copied()
        .unwrap_or(*b"00")
}

const fn pairs() -> [[u8; 2]; 100] {
    let mut pairs = [*b"00"; 100];
    let mut tens = 0;
    while tens < 10 {
        let mut ones = 0;
        while ones < 10 {
            #[allow(clippy::indexing_slicing, reason = "evaluated by the compiler")]
            {
                pairs[(tens * 10 + ones) as usize] = [b'0' + tens, b'0' + ones];
            }
            ones += 1;
        }
        tens += 1;
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::Decimal;
    use proptest::prelude::*;

    fn agrees(value: f64) -> Result<(), TestCaseError> {
        let mut decimal = Decimal::default();
        if let Some(text) = decimal.format(value) {
            let mut buffer = zmij::Buffer::new();
            prop_assert_eq!(std::str::from_utf8(text), Ok(buffer.format(value)));
        }
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[fc_test::test]
        fn written_number_is_the_shortest(units in -2_000_000_000_000_000_i64..2_000_000_000_000_000, digits in 0..9_i32) {
            #[allow(clippy::cast_precision_loss, reason = "any float will do")]
            let value = units as f64 / 10_f64.powi(digits);
            agrees(value)?;
            agrees(f64::from_bits(value.to_bits() + 1))?;
            agrees(value / 10_f64.powi(9))?;
        }

        #[fc_test::test]
        fn short_decimals_are_written_here(units in 1_000_u64..999_999_999_999_999) {
            #[allow(clippy::cast_precision_loss, reason = "exact")]
            let value = units as f64 / 1e6;
            prop_assert!(Decimal::default().format(value).is_some());
        }
    }

    #[fc_test::test]
    fn corners() {
        for value in [
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            10.0,
            99.0,
            100.0,
            1000.0,
            0.001,
            -0.001,
            0.000_999,
            0.1,
            0.000_001,
            999_999_999.999_999,
            1e9,
            1e15,
            1e16,
            0.3,
            0.1 + 0.2,
            123.456,
            1e-7,
            f64::MIN_POSITIVE,
            f64::MAX,
            f64::EPSILON,
            9_007_199_254.740_993,
        ] {
            assert!(agrees(value).is_ok(), "{value}");
        }
        assert_eq!(Decimal::default().format(-0.0), Some(b"-0.0".as_slice()));
        assert_eq!(Decimal::default().format(f64::NAN), None);
    }
}
