//! Numbers, strings and bytes survive being written and read, to the last bit.

use crate::tree::{number, string};
use fc_runtime::json::{Allowance, from_str, to_vec};
use fc_runtime::{Bytes64, FromJson, Serde, ToJson};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Debug;

fn text<T: ToJson>(value: &T) -> String {
    String::from_utf8(to_vec(value)).unwrap()
}

fn read<T: FromJson>(text: &str) -> Result<T, fc_runtime::BodyError> {
    from_str(text, Allowance::DEFAULT)
}

fn name<T: FromJson + Debug>(text: &str) -> &'static str {
    read::<T>(text).unwrap_err().name()
}

/// An integer type agrees with the standard library about a text of digits.
fn integer<T>(digits: &str) -> Result<(), TestCaseError>
where
    T: FromJson + ToJson + std::str::FromStr + PartialEq + Debug + ToString,
{
    let ours = read::<T>(digits);
    match digits.parse::<T>() {
        Ok(theirs) => {
            prop_assert_eq!(text(&theirs), theirs.to_string());
            prop_assert_eq!(ours, Ok(theirs));
        }
        Err(_) if digits == "-0" => prop_assert!(ours.is_ok()),
        Err(_) => prop_assert_eq!(ours.unwrap_err().name(), "out_of_range"),
    }
    Ok(())
}

fn integers(digits: &str) -> Result<(), TestCaseError> {
    integer::<i8>(digits)?;
    integer::<i16>(digits)?;
    integer::<i32>(digits)?;
    integer::<i64>(digits)?;
    integer::<u8>(digits)?;
    integer::<u16>(digits)?;
    integer::<u32>(digits)?;
    integer::<u64>(digits)
}

