//! Bodies at the edges of JSON, with the result of every reader.
//!
//! Each body is read as a message with one optional key, `value`. The message keeps unknown keys. The cases use all
//! types of the spec language and depend on no spec.

use fc_spec::model::{IntKind, JsonRule};

/// A body and the result of reading it.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::emit) struct JsonCase {
    /// The rule that it shows.
    pub(in crate::emit) rule: JsonRule,
    /// The name, unique within the rule.
    pub(in crate::emit) name: String,
    /// The type of `value` in the spec language. `object` is a message like the outer one, whose `value` is an `i32`.
    pub(in crate::emit) ty: &'static str,
    /// The received bytes.
    pub(in crate::emit) body: Vec<u8>,
    /// The text of the message after writing it back, or the name of the error.
    pub(in crate::emit) outcome: Result<String, &'static str>,
    /// `true` if pages show it.
    pub(in crate::emit) shown: bool,
}

/// Returns every case, by rule.
pub(in crate::emit) fn json_cases() -> Vec<JsonCase> {
    let tables = [
        (JsonRule::Text, TEXT),
        (JsonRule::KnownKeys, KNOWN_KEYS),
        (JsonRule::UnknownKeys, UNKNOWN_KEYS),
        (JsonRule::Integers, INTEGERS),
        (JsonRule::Floats, FLOATS),
        (JsonRule::Strings, STRINGS),
    ];
    let mut cases = Vec::new();
    for (rule, table) in tables {
        cases.extend(table.iter().map(|case| case.with(rule)));
        if rule == JsonRule::Integers {
            for kind in IntKind::ALL.iter().copied() {
                edges(kind.name(), kind.range(), &mut cases);
            }
            for timestamp in ["timestamp_ms", "timestamp_s"] {
                edges(timestamp, IntKind::I64.range(), &mut cases);
            }
        }
    }
    cases
}

struct Row {
    name: &'static str,
    ty: &'static str,
    body: &'static [u8],
    outcome: Result<&'static str, &'static str>,
    shown: bool,
}

impl Row {
    fn with(&self, rule: JsonRule) -> JsonCase {
        JsonCase {
            rule,
            name: self.name.to_owned(),
            ty: self.ty,
            body: self.body.to_vec(),
            outcome: self.outcome.map(str::to_owned),
            shown: self.shown,
        }
    }

    /// Returns the row, shown on pages.
    const fn shown(mut self) -> Self {
        self.shown = true;
        self
    }
}

/// A body that is accepted, and its text after writing it back.
const fn read(
    name: &'static str,
    ty: &'static str,
    body: &'static [u8],
    written: &'static str,
) -> Row {
    Row {
        name,
        ty,
        body,
        outcome: Ok(written),
        shown: false,
    }
}

/// A body that is accepted and written back unchanged.
const fn kept(name: &'static str, ty: &'static str, body: &'static str) -> Row {
    read(name, ty, body.as_bytes(), body)
}

/// A body that is refused.
const fn refused(
    name: &'static str,
    ty: &'static str,
    body: &'static [u8],
    error: &'static str,
) -> Row {
    Row {
        name,
        ty,
        body,
        outcome: Err(error),
        shown: false,
    }
}

// Each row is on one line.

