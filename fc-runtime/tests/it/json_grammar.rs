//! The reader accepts what `serde_json` accepts, and understands the same.

use crate::tree::{Tree, mutated, same, text};
use fc_runtime::json::{from_slice, from_str, to_vec};
use fc_runtime::{Allowance, Extra, Json, JsonRef, Message};
use proptest::prelude::*;
use serde_json::Value;
use serde_json::value::RawValue;

/// Unknown keys next to a known one.
#[derive(Clone, Debug, PartialEq, fc_derive::Message)]
struct Known {
    a: Option<Json>,
    #[fc(extra)]
    extra: Extra,
}

fn check(text: &str) -> Result<(), TestCaseError> {
    let ours = from_str::<Tree>(text, Allowance::DEFAULT);
    let theirs = serde_json::from_str::<Value>(text);
    match (&ours, &theirs) {
        (Ok(ours), Ok(theirs)) => prop_assert!(same(ours, theirs), "{ours:?} is not {theirs:?}"),
        (Err(error), Err(_)) => {
            prop_assert!(error.offset() <= text.len());
            prop_assert!(
                ["bad_json", "wrong_type", "out_of_range", "lone_surrogate"]
                    .contains(&error.name()),
                "{error}"
            );
        }
        _ => prop_assert!(false, "{text:?}: {ours:?}, but serde_json: {theirs:?}"),
    }

    // Values that are not read.
    let ours = Json::new(text);
    let theirs = serde_json::from_str::<&RawValue>(text);
    match (&ours, &theirs) {
        (Ok(ours), Ok(theirs)) => prop_assert_eq!(ours.as_str(), theirs.get()),
        (Err(error), Err(_)) => prop_assert_eq!(error.name(), "bad_json"),
        _ => prop_assert!(false, "{text:?}: {ours:?}, but serde_json: {theirs:?}"),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[fc_test::test]
    fn json_is_read_as_serde_json_reads_it(text in text()) {
        check(&text)?;
        prop_assert!(Json::new(&text).is_ok());
    }

    #[fc_test::test]
    fn near_json_is_judged_like_serde_json(text in mutated()) {
        check(&text)?;
    }

    #[fc_test::test]
    fn any_text_is_judged_as_serde_json_judges_it(text in "[\\[\\]{}:,\"\\\\u0-9a-f. eE+\\-tnl\n]{0,24}") {
        check(&text)?;
    }

    #[fc_test::test]
    fn no_bytes_are_too_odd(bytes in prop::collection::vec(any::<u8>(), 0..64)) {
        let ours = from_slice::<Tree>(&bytes, Allowance::DEFAULT);
        prop_assert_eq!(ours.is_ok(), serde_json::from_slice::<Value>(&bytes).is_ok());
        let _ = fc_runtime::json::decode::<Known>(&bytes, Allowance::DEFAULT);
    }

    #[fc_test::test]
    fn written_values_read_back_equal(text in text()) {
        let Ok(tree) = from_str::<Tree>(&text, Allowance::DEFAULT) else { return Ok(()) };
        let written = to_vec(&tree);
        let value: Value = serde_json::from_slice(&written).unwrap();
        prop_assert!(same(&tree, &value));
    }

    #[fc_test::test]
    fn unknown_keys_survive(keys in prop::collection::vec(("[a-c\\PC]{0,3}", text()), 0..8)) {
        let mut sent = Known { a: None, extra: Extra::new() };
        for (key, text) in &keys {
            let value = Json::new(text).unwrap();
            if key == "a" {
                sent.a = Some(value);
            } else {
                sent.extra.insert(key.as_str(), value);
            }
        }
        if sent.a.as_ref().is_some_and(|a| a.as_str() == "null") {
            sent.a = None;
        }
        let written = to_vec(&sent);
        let read: Known = fc_runtime::json::decode(&written, Allowance::DEFAULT).unwrap();
        prop_assert_eq!(&read, &sent);
        prop_assert_eq!(to_vec(&read), written);
        prop_assert!(read.check().is_ok());
    }
}

#[fc_test::test]
fn unknown_keys_come_out_as_they_came() {
    let text = r#"{"b":[1 , 2],"c":null,"b":"\u0061","d\\\"":1.0,"":{},"b":-0}"#;
    let mut known: Known = fc_runtime::json::decode(text.as_bytes(), Allowance::DEFAULT).unwrap();
    assert_eq!(to_vec(&known), text.as_bytes());
    let extra = &mut known.extra;
    let keys: Vec<_> = extra.iter().map(|(key, _)| key.into_owned()).collect();
    assert_eq!(keys, ["b", "c", "b", "d\\\"", "", "b"]);
    assert_eq!(extra.get("b").map(JsonRef::as_str), Some("-0"));
    assert_eq!(extra.get("").map(JsonRef::to_json), Json::new("{}").ok());
    assert_eq!(extra.get("x"), None);
    assert_eq!(
        format!("{extra:?}"),
        r#"{"b": [1 , 2], "c": null, "b": "\u0061", "d\\\"": 1.0, "": {}, "b": -0}"#
    );
    // In place of the first, and of all others.
    extra.insert("b", Json::null());
    extra.insert("new\n", Json::new("7").unwrap());
    let text = r#"{"b":null,"c":null,"d\\\"":1.0,"":{},"new\n":7}"#;
    assert_eq!(to_vec(&known), text.as_bytes());
    assert_eq!((known.extra.len(), known.extra.is_empty()), (5, false));
    let again: Known = fc_runtime::json::decode(text.as_bytes(), Allowance::DEFAULT).unwrap();
    assert_eq!(again, known);
    // However the key is spelled, it is the same key; a value is the same as its text only.
    let spelled = br#"{"\u0062":null,"c":null,"d\u005c\u0022":1.0,"":{},"new\u000a":7}"#;
    let spelled: Known = fc_runtime::json::decode(spelled, Allowance::DEFAULT).unwrap();
    assert_eq!(spelled, known);
}

/// Unread values are passed on unchanged, even invalid ones.
#[fc_test::test]
fn unknown_values_stay_verbatim() {
    for text in [
        r#"{"b":1,"b":2}"#,
        r#"{"b":{"c":1,"c":1}}"#,
        r#"{"b":1.0,"c":1e2,"d":-0,"e":-0.0}"#,
        r#"{"b":1e400,"c":-1e400,"d":1e-400}"#,
        r#"{"b":18446744073709551616,"c":9007199254740993}"#,
        r#"{"b":123456789012345678901234567890.123456789012345678901234567890}"#,
        r#"{"b":"\ud800","c":["\udc00\ud800"],"d":{"\ud800":1}}"#,
        r#"{"a":{"c":1,"c":1.0,"d":"\ud800","\ud800":1e400},"b":"\u0000\/"}"#,
    ] {
        let known: Known = fc_runtime::json::decode(text.as_bytes(), Allowance::DEFAULT).unwrap();
        assert_eq!(to_vec(&known), text.as_bytes(), "{text}");
    }
}

/// JSON, if only just.
const ACCEPTED: &[&str] = &[
    "0",
    "-0",
    "-0.0",
    "1e5",
    "1E+5",
    "1e-5",
    "0e0",
    "0.1e1",
    "\"\"",
    "[]",
    "{}",
    " [ ] ",
    "\t{\n}\r",
    "\"\\u0000\"",
    "\"\u{7f}\"",
    "\"\u{2028}\"",
    "\"\\uD83D\\uDE00\"",
    "[1,2]",
    "{\"\":0}",
    "{\"a\":1,\"a\":2}",
    "1e-999",
    "123456789012345678901234567890",
];
/// Texts that are not JSON.
const REFUSED: &[&str] = &[
    "",
    " ",
    "00",
    "01",
    "-",
    "+1",
    ".5",
    "1.",
    "1.e5",
    "1e",
    "1e+",
    "0x1",
    "NaN",
    "Infinity",
    "nul",
    "nulll",
    "truex",
    "True",
    "'a'",
    "\"",
    "\"a",
    "\"\\\"",
    "\"\\x\"",
    "\"\\u12\"",
    "\"\\u12g4\"",
    "\"\n\"",
    "\"\u{0}\"",
    "[",
    "]",
    "[1",
    "[1,",
    "[1,]",
    "[,1]",
    "[1 2]",
    "{",
    "}",
    "{\"a\"}",
    "{\"a\":}",
    "{\"a\":1,}",
    "{,}",
    "{a:1}",
    "{1:1}",
    "{\"a\" 1}",
    "{\"a\":1 \"b\":2}",
    "[1]]",
    "1 2",
    "\u{feff}1",
    "// x\n1",
    "[1;2]",
    "\u{a0}1",
    "\"\\u+123\"",
    "- 1",
    "--1",
    "1e400x",
];

#[fc_test::test]
fn the_corners_of_the_grammar() {
    for text in ACCEPTED {
        assert!(serde_json::from_str::<Value>(text).is_ok(), "{text}");
        assert!(from_str::<Tree>(text, Allowance::DEFAULT).is_ok(), "{text}");
        assert!(Json::new(text).is_ok(), "{text}");
    }
    for text in REFUSED {
        assert!(serde_json::from_str::<Value>(text).is_err(), "{text}");
        assert!(
            from_str::<Tree>(text, Allowance::DEFAULT).is_err(),
            "{text}"
        );
        assert_eq!(Json::new(text).unwrap_err().name(), "bad_json", "{text}");
    }
    // Half of a surrogate pair is not text, but is allowed in unread values.
    for text in [
        "\"\\ud800\"",
        "\"\\udc00\\ud800\"",
        "\"\\ud800x\"",
        "\"\\ud800\\n\"",
    ] {
        assert!(serde_json::from_str::<Value>(text).is_err());
        assert_eq!(
            from_str::<Tree>(text, Allowance::DEFAULT)
                .unwrap_err()
                .name(),
            "lone_surrogate"
        );
        assert!(serde_json::from_str::<&RawValue>(text).is_ok());
        assert!(Json::new(text).is_ok());
    }
}
