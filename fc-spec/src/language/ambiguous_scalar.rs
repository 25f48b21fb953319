//! Plain scalars that YAML readers parse differently.
//!
//! YAML 1.1 and 1.2 disagree on some numbers, booleans and dates.

use super::scalar::number_text;
use crate::model::{Number, Text};
use crate::text;
use regex_lite::Regex;
use std::sync::LazyLock;

/// Words that other YAML readers parse as booleans.
const AMBIGUOUS: &[&str] = &["on", "off", "yes", "no", "y", "n"];

/// Returns `true` if other YAML readers may parse this plain word as a boolean.
fn is_ambiguous(word: &str) -> bool {
    // Most words are longer than all of these.
    word.len() <= 3
        && AMBIGUOUS
            .iter()
            .any(|ambiguous| ambiguous.eq_ignore_ascii_case(word))
}

/// Returns the type that other YAML readers may give to a plain scalar, if this crate reads it as a string or a number.
pub(crate) fn misread(text: &str) -> Option<Text> {
    if is_ambiguous(text) || matches!(text, "True" | "TRUE" | "False" | "FALSE") {
        return Some(text!("布尔值", "a boolean"));
    }
    if text == "=" {
        return Some(text!("特殊值", "a special value"));
    }
    // Most texts begin with a letter.
    if !text.starts_with(|first: char| first.is_ascii_digit() || matches!(first, '.' | '+' | '-')) {
        return None;
    }
    if let Some(number) = number_text(text) {
        let hexadecimal = text.contains('x');
        let exponent = text.find(['e', 'E']).filter(|_| !hexadecimal);
        let is_agreed = exponent.is_none_or(|at| {
            let exponent = text.get(at + 1..).unwrap_or_default();
            let mantissa = text.get(..at).unwrap_or_default();
            mantissa.contains('.') && exponent.starts_with(['-', '+'])
        });
        let is_negative = matches!(number, Number::Int(value) if value < 0);
        return (!is_agreed || (hexadecimal && is_negative)).then_some(text!("文本", "text"));
    }
    let is = |pattern: &Option<Regex>| pattern.as_ref().is_some_and(|regex| regex.is_match(text));
    if is(&OTHER_DATES) {
        return Some(text!("日期", "a date"));
    }
    is(&OTHER_NUMBERS).then_some(text!("数值", "a number"))
}

/// Returns a notation that all YAML readers parse as this number.
pub(crate) fn agreed_number(text: &str) -> Option<String> {
    let number = number_text(text)?;
    let Some((mantissa, exponent)) = text.split_once(['e', 'E']).filter(|_| !text.contains('x'))
    else {
        return match number {
            Number::Int(value) => Some(value.to_string()),
            Number::Float(_) => Some(text.to_owned()),
        };
    };
    let fraction = if mantissa.contains('.') { "" } else { ".0" };
    let sign = if exponent.starts_with(['-', '+']) {
        ""
    } else {
        "+"
    };
    Some(format!("{mantissa}{fraction}e{sign}{exponent}"))
}

/// Numbers of YAML 1.1 and 1.2 that JSON does not have: `1_000`, `0o17`, `0b1`, `12:30:00`, `+5`, `.5`, `5.`, `.inf`.
static OTHER_NUMBERS: LazyLock<Option<Regex>> = LazyLock::new(|| {
    Regex::new(
        r"^([-+]?([0-9][0-9_]*(\.[0-9_]*)?([eE][-+]?[0-9]+)?|\.[0-9][0-9_]*([eE][-+]?[0-9]+)?|0b[01_]+|0o?[0-7_]+|0x[0-9a-fA-F_]+|[0-9][0-9_]*(:[0-5]?[0-9])+(\.[0-9_]*)?|\.(inf|Inf|INF))|\.(nan|NaN|NAN))$",
    )
    .ok()
});

/// Dates, optionally followed by a time.
static OTHER_DATES: LazyLock<Option<Regex>> = LazyLock::new(|| {
    Regex::new(r"^[0-9]{4}-[0-9]{1,2}-[0-9]{1,2}(([Tt]|[ \t]+)[0-9:.]+.*)?$").ok()
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_of_other_parsers_are_known() {
        for (text, expected) in [
            ("on", Some("a boolean")),
            ("TRUE", Some("a boolean")),
            ("1_000", Some("a number")),
            ("0o17", Some("a number")),
            ("0b101", Some("a number")),
            ("12:30", Some("a number")),
            ("12:30:00", Some("a number")),
            ("+5", Some("a number")),
            (".5", Some("a number")),
            ("5.", Some("a number")),
            ("-.inf", Some("a number")),
            (".nan", Some("a number")),
            ("1e3", Some("text")),
            ("-0x1F", Some("text")),
            ("2023-07-17", Some("a date")),
            ("2023-07-17 10:00:00", Some("a date")),
            ("=", Some("a special value")),
            ("1.0e+3", None),
            ("0x1F", None),
            ("-5", None),
            ("0.5", None),
            ("2023-07", None),
            ("192.168.1.3", None),
            ("1.2.3", None),
            ("-", None),
            ("2 m", None),
            ("once", None),
        ] {
            let found = misread(text).map(|text| text.en);
            assert_eq!(found.as_deref(), expected, "{text}");
        }
    }

    #[test]
    fn numbers_that_all_readers_take_for_one() {
        for (text, expected) in [
            ("1e3", "1.0e+3"),
            ("1.5E3", "1.5e+3"),
            ("2e-3", "2.0e-3"),
            ("-0x1F", "-31"),
        ] {
            assert_eq!(agreed_number(text).as_deref(), Some(expected), "{text}");
            assert_eq!(misread(expected), None, "{expected}");
        }
    }
}