#[rustfmt::skip]
const TEXT: &[Row] = &[
    read("empty", "i32", b"", "{}").shown(),
    read("white_space", "i32", b" \t\r\n{ \"value\" : 1 } \n", r#"{"value":1}"#),
    read("null_is_absent", "i32", br#"{"value":null}"#, "{}"),
    refused("byte_order_mark", "i32", b"\xEF\xBB\xBF{}", "bad_json").shown(),
    refused("only_white_space", "i32", b" ", "bad_json"),
    refused("other_white_space", "i32", b"\x0C{}", "bad_json"),
    refused("two_values", "i32", b"{}{}", "bad_json"),
    refused("text_behind", "i32", b"{} x", "bad_json").shown(),
    // C programs that count the end of a string send this.
    refused("zero_byte_behind", "i32", b"{}\0", "bad_json"),
    refused("cut_off", "i32", br#"{"value":1"#, "bad_json"),
    refused("comma_at_the_end", "i32", br#"{"value":1,}"#, "bad_json"),
    refused("no_quotes", "i32", b"{value:1}", "bad_json"),
    refused("single_quotes", "i32", b"{'value':1}", "bad_json"),
    refused("comment", "i32", b"{/* x */}", "bad_json"),
    refused("utf_16", "i32", b"{\0}\0", "bad_json"),
    refused("list", "i32", b"[]", "not_an_object"),
    refused("null", "i32", b"null", "not_an_object"),
    refused("number", "i32", b"1", "not_an_object"),
    refused("not_utf8", "i32", b"{\"x\":\"\xFF\"}", "not_utf8").shown(),
    refused("not_utf8_overlong", "i32", b"{\"x\":\"\xC0\x80\"}", "not_utf8"),
    refused("not_utf8_surrogate", "i32", b"{\"x\":\"\xED\xA0\x80\"}", "not_utf8"),
    refused("not_utf8_too_large", "i32", b"{\"x\":\"\xF4\x90\x80\x80\"}", "not_utf8"),
    refused("not_utf8_cut_off", "i32", b"{\"x\":\"\xE4\xB8\"}", "not_utf8"),
];

#[rustfmt::skip]
const KNOWN_KEYS: &[Row] = &[
    refused("twice", "i32", br#"{"value":1,"value":2}"#, "duplicate_key").shown(),
    refused("twice_the_same", "i32", br#"{"value":1,"value":1}"#, "duplicate_key"),
    refused("null_first", "i32", br#"{"value":null,"value":1}"#, "duplicate_key"),
    refused("null_behind", "i32", br#"{"value":1,"value":null}"#, "duplicate_key"),
    refused("others_between", "i32", br#"{"value":1,"x":2,"value":1}"#, "duplicate_key"),
    refused("escaped", "i32", br#"{"value":1,"v\u0061lue":1}"#, "duplicate_key").shown(),
    refused("escaped_first", "i32", br#"{"\u0076alue":1,"value":1}"#, "duplicate_key"),
    refused("other_type", "i32", br#"{"value":1,"value":"x"}"#, "duplicate_key"),
    refused("inside", "object", br#"{"value":{"value":1,"value":1}}"#, "duplicate_key"),
    refused("objects", "object", br#"{"value":{},"value":{}}"#, "duplicate_key"),
    // Invalid JSON is reported before any other error.
    refused("no_json", "i32", br#"{"value":1,"value":1"#, "bad_json"),
    // Each object has its own keys.
    kept("of_two_objects", "object", r#"{"value":{"value":1},"x":{"value":2}}"#),
    kept("other_case", "i32", r#"{"value":1,"Value":2}"#),
];

#[rustfmt::skip]
const UNKNOWN_KEYS: &[Row] = &[
    kept("twice", "i32", r#"{"x":1,"x":2}"#).shown(),
    kept("twice_beside_a_known_one", "i32", r#"{"value":1,"x":1,"x":1}"#),
    kept("twice_inside", "i32", r#"{"x":{"value":1,"value":2}}"#),
    kept("twice_in_an_object", "object", r#"{"value":{"value":1,"x":1,"x":2}}"#),
    read("known_ones_first", "i32", br#"{"x":1,"value":2,"y":3}"#, r#"{"value":2,"x":1,"y":3}"#),
    kept("integral", "i32", r#"{"x":1.0,"y":1e2,"z":-0}"#).shown(),
    kept("past_64_bits", "i32", r#"{"x":18446744073709551616,"y":-9223372036854775809}"#),
    kept("past_double_precision", "i32", r#"{"x":9007199254740993,"y":0.10000000000000000000000001}"#),
    kept("past_any_double", "i32", r#"{"x":1e400,"y":-1e400,"z":1e-400}"#).shown(),
    kept("half_a_surrogate_pair", "i32", r#"{"x":"\ud800","y":["\udc00\ud800"]}"#).shown(),
    kept("half_a_surrogate_pair_in_a_key_inside", "i32", r#"{"x":{"\ud800":1}}"#),
    refused("not_a_number", "i32", br#"{"x":NaN}"#, "bad_json"),
    refused("no_json", "i32", br#"{"x":{"y":01}}"#, "bad_json"),
    kept("open_value", "json", r#"{"value":{"x":1,"x":1.0,"y":1e400,"z":"\ud800"}}"#).shown(),
    kept("open_number", "json", r#"{"value":1.0}"#),
    kept("open_string", "json", r#"{"value":"\ud800"}"#),
    refused("open_value_twice", "json", br#"{"value":1,"value":1}"#, "duplicate_key"),
];

#[rustfmt::skip]
const INTEGERS: &[Row] = &[
    read("point", "i32", br#"{"value":1.0}"#, r#"{"value":1}"#).shown(),
    read("exponent", "i32", br#"{"value":1e2}"#, r#"{"value":100}"#).shown(),
    read("exponent_with_a_plus", "i32", br#"{"value":1E+2}"#, r#"{"value":100}"#),
    read("negative_exponent", "i32", br#"{"value":1500e-2}"#, r#"{"value":15}"#),
    read("point_and_exponent", "i32", br#"{"value":-1.50e1}"#, r#"{"value":-15}"#),
    read("many_zeros", "i32", br#"{"value":7.000000000000000000000000000000}"#, r#"{"value":7}"#),
    read("negative_zero", "i32", br#"{"value":-0}"#, r#"{"value":0}"#).shown(),
    read("negative_zero_with_a_point", "u8", br#"{"value":-0.0}"#, r#"{"value":0}"#),
    read("zero_with_an_exponent", "i32", br#"{"value":0e400}"#, r#"{"value":0}"#),
    // The value is exact. A double would round it to a neighbour.
    read("past_double_precision", "i64", br#"{"value":9007199254740993.0}"#, r#"{"value":9007199254740993}"#).shown(),
    read("exponent_of_64_bits", "u64", br#"{"value":1e19}"#, r#"{"value":10000000000000000000}"#),
    refused("fraction", "i32", br#"{"value":1.5}"#, "wrong_type").shown(),
    refused("tiny_fraction", "i32", br#"{"value":1.00000000000000000000000000001}"#, "wrong_type"),
    refused("too_small", "i32", br#"{"value":1e-400}"#, "wrong_type"),
    refused("fraction_past_the_range", "u8", br#"{"value":256.5}"#, "wrong_type"),
    refused("too_large", "i32", br#"{"value":1e400}"#, "out_of_range").shown(),
    refused("too_large_negative", "i32", br#"{"value":-1e400}"#, "out_of_range"),
    refused("exponent_past_64_bits", "i32", br#"{"value":1e99999999999999999999}"#, "out_of_range"),
    refused("string", "i32", br#"{"value":"1"}"#, "wrong_type"),
    refused("bool", "i32", br#"{"value":true}"#, "wrong_type"),
    refused("plus", "i32", br#"{"value":+1}"#, "bad_json"),
    refused("leading_zero", "i32", br#"{"value":01}"#, "bad_json"),
    refused("point_without_digits", "i32", br#"{"value":1.}"#, "bad_json"),
    refused("exponent_without_digits", "i32", br#"{"value":1e}"#, "bad_json"),
    refused("hexadecimal", "i32", br#"{"value":0x10}"#, "bad_json"),
];

#[rustfmt::skip]
const FLOATS: &[Row] = &[
    read("integer", "f64", br#"{"value":1}"#, r#"{"value":1.0}"#),
    read("negative_zero", "f64", br#"{"value":-0.0}"#, r#"{"value":-0.0}"#),
    read("nearest", "f64", br#"{"value":0.1000000000000000055}"#, r#"{"value":0.1}"#),
    read("integer_past_double_precision", "f64", br#"{"value":9007199254740993}"#, r#"{"value":9007199254740992.0}"#).shown(),
    // Some libraries round each of these to a neighbouring number.
    read("more_than_half_way", "f64", br#"{"value":9007199254740993.00000000000000000000001}"#, r#"{"value":9007199254740994.0}"#),
    read("last_bit", "f64", br#"{"value":-6.879770673665752e-301}"#, r#"{"value":-6.879770673665752e-301}"#),
    read("below_the_normal_ones", "f64", br#"{"value":2.2250738585072011e-308}"#, r#"{"value":2.225073858507201e-308}"#),
    read("largest", "f64", br#"{"value":1.7976931348623157e308}"#, r#"{"value":1.7976931348623157e+308}"#),
    read("smallest", "f64", br#"{"value":5e-324}"#, r#"{"value":5e-324}"#),
    read("too_small", "f64", br#"{"value":1e-400}"#, r#"{"value":0.0}"#).shown(),
    refused("too_large", "f64", br#"{"value":1e400}"#, "out_of_range").shown(),
    refused("too_large_negative", "f64", br#"{"value":-1e400}"#, "out_of_range"),
    refused("just_too_large", "f64", br#"{"value":1.7976931348623159e308}"#, "out_of_range"),
    refused("not_a_number", "f64", br#"{"value":NaN}"#, "bad_json").shown(),
    refused("infinity", "f64", br#"{"value":Infinity}"#, "bad_json"),
    refused("negative_infinity", "f64", br#"{"value":-Infinity}"#, "bad_json"),
    refused("not_a_number_as_a_string", "f64", br#"{"value":"NaN"}"#, "wrong_type"),
    read("short", "f32", br#"{"value":0.1}"#, r#"{"value":0.1}"#),
    read("short_nearest", "f32", br#"{"value":16777217}"#, r#"{"value":16777216.0}"#),
    read("short_rounded_once", "f32", br#"{"value":1.00000005960464477540}"#, r#"{"value":1.0000001}"#),
    read("short_rounded_once_below_the_normal_ones", "f32", br#"{"value":1.1754942807573642917278829910e-38}"#, r#"{"value":1.1754942e-38}"#),
    read("short_just_below_too_large", "f32", br#"{"value":3.40282356779733661637539395458142568447e38}"#, r#"{"value":3.4028235e+38}"#),
    read("short_largest", "f32", br#"{"value":3.4028235e38}"#, r#"{"value":3.4028235e+38}"#),
    refused("short_too_large", "f32", br#"{"value":1e39}"#, "out_of_range"),
    refused("short_just_too_large", "f32", br#"{"value":3.4028236e38}"#, "out_of_range"),
];

#[rustfmt::skip]
const STRINGS: &[Row] = &[
    read("surrogate_pair", "string", br#"{"value":"\ud83d\ude00"}"#, r#"{"value":"😀"}"#),
    read("escapes", "string", br#"{"value":"\u00e9\/\u0041"}"#, r#"{"value":"é/A"}"#),
    read("escaped_key", "i32", br#"{"v\u0061lue":1}"#, r#"{"value":1}"#),
    kept("zero", "string", r#"{"value":"a\u0000b"}"#).shown(),
    kept("not_normalised", "string", "{\"value\":\"e\u{301}\u{e9}\"}"),
    kept("no_character", "string", "{\"value\":\"\u{ffff}\u{10ffff}\"}"),
    kept("line_separator", "string", "{\"value\":\"\u{2028}\"}"),
    refused("first_half", "string", br#"{"value":"a\ud800"}"#, "lone_surrogate").shown(),
    refused("second_half", "string", br#"{"value":"\udc00"}"#, "lone_surrogate"),
    refused("halves_turned_round", "string", br#"{"value":"\ude00\ud83d"}"#, "lone_surrogate"),
    refused("first_half_twice", "string", br#"{"value":"\ud83d\ud83d\ude00"}"#, "lone_surrogate"),
    refused("half_before_an_escape", "string", br#"{"value":"\ud83d\n"}"#, "lone_surrogate"),
    refused("half_before_a_letter", "string", br#"{"value":"\ud83d\u0041"}"#, "lone_surrogate"),
    refused("half_in_a_key", "i32", br#"{"\ud800":1}"#, "lone_surrogate").shown(),
    refused("half_in_a_key_inside", "object", br#"{"value":{"\ud800":1}}"#, "lone_surrogate"),
    refused("half_in_base64", "base64", br#"{"value":"\ud800"}"#, "lone_surrogate"),
    refused("unknown_escape", "string", br#"{"value":"\x41"}"#, "bad_json"),
    refused("cut_off_escape", "string", br#"{"value":"\u12"}"#, "bad_json"),
    refused("control_character", "string", b"{\"value\":\"\t\"}", "bad_json"),
    refused("number", "string", br#"{"value":1}"#, "wrong_type"),
];

/// 2⁵³. A double does not represent every integer above it.
const DOUBLE: i128 = 1 << 53;

/// Adds integers at the ends of a type and around the limit of a double.
fn edges(ty: &'static str, (least, most): (i128, i128), cases: &mut Vec<JsonCase>) {
    let mut push = |name: &str, number: String, value: Option<i128>| {
        cases.push(JsonCase {
            rule: JsonRule::Integers,
            name: format!("{ty}_{name}"),
            ty,
            body: format!("{{\"value\":{number}}}").into_bytes(),
            outcome: match value {
                Some(value) => Ok(format!("{{\"value\":{value}}}")),
                None => Err("out_of_range"),
            },
            shown: ty == "u8" && name == "above",
        });
    };
    let within = |value: i128| (least..=most).contains(&value).then_some(value);
    let mut both = |name: &str, value: i128| {
        push(name, value.to_string(), within(value));
        push(
            &format!("{name}_with_a_point"),
            format!("{value}.0"),
            within(value),
        );
    };
    both("lowest", least);
    both("below", least - 1);
    both("highest", most);
    both("above", most + 1);
    for (name, value) in [
        ("double_below", DOUBLE - 1),
        ("double", DOUBLE),
        ("double_above", DOUBLE + 1),
    ] {
        if most > DOUBLE {
            both(name, value);
        }
        if least < -DOUBLE {
            both(&format!("negative_{name}"), -value);
        }
    }
    push("negative_zero", "-0".to_owned(), Some(0));
}