/// Both float types agree with the standard library about a number.
fn floats(number: &str) -> Result<(), TestCaseError> {
    let theirs: f64 = number.parse().unwrap();
    match read::<f64>(number) {
        Ok(ours) => prop_assert_eq!(ours.to_bits(), theirs.to_bits()),
        Err(error) => {
            prop_assert_eq!(error.name(), "out_of_range");
            prop_assert!(theirs.is_infinite());
        }
    }
    let theirs: f32 = number.parse().unwrap();
    match read::<f32>(number) {
        Ok(ours) => prop_assert_eq!(ours.to_bits(), theirs.to_bits()),
        Err(error) => {
            prop_assert_eq!(error.name(), "out_of_range");
            prop_assert!(theirs.is_infinite());
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[fc_test::test]
    fn integers_are_exact(digits in "-?(0|[1-9][0-9]{0,21})", near in any::<i64>()) {
        integers(&digits)?;
        integers(&near.to_string())?;
    }

    /// However the point and the exponent are put, the value stays the same.
    #[fc_test::test]
    fn integers_are_exact_in_any_notation(value in any::<i64>(), moved in 1..30_usize, zeros in "0{0,40}") {
        let minus = if value < 0 { "-" } else { "" };
        let digits = value.unsigned_abs().to_string();
        let padded = format!("{digits:0>31}");
        let (whole, part) = padded.split_at(padded.len() - moved);
        let whole = match whole.trim_start_matches('0') {
            "" => "0",
            whole => whole,
        };
        prop_assert_eq!(read::<i64>(&format!("{minus}{digits}.0{zeros}")), Ok(value));
        prop_assert_eq!(read::<i64>(&format!("{minus}{whole}.{part}{zeros}e{moved}")), Ok(value));
        if value != 0 {
            prop_assert_eq!(read::<i64>(&format!("{minus}{digits}{zeros}E-{}", zeros.len())), Ok(value));
        }
    }

    #[fc_test::test]
    fn floats_are_exact(number in number()) {
        floats(&number)?;
    }

    #[fc_test::test]
    fn written_floats_read_back(bits in any::<u64>(), bits32 in any::<u32>()) {
        let value = f64::from_bits(bits);
        if value.is_finite() {
            let text = text(&value);
            prop_assert_eq!(read::<f64>(&text).unwrap().to_bits(), bits);
            prop_assert_eq!(serde_json::from_str::<f64>(&text).unwrap().to_bits(), bits);
        } else {
            prop_assert_eq!(text(&value), "null");
        }
        let value = f32::from_bits(bits32);
        if value.is_finite() {
            prop_assert_eq!(read::<f32>(&text(&value)).unwrap().to_bits(), bits32);
        }
    }

    /// Numbers of the length that coordinates have take the fast way.
    #[fc_test::test]
    fn short_floats_are_exact(whole in 0..10_000_000_u64, decimals in "[0-9]{0,22}", minus in any::<bool>()) {
        let point = if decimals.is_empty() { "" } else { "." };
        floats(&format!("{}{whole}{point}{decimals}", if minus { "-" } else { "" }))?;
    }

    #[fc_test::test]
    fn strings_survive(value in any::<String>(), plain in "[ -~]{0,300}") {
        for value in [value, plain] {
            let text = text(&value);
            prop_assert_eq!(&serde_json::from_str::<String>(&text).unwrap(), &value);
            prop_assert_eq!(&read::<String>(&text).unwrap(), &value);
            prop_assert_eq!(&read::<String>(&serde_json::to_string(&value).unwrap()).unwrap(), &value);
        }
    }

    #[fc_test::test]
    fn escapes_are_understood(text in string()) {
        prop_assert_eq!(read::<String>(&text).unwrap(), serde_json::from_str::<String>(&text).unwrap());
    }

    #[fc_test::test]
    fn bytes_survive(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let bytes = Bytes64(bytes);
        let text = text(&bytes);
        prop_assert_eq!(text.len(), 2 + bytes.0.len().div_ceil(3) * 4);
        prop_assert_eq!(read::<Bytes64>(&text).unwrap(), bytes);
    }
}

#[fc_test::test]
fn the_corners_of_numbers() {
    for number in [
        "0",
        "-0",
        "0.0",
        "-0.0",
        "1e22",
        "1e23",
        "9007199254740993",
        "9007199254740992.5",
        "1e308",
        "1e309",
        "1.7976931348623157e308",
        "1.7976931348623159e308",
        "5e-324",
        "2e-324",
        "2.2250738585072011e-308",
        "0.1",
        "0.30000000000000004",
        "123456789012345678",
        "3.4028235e38",
        "3.4028236e38",
        "1e-46",
        "0.000000000000000000000000000000000000001",
        "18446744073709551616",
        "7.0060e-45",
        "1e-400",
    ] {
        floats(number).unwrap();
    }
    assert_eq!(read::<i8>("-0"), Ok(0));
    assert_eq!(read::<u64>("-0"), Ok(0));
    assert_eq!(name::<u64>("-1"), "out_of_range");
    assert_eq!(name::<i32>("true"), "wrong_type");
    assert_eq!(name::<f64>("\"1\""), "wrong_type");
    assert_eq!(name::<f64>("1e309"), "out_of_range");
    assert_eq!(name::<f32>("1e39"), "out_of_range");
    assert_eq!(read::<f64>("7"), Ok(7.0));
}

/// Numbers with a fraction or an exponent, and what they are as an integer of 64 bits.
const INTEGRAL: &[(&str, i128)] = &[
    ("1.0", 1),
    ("-1.0", -1),
    ("1.000000000000000000000000000000", 1),
    ("1e0", 1),
    ("1E+2", 100),
    ("1e2", 100),
    ("1.5e1", 15),
    ("150e-1", 15),
    ("0.15e2", 15),
    ("0.00000000000000000000000001e27", 10),
    ("100000000000000000000000000e-25", 10),
    ("0.0", 0),
    ("-0.0", 0),
    ("-0e-400", 0),
    ("0e400", 0),
    ("0e99999999999999999999999", 0),
    ("9007199254740993.0", 9_007_199_254_740_993),
    ("9223372036854775807.0", i64::MAX as i128),
    ("9223372036854775807e0", i64::MAX as i128),
    ("922337203685477580.7e1", i64::MAX as i128),
    ("-9223372036854775808.0", i64::MIN as i128),
    ("18446744073709551615.0", u64::MAX as i128),
    ("1.8446744073709551615e19", u64::MAX as i128),
];

/// Numbers that no integer type holds, for they are no integers.
const FRACTIONS: &[&str] = &[
    "0.5",
    "1.0000000000000000000000000000001",
    "-1.5",
    "15e-1",
    "1e-1",
    "1e-400",
    "1e-99999999999999999999999",
    "9223372036854775807.5",
    "18446744073709551616.5",
    "300.5",
];

/// Integers that no type of 64 bits holds.
const BEYOND: &[&str] = &[
    "1e20",
    "1e400",
    "-1e400",
    "1e99999999999999999999999",
    "18446744073709551616.0",
    "1.8446744073709551616e19",
    "-9223372036854775809.0",
    "100000000000000000000000000.0",
];

/// A number is the integer that it amounts to, exactly, or none.
fn judged<T>(number: &str, value: Option<i128>)
where
    T: FromJson + ToJson + TryFrom<i128> + PartialEq + Debug + std::fmt::Display,
{
    let value = value.map(T::try_from);
    match value {
        Some(Ok(value)) => {
            assert_eq!(read::<T>(number).as_ref(), Ok(&value), "{number}");
            assert_eq!(text(&value), value.to_string());
        }
        Some(Err(_)) => assert_eq!(name::<T>(number), "out_of_range", "{number}"),
        None => assert_eq!(name::<T>(number), "wrong_type", "{number}"),
    }
}

fn judged_by_all(number: &str, value: Option<i128>) {
    judged::<i8>(number, value);
    judged::<i16>(number, value);
    judged::<i32>(number, value);
    judged::<i64>(number, value);
    judged::<u8>(number, value);
    judged::<u16>(number, value);
    judged::<u32>(number, value);
    judged::<u64>(number, value);
}

#[fc_test::test]
fn integer_may_have_a_zero_fraction_or_exponent() {
    for (number, value) in INTEGRAL {
        judged_by_all(number, Some(*value));
    }
    for number in BEYOND {
        judged_by_all(number, Some(i128::MAX));
    }
    for number in FRACTIONS {
        judged_by_all(number, None);
    }
    // Long enough for any count of digits to overflow that could.
    let zeros = "0".repeat(70_000);
    judged_by_all(&format!("7.{zeros}"), Some(7));
    judged_by_all(&format!("7{zeros}e-70000"), Some(7));
    judged_by_all(&format!("0.{zeros}7e70001"), Some(7));
    judged_by_all(&format!("7{zeros}.5"), None);
    judged_by_all(&format!("7{zeros}e0"), Some(i128::MAX));
    // A text that is not JSON has that error first.
    for number in ["1.", "1.e2", "1e", "1e+", ".0", "01.0", "1.0.0"] {
        assert_eq!(name::<i64>(number), "bad_json", "{number}");
    }
}

#[fc_test::test]
fn base64_is_strict() {
    assert_eq!(read::<Bytes64>("\"aGk=\"").unwrap().0, b"hi");
    assert_eq!(read::<Bytes64>("\"\\u0061Gk=\"").unwrap().0, b"hi");
    for text in [
        "\"aGk\"",
        "\"aGk==\"",
        "\"a Gk=\"",
        "\"_Gk=\"",
        "\"aGl=\"",
        "\"号\"",
        "\"a\"",
        "\"=\"",
    ] {
        assert_eq!(name::<Bytes64>(text), "bad_base64", "{text}");
    }
    assert_eq!(name::<Bytes64>("[1]"), "wrong_type");
}

#[fc_test::test]
fn absent_values() {
    assert_eq!(read::<Option<u8>>("null"), Ok(None));
    assert_eq!(read::<Vec<Option<u8>>>("[1,null]"), Ok(vec![Some(1), None]));
    assert_eq!(text(&vec![Some(1_u8), None]), "[1,null]");
    assert_eq!(text(&f64::NAN), "null");
    assert_eq!(text(&f32::INFINITY), "null");
}

#[fc_test::test]
fn serde_types_travel_too() {
    type Map = Serde<BTreeMap<String, Vec<u8>>>;
    let map: Map = read(r#" {"a" : [1, 2]} "#).unwrap();
    assert_eq!(map.0.get("a"), Some(&vec![1, 2]));
    assert_eq!(text(&map), r#"{"a":[1,2]}"#);
    assert_eq!(name::<Map>(r#"{"a":[256]}"#), "wrong_type");
    assert_eq!(name::<Map>(r#"{"a":[256}"#), "bad_json");
}
