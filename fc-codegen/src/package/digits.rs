//! Integer literals for languages that allow digit separators.

/// Groups the digits by three if there are five or more: `16_777_216`.
pub fn grouped(value: i128) -> String {
    let digits = value.unsigned_abs().to_string();
    let mut out = if value < 0 {
        "-".to_owned()
    } else {
        String::new()
    };
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) && digits.len() > 4 {
            out.push('_');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::grouped;

    #[test]
    fn five_digits_and_more() {
        for (value, expected) in [
            (0, "0"),
            (5656, "5656"),
            (65_536, "65_536"),
            (-123_456, "-123_456"),
            (-1_234_567, "-1_234_567"),
        ] {
            assert_eq!(grouped(value), expected);
        }
    }
}
