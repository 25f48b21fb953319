//! Every error has its name and position.

use fc_derive::{Message, OneOf, OpenEnum};
use fc_runtime::json::{BodyErrorKind, MAX_DEPTH, decode};
use fc_runtime::{Allowance, BodyError, Bytes64, Empty, Extra, Json, Message, read_enveloped};

#[derive(Clone, Debug, PartialEq, Message)]
struct Body {
    data: Data,
}

#[derive(Clone, Debug, PartialEq, Message)]
struct Data {
    id: u8,
    list: Option<Vec<Data>>,
    #[fc(min = 0.5, max = 2)]
    x: Option<f32>,
    #[fc(length = 1..=2)]
    name: Option<String>,
    #[fc(pattern = "[a-z]+")]
    word: Option<String>,
    #[fc(key = "开关")]
    switch: Option<Switch>,
    choice: Option<Choice>,
    image: Option<Bytes64>,
    #[fc(also("old"))]
    any: Option<Json>,
    #[fc(extra)]
    extra: Extra,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = str)]
enum Switch {
    #[fc(value = "on")]
    On,
}

#[derive(Clone, Debug, PartialEq, OneOf)]
enum Choice {
    Left(Left),
    Right(Right),
}

#[derive(Clone, Debug, PartialEq, Message)]
struct Left {
    left: u8,
}

#[derive(Clone, Debug, PartialEq, Message)]
struct Right {
    right: u8,
}

fn fault(text: &[u8]) -> BodyError {
    match decode::<Body>(text, Allowance::depth(8)) {
        Ok(body) => panic!("{} was read as {body:?}", String::from_utf8_lossy(text)),
        Err(error) => error,
    }
}

