//! What a number of JSON amounts to.

use fc_spec::model::FloatKind;

/// An integral number in any notation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Integral {
    /// This integer.
    Value(i128),
    /// One past 64 bits.
    TooLarge,
    /// No integer.
    Fraction,
}

/// What the text of a number amounts to as an integer. Exactly, unlike by way of a float, which would make one number
/// of `9007199254740993.0` and its neighbour.
pub(crate) fn integral(number: &str) -> Integral {
    let magnitude = number.strip_prefix('-').unwrap_or(number);
    let (mantissa, exponent) = match magnitude.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, power(exponent)),
        None => (magnitude, 0),
    };
    let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = whole.bytes().chain(part.bytes());
    let zeros = digits.clone().rev().take_while(|digit| *digit == b'0');
    let zeros = zeros.count();
    let significant = whole.len() + part.len() - zeros;
    if significant == 0 {
        return Integral::Value(0);
    }
    // The zeros at the end belong to the power of ten.
    let signed = |length: usize| i64::try_from(length).unwrap_or(i64::MAX);
    let power = exponent.saturating_add(signed(zeros) - signed(part.len()));
    let Ok(power) = u32::try_from(power.min(u32::MAX.into())) else {
        return Integral::Fraction;
    };
    let digit = |value: u64, digit: u8| {
        let tens = value.checked_mul(10)?;
        tens.checked_add(u64::from(digit.wrapping_sub(b'0')))
    };
    let mut digits = digits.take(significant);
    let value = digits.try_fold(0, digit).and_then(|value| {
        let scale = 10_u64.checked_pow(power)?;
        value.checked_mul(scale)
    });
    match value {
        Some(value) if number.starts_with('-') => Integral::Value(-i128::from(value)),
        Some(value) => Integral::Value(value.into()),
        None => Integral::TooLarge,
    }
}

/// The value of an exponent. Past 64 bits, where it matters only that it is far from zero, the nearest that they have.
fn power(exponent: &str) -> i64 {
    let far = if exponent.starts_with('-') {
        i64::MIN
    } else {
        i64::MAX
    };
    exponent.parse().unwrap_or(far)
}

/// The float nearest to the text of a number, widened; `None` where that is infinite.
pub(crate) fn float(number: &str, kind: FloatKind) -> Option<f64> {
    let nearest = match kind {
        FloatKind::F32 => number.parse::<f32>().ok().map(f64::from),
        FloatKind::F64 => number.parse().ok(),
    };
    nearest.filter(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_are_exact_in_every_notation() {
        for (text, value) in [
            ("0", 0),
            ("-0", 0),
            ("0e999999999999999999999", 0),
            ("1.0", 1),
            ("1e2", 100),
            ("12300e-2", 123),
            ("-5.0E+1", -50),
            ("9007199254740993.0", 9_007_199_254_740_993),
            ("18446744073709551615", u64::MAX.into()),
            ("-18446744073709551615", -i128::from(u64::MAX)),
        ] {
            assert_eq!(integral(text), Integral::Value(value), "{text}");
        }
        for text in [
            "1.5",
            "1e-1",
            "1e-400",
            "0.000000000000000000001",
            "256.5",
            "1.5e-99999999999999999999",
        ] {
            assert_eq!(integral(text), Integral::Fraction, "{text}");
        }
        for text in [
            "18446744073709551616",
            "1e20",
            "1e99999999999999999999",
            "10e99999999999999999999",
            "-1e400",
        ] {
            assert_eq!(integral(text), Integral::TooLarge, "{text}");
        }
    }

    #[test]
    fn floats_are_those_of_their_type() {
        assert_eq!(float("1e39", FloatKind::F32), None);
        assert_eq!(float("1e39", FloatKind::F64), Some(1e39));
        assert_eq!(float("0.1", FloatKind::F32), Some(f64::from(0.1_f32)));
        assert_eq!(float("1e-400", FloatKind::F64), Some(0.0));
    }
}