/// Text, name, path, and the text at the offset.
const FAULTS: &[(&str, &str, &str, &str)] = &[
    (r#"{"data":{"id":1}"#, "bad_json", "data", ""),
    (r#"{"data":{"id":1}} x"#, "bad_json", "", "x"),
    (
        r#"{"data":{"id":"1","list":[}}"#,
        "bad_json",
        "data.list[0]",
        "}}",
    ),
    (
        r#"{"data":{"id":1,"new":"\x"}}"#,
        "bad_json",
        "data.new",
        r#"x"}}"#,
    ),
    (r#"[{"data":1}]"#, "not_an_object", "", "["),
    (" null", "not_an_object", "", "null"),
    (r#"{"data":[]}"#, "wrong_type", "data", "[]"),
    (r#"{"data":null}"#, "wrong_type", "data", "null"),
    (r#"{"data":{"id":"1"}}"#, "wrong_type", "data.id", r#""1""#),
    (
        r#"{"data":{"list":[{"id":1},{"id":true}]}}"#,
        "wrong_type",
        "data.list[1].id",
        "true",
    ),
    (
        r#"{"data":{"id":1,"list":{}}}"#,
        "wrong_type",
        "data.list",
        "{}}}",
    ),
    (
        r#"{"data":{"id":1,"name":7}}"#,
        "wrong_type",
        "data.name",
        "7}}",
    ),
    ("{}", "missing_field", "data", "{}"),
    (r#"{"data":{}}"#, "missing_field", "data.id", "{}}"),
    (
        r#"{"data":{"id":1,"list":[{"id":1},{}]}}"#,
        "missing_field",
        "data.list[1].id",
        "{}]",
    ),
    (r#"{"data":{"id":256}}"#, "out_of_range", "data.id", "256"),
    (r#"{"data":{"id":-1}}"#, "out_of_range", "data.id", "-1"),
    (
        r#"{"data":{"id":1,"x":1e99}}"#,
        "out_of_range",
        "data.x",
        "1e99",
    ),
    (
        r#"{"data":{"id":1,"x":0.25}}"#,
        "out_of_range",
        "data.x",
        r#"{"id""#,
    ),
    (
        r#"{"data":{"id":1,"x":2.5}}"#,
        "out_of_range",
        "data.x",
        r#"{"id""#,
    ),
    (
        r#"{"data":{"id":1,"list":[{"id":1,"x":3}]}}"#,
        "out_of_range",
        "data.list[0].x",
        r#"{"id":1,"x""#,
    ),
    (
        r#"{"data":{"id":1,"name":"号号号"}}"#,
        "bad_length",
        "data.name",
        r#"{"id""#,
    ),
    (
        r#"{"data":{"id":1,"word":"A"}}"#,
        "bad_pattern",
        "data.word",
        r#"{"id""#,
    ),
    (
        r#"{"data":{"id":1,"开关":"off"}}"#,
        "unknown_value",
        "data.开关",
        r#""off""#,
    ),
    (
        r#"{"data":{"id":1,"choice":{"up":1}}}"#,
        "no_variant",
        "data.choice",
        r#"{"up""#,
    ),
    (
        r#"{"data":{"id":1,"choice":{"right":""}}}"#,
        "wrong_type",
        "data.choice.right",
        r#""""#,
    ),
    (
        r#"{"data":{"id":1,"image":"a"}}"#,
        "bad_base64",
        "data.image",
        r#""a""#,
    ),
    (
        r#"{"data":{"id":1,"any":[[[[[[[]]]]]]]}}"#,
        "too_deep",
        "data.any[0][0][0][0][0][0]",
        "[]",
    ),
    (
        r#"{"data":{"id":1,"new":[[[[[[[]]]]]]]}}"#,
        "too_deep",
        "data.new[0][0][0][0][0][0]",
        "[]",
    ),
    // A known key comes once, whatever its values and however it is spelled.
    (
        r#"{"data":{"id":1,"id":1}}"#,
        "duplicate_key",
        "data.id",
        "1}}",
    ),
    (
        r#"{"data":{"id":1,"\u0069d":true}}"#,
        "duplicate_key",
        r"data.\u0069d",
        "true",
    ),
    (
        r#"{"data":{"id":1,"name":null,"name":"a"}}"#,
        "duplicate_key",
        "data.name",
        r#""a""#,
    ),
    (
        r#"{"data":{"id":1,"name":"a","x":1,"name":null}}"#,
        "duplicate_key",
        "data.name",
        "null",
    ),
    (
        r#"{"data":{"id":1,"old":null,"any":1}}"#,
        "duplicate_key",
        "data.any",
        "1}}",
    ),
    (
        r#"{"data":{"id":1,"list":[{"id":1},{"id":1,"id":2}]}}"#,
        "duplicate_key",
        "data.list[1].id",
        "2}]",
    ),
    (
        r#"{"data":{"id":1,"choice":{"left":1,"left":2}}}"#,
        "duplicate_key",
        "data.choice.left",
        "2}}",
    ),
    (
        r#"{"data":{"id":1},"data":{"id":1}}"#,
        "duplicate_key",
        "data",
        r#"{"id":1}}"#,
    ),
    (r#"{"data":{"id":1,"id":1}"#, "bad_json", "data", ""),
    // Half a surrogate pair is no text.
    (
        r#"{"data":{"id":1,"name":"a\ud800"}}"#,
        "lone_surrogate",
        "data.name",
        r"\ud800",
    ),
    (
        r#"{"data":{"id":1,"image":"\udc00\ud800"}}"#,
        "lone_surrogate",
        "data.image",
        r"\udc00",
    ),
    (
        r#"{"data":{"id":1,"开关":"\ud800\n"}}"#,
        "lone_surrogate",
        "data.开关",
        r"\ud800",
    ),
    (
        r#"{"data":{"id":1,"\ud800x":1}}"#,
        "lone_surrogate",
        "data",
        r"\ud800",
    ),
    (r#"{"data":{"name":"\ud800"}"#, "bad_json", "data", ""),
    // A text that is not JSON has that error, whatever else is wrong.
    (r#"{"data":{"id":"1"}"#, "bad_json", "data", ""),
    (r#"{"data":{"id":256,}}"#, "bad_json", "data", "}}"),
    ("[1", "bad_json", "[0]", ""),
    (
        r#"{"data":{"id":"1","new":[[[[[[[]]]]]]]}}"#,
        "too_deep",
        "data.new[0][0][0][0][0][0]",
        "[]",
    ),
];

#[fc_test::test]
fn every_fault_has_its_name_and_place() {
    for (text, name, path, rest) in FAULTS {
        let error = fault(text.as_bytes());
        assert_eq!((error.name(), error.path()), (*name, *path), "{text}");
        assert!(
            text[error.offset()..].starts_with(rest),
            "{text}: byte {}",
            error.offset()
        );
        if rest.is_empty() {
            assert_eq!(error.offset(), text.len(), "{text}");
        }
        let shown = error.to_string();
        assert!(
            shown.starts_with(name) && shown.contains(error.detail()),
            "{shown}"
        );
    }
}

#[fc_test::test]
fn bytes_that_are_no_text() {
    let error = fault(b"{\"data\":\xFF}");
    assert_eq!((error.name(), error.offset()), ("not_utf8", 8));
    let error = read_enveloped::<Empty, Body>(b"\xC0\x80", Allowance::depth(8)).unwrap_err();
    assert_eq!(error.name(), "not_utf8");
}

#[fc_test::test]
fn a_key_of_the_envelope_comes_once_too() {
    #[derive(Clone, Debug, PartialEq, Message)]
    struct Envelope {
        time: Option<u64>,
    }
    let read = |text: &str| read_enveloped::<Envelope, Body>(text.as_bytes(), Allowance::depth(8));
    let error = read(r#"{"time":1,"data":{"id":1},"time":1}"#).unwrap_err();
    assert_eq!((error.name(), error.path()), ("duplicate_key", "time"));
    let error = read(r#"{"time":null,"\u0074ime":1}"#).unwrap_err();
    assert_eq!(error.name(), "duplicate_key");
    // An own key that comes twice does not cost the envelope.
    let read = read(r#"{"data":{"id":1},"data":{"id":2},"time":7}"#).unwrap();
    assert_eq!(read.envelope.time, Some(7));
    assert_eq!(read.body.unwrap_err().name(), "duplicate_key");
}

#[fc_test::test]
fn all_names_are_tested() {
    const KINDS: [BodyErrorKind; 16] = [
        BodyErrorKind::NotUtf8,
        BodyErrorKind::BadJson,
        BodyErrorKind::NotAnObject,
        BodyErrorKind::WrongType,
        BodyErrorKind::MissingField,
        BodyErrorKind::DuplicateKey,
        BodyErrorKind::LoneSurrogate,
        BodyErrorKind::OutOfRange,
        BodyErrorKind::BadLength,
        BodyErrorKind::BadPattern,
        BodyErrorKind::UnknownValue,
        BodyErrorKind::NoVariant,
        BodyErrorKind::TooDeep,
        BodyErrorKind::TooManyValues,
        BodyErrorKind::ListsTooLarge,
        BodyErrorKind::BadBase64,
    ];
    /// Below, and in `limits/messages.rs`.
    const ELSEWHERE: [BodyErrorKind; 3] = [
        BodyErrorKind::NotUtf8,
        BodyErrorKind::TooManyValues,
        BodyErrorKind::ListsTooLarge,
    ];
    for kind in KINDS {
        let tested = FAULTS.iter().any(|(_, name, ..)| *name == kind.name());
        assert!(tested || ELSEWHERE.contains(&kind), "{}", kind.name());
    }
}

#[fc_test::test]
fn depth_has_a_limit_and_a_limit_of_the_limit() {
    let nested = |depth: usize| format!("{}{}", "[".repeat(depth), "]".repeat(depth));
    for depth in [1, 2, 7, MAX_DEPTH] {
        let text = format!("{{\"a\":{}}}", nested(depth - 1)).replace(":}", ":0}");
        assert!(
            decode::<Empty>(text.as_bytes(), Allowance::depth(depth)).is_ok(),
            "{depth}"
        );
        assert_eq!(
            decode::<Empty>(text.as_bytes(), Allowance::depth(depth - 1))
                .unwrap_err()
                .name(),
            "too_deep"
        );
    }
    let limit = nested(MAX_DEPTH);
    let json = Json::new(&limit).unwrap();
    assert!(json.parse::<serde_json::Value>().is_ok());
    assert_eq!(
        Json::new(&nested(MAX_DEPTH + 1)).unwrap_err().name(),
        "too_deep"
    );
    // A limit that is no limit cannot cost the stack.
    let text = format!("{{\"data\":{}", "[".repeat(1_000_000));
    assert_eq!(
        decode::<Body>(text.as_bytes(), Allowance::depth(usize::MAX))
            .unwrap_err()
            .name(),
        "too_deep"
    );
    let text = "{\"data\":".repeat(100_000);
    assert_eq!(
        decode::<Body>(text.as_bytes(), Allowance::depth(usize::MAX))
            .unwrap_err()
            .name(),
        "too_deep"
    );
}

#[fc_test::test]
fn a_long_key_does_not_make_a_long_error() {
    let key = "k".repeat(1 << 20);
    let error =
        decode::<Body>(format!("{{\"{key}\":x}}").as_bytes(), Allowance::depth(8)).unwrap_err();
    assert!(error.to_string().len() < 300);
}

#[fc_test::test]
fn a_long_value_does_not_make_a_long_error() {
    for value in [
        "x".repeat(1 << 20),
        "号".repeat(1 << 20),
        "\\n".repeat(1 << 20),
    ] {
        let text = format!("{{\"data\":{{\"id\":1,\"开关\":\"{value}\"}}}}");
        let error = fault(text.as_bytes());
        assert_eq!(error.name(), "unknown_value");
        assert!((200..300).contains(&error.to_string().len()));
    }
}

#[fc_test::test]
fn error_before_sending_has_a_path() {
    let inner = Data {
        id: 1,
        list: None,
        x: Some(5.0),
        name: None,
        word: None,
        switch: Some(Switch::On),
        choice: None,
        image: None,
        any: None,
        extra: Extra::new(),
    };
    let outer = Data {
        x: None,
        list: Some(vec![inner]),
        ..inner_of(2)
    };
    let error = Body { data: outer }.check().unwrap_err();
    assert_eq!(
        (error.name(), error.path(), error.offset()),
        ("out_of_range", "data.list[0].x", 0)
    );
}

/// `null` in place of a number would be read as a field that is absent.
#[fc_test::test]
fn values_that_are_not_numbers_are_not_sent() {
    #[derive(Clone, Debug, Default, PartialEq, Message)]
    struct Pose {
        x: f64,
        yaw: Option<f32>,
        #[fc(wire = "string")]
        speed: Option<f64>,
        scan: Option<Vec<f32>>,
    }
    let poses = [
        (
            "x",
            Pose {
                x: f64::NAN,
                ..Pose::default()
            },
        ),
        (
            "yaw",
            Pose {
                yaw: Some(f32::INFINITY),
                ..Pose::default()
            },
        ),
        (
            "speed",
            Pose {
                speed: Some(f64::NEG_INFINITY),
                ..Pose::default()
            },
        ),
        (
            "scan[1]",
            Pose {
                scan: Some(vec![0.5, f32::NAN]),
                ..Pose::default()
            },
        ),
    ];
    for (path, pose) in poses {
        let error = pose.check().unwrap_err();
        assert_eq!((error.name(), error.path()), ("out_of_range", path));
    }
    let whole = Pose {
        x: f64::MAX,
        yaw: Some(-0.0),
        speed: None,
        scan: Some(vec![f32::MIN]),
    };
    assert_eq!(whole.check(), Ok(()));
}

fn inner_of(id: u8) -> Data {
    decode(format!("{{\"id\":{id}}}").as_bytes(), Allowance::depth(8)).unwrap()
}
