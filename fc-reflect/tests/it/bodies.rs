//! Bodies of the small protocol of these tests, which has every shape of the language.

#[allow(dead_code, reason = "other tests need more")]
use crate::support::specs;
use fc_reflect::{
    About, BodyErrorKind, Direction, Key, Leniency, Message, Node, Packing, Reflector, Value, walk,
};
use fc_spec::model::{Model, Quirk, Scalar, Type};

const ID: u32 = 0x0102_0304;

/// Reads `text` as a request of `set_light`.
fn request<'m>(reflector: &Reflector<'m>, model: &'m Model, text: &str) -> Message<'m> {
    let operation = model.operation("set_light");
    let message = reflector.message(operation, Direction::Request, text.as_bytes());
    message.unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Returns error, path and offset of an invalid request of `set_light`.
fn fault(reflector: &Reflector<'_>, model: &Model, text: &str) -> (BodyErrorKind, String, usize) {
    let operation = model.operation("set_light");
    let message = reflector.message(operation, Direction::Request, text.as_bytes());
    let error = message.and_then(|message| message.body).expect_err(text);
    (error.kind(), error.path().to_owned(), error.offset())
}

fn find<'a, 'm>(nodes: &'a [Node<'m>], wanted: &str) -> &'a Node<'m> {
    let mut found = None;
    walk(nodes, &mut |path, node| {
        if path == wanted {
            found = Some(node);
        }
    });
    found.expect(wanted)
}

#[test]
fn every_value_has_its_name_place_and_description() {
    let model = specs::small();
    let reflector = Reflector::new(&model);
    let text = r#"{ "lvl": 5.0, "at":1,"ratio":"0.50","mood":"b\"d","mode":2,"any":{"x" : [1]},"grid":[[1],[2,3]],"spot":{"y":1,"x":2e0,"z":0},"new":[1 ]}"#;
    let message = request(&reflector, &model, text);
    let body = message.body.as_ref().expect("right");
    let shown = |wanted: &str| {
        let node = find(body, wanted);
        (&text[node.span.clone()], node.name())
    };
    assert_eq!(shown("lvl"), ("5.0", Some("level")));
    assert_eq!(shown("any"), (r#"{"x" : [1]}"#, Some("any")));
    assert_eq!(shown("grid[1][0]"), ("2", None));
    assert_eq!(shown("spot"), (r#"{"y":1,"x":2e0,"z":0}"#, Some("spot")));
    assert_eq!(shown("spot.x"), ("2e0", Some("x")));
    assert_eq!(shown("spot.z"), ("0", None));
    assert_eq!(shown("new"), ("[1 ]", None));

    let level = find(body, "lvl");
    assert_eq!(
        level.text().map(|text| (&*text.zh, &*text.en)),
        Some(("亮度", "Brightness"))
    );
    assert!(matches!(level.value, Value::Int(5)));
    assert!(matches!(level.ty, Some(Type::Int(_))));
    assert!(level.lenient.is_empty());
    assert!(matches!(find(body, "new").about, About::Unknown));
    assert!(matches!(find(body, "grid[1][0]").about, About::Item));
    let at = find(&message.envelope, "at");
    assert_eq!((at.name(), &text[at.span.clone()]), (Some("at"), "1"));

    let Value::Enum { wire, named } = &find(body, "mood").value else {
        panic!("an enum");
    };
    assert_eq!(*wire, Scalar::String("b\"d".to_owned()));
    assert_eq!(
        named.map(|value| (&*value.name, &*value.text.en)),
        Some(("bad", "Bad"))
    );
    let Value::OneOf { variant, .. } = &find(body, "spot").value else {
        panic!("a choice");
    };
    assert_eq!(variant.name, "point");

    let canonical = message.canonical().expect("right");
    assert_eq!(
        canonical,
        r#"{"at":1,"lvl":5,"ratio":"0.5","mood":"b\"d","mode":2,"any":{"x" : [1]},"grid":[[1],[2,3]],"spot":{"x":2.0,"y":1.0,"z":0},"new":[1 ]}"#
    );
}

#[test]
fn lenient_reading_is_reported() {
    let model = specs::small();
    let reflector = Reflector::new(&model);
    for (key, value, quirk, written) in [
        ("hex", "20", None, r#""hex":20"#),
        ("hex", r#""20""#, Some(Quirk::LenientNumber), r#""hex":20"#),
        (
            "hex",
            r#""0x14""#,
            Some(Quirk::LenientNumber),
            r#""hex":20"#,
        ),
        ("on", "true", None, r#""on":true"#),
        ("on", r#""true""#, Some(Quirk::LenientBool), r#""on":true"#),
        ("on", "0", Some(Quirk::LenientBool), r#""on":false"#),
        ("word", r#""false""#, None, r#""word":"false""#),
        (
            "word",
            "false",
            Some(Quirk::LenientBool),
            r#""word":"false""#,
        ),
        ("word", "1.0", Some(Quirk::LenientBool), r#""word":"true""#),
        ("lit", "1", None, r#""lit":1"#),
        ("lit", "0e0", None, r#""lit":0"#),
        ("dim", "1.0", None, r#""dim":1"#),
        ("dim", "false", Some(Quirk::LenientBool), r#""dim":0"#),
        ("dim", r#""true""#, Some(Quirk::LenientBool), r#""dim":1"#),
        ("name", "null", None, ""),
        ("name", r#""""#, Some(Quirk::EmptyIsAbsent), ""),
        ("name", "{ }", Some(Quirk::EmptyIsAbsent), ""),
        ("name", "[]", Some(Quirk::EmptyIsAbsent), ""),
        ("name", r#""号号号""#, None, r#""name":"号号号""#),
        ("mood", r#""odd""#, None, r#""mood":"odd""#),
        ("gain", "0.1", None, r#""gain":0.1"#),
    ] {
        let message = request(
            &reflector,
            &model,
            &format!(r#"{{"lvl":1,"{key}":{value}}}"#),
        );
        let body = message
            .body
            .as_ref()
            .unwrap_or_else(|error| panic!("{error}"));
        let wanted: Vec<_> = quirk.map(Leniency::Quirk).into_iter().collect();
        assert_eq!(find(body, key).lenient, wanted, "{key}: {value}");
        let comma = if written.is_empty() { "" } else { "," };
        let wanted = format!(r#"{{"lvl":1{comma}{written}}}"#);
        assert_eq!(
            message.canonical().expect("right"),
            wanted,
            "{key}: {value}"
        );
    }

    let message = request(&reflector, &model, r#"{"lvl":1,"n\u006dae":"abc"}"#);
    let body = message.body.as_ref().expect("right");
    let node = &body[1];
    assert_eq!(node.key, Key::Name("nmae".to_owned()));
    assert_eq!(node.name(), Some("name"));
    assert_eq!(node.lenient, [Leniency::OtherKey]);
    assert_eq!(
        message.canonical().expect("right"),
        r#"{"lvl":1,"name":"abc"}"#
    );
}

/// Invalid requests, each with its error, path and offset.
const WRONG: &[(&str, BodyErrorKind, &str, usize)] = &[
    ("", BodyErrorKind::MissingField, "lvl", 0),
    (r#"{"lvl":0}"#, BodyErrorKind::OutOfRange, "lvl", 0),
    (r#"{"lvl":101}"#, BodyErrorKind::OutOfRange, "lvl", 0),
    (r#"{"lvl":256}"#, BodyErrorKind::OutOfRange, "lvl", 7),
    (
        r#"{"lvl":1,"gain":0.76}"#,
        BodyErrorKind::OutOfRange,
        "gain",
        0,
    ),
    (
        r#"{"lvl":1,"ratio":0.5}"#,
        BodyErrorKind::WrongType,
        "ratio",
        17,
    ),
    (
        r#"{"lvl":1,"ratio":" 0.5"}"#,
        BodyErrorKind::WrongType,
        "ratio",
        17,
    ),
    (
        r#"{"lvl":1,"ratio":"1e400x"}"#,
        BodyErrorKind::WrongType,
        "ratio",
        17,
    ),
    (
        r#"{"lvl":1,"hex":"0x8000"}"#,
        BodyErrorKind::OutOfRange,
        "hex",
        15,
    ),
    (
        r#"{"lvl":1,"hex":"40000x"}"#,
        BodyErrorKind::WrongType,
        "hex",
        15,
    ),
    (
        r#"{"lvl":1,"hex":"20x"}"#,
        BodyErrorKind::WrongType,
        "hex",
        15,
    ),
    (
        r#"{"lvl":1,"mood":"\ud800\ue000"}"#,
        BodyErrorKind::LoneSurrogate,
        "mood",
        17,
    ),
    (
        r#"{"lvl":1,"\ud800":1}"#,
        BodyErrorKind::LoneSurrogate,
        "",
        10,
    ),
    (
        r#"{"lvl":1,"tree":{"next":[{"\ude00":1}]}}"#,
        BodyErrorKind::LoneSurrogate,
        "tree.next[0]",
        27,
    ),
    (
        r#"{"lvl":1,"hex":"0x+1"}"#,
        BodyErrorKind::WrongType,
        "hex",
        15,
    ),
    (r#"{"lvl":1,"on":2}"#, BodyErrorKind::WrongType, "on", 14),
    (r#"{"lvl":1,"lit":2}"#, BodyErrorKind::WrongType, "lit", 15),
    (
        r#"{"lvl":1,"lit":true}"#,
        BodyErrorKind::WrongType,
        "lit",
        15,
    ),
    (
        r#"{"lvl":1,"lit":"1"}"#,
        BodyErrorKind::WrongType,
        "lit",
        15,
    ),
    (r#"{"lvl":1,"dim":2}"#, BodyErrorKind::WrongType, "dim", 15),
    (
        r#"{"lvl":1,"dim":"1"}"#,
        BodyErrorKind::WrongType,
        "dim",
        15,
    ),
    (
        r#"{"lvl":1,"name":"abcd"}"#,
        BodyErrorKind::BadLength,
        "name",
        0,
    ),
    (
        r#"{"lvl":1,"name":"a1"}"#,
        BodyErrorKind::BadPattern,
        "name",
        0,
    ),
    (
        r#"{"lvl":1,"name":"a\n"}"#,
        BodyErrorKind::BadPattern,
        "name",
        0,
    ),
    (
        r#"{"lvl":1,"name":"a","nmae":"a"}"#,
        BodyErrorKind::DuplicateKey,
        "nmae",
        27,
    ),
    (
        r#"{"lvl":1,"key":"aGVsbG8="}"#,
        BodyErrorKind::BadLength,
        "key",
        0,
    ),
    (
        r#"{"lvl":1,"key":"aGVsbG8"}"#,
        BodyErrorKind::BadBase64,
        "key",
        15,
    ),
    (
        r#"{"lvl":1,"mode":3}"#,
        BodyErrorKind::UnknownValue,
        "mode",
        16,
    ),
    (
        r#"{"lvl":1,"feel":"calm"}"#,
        BodyErrorKind::OutOfRange,
        "feel",
        0,
    ),
    (
        r#"{"lvl":1,"feel":"noon"}"#,
        BodyErrorKind::OutOfRange,
        "feel",
        0,
    ),
    (
        r#"{"lvl":1,"grid":[[1],[1,128]]}"#,
        BodyErrorKind::OutOfRange,
        "grid[1][1]",
        24,
    ),
    (
        r#"{"lvl":1,"grid":[[],[],[]]}"#,
        BodyErrorKind::BadLength,
        "grid",
        0,
    ),
    (
        r#"{"lvl":1,"spot":{"x":1}}"#,
        BodyErrorKind::NoVariant,
        "spot",
        16,
    ),
    (
        r#"{"lvl":1,"spot":{"x":1,"y":""}}"#,
        BodyErrorKind::WrongType,
        "spot.y",
        27,
    ),
    (
        r#"{"lvl":1,"tree":{"next":[{},{"leaf":-1}]}}"#,
        BodyErrorKind::OutOfRange,
        "tree.next[1].leaf",
        36,
    ),
    (
        r#"{"lvl":1,"mood":"\ud800"}"#,
        BodyErrorKind::LoneSurrogate,
        "mood",
        17,
    ),
    (r#"{"lvl":-1,"x":01}"#, BodyErrorKind::BadJson, "x", 14),
    (
        r#"{"lvl":1,"x":[[[[[[[[[[[["#,
        BodyErrorKind::TooDeep,
        "x[0][0][0][0][0][0][0][0][0][0][0]",
        24,
    ),
];

#[test]
fn errors_have_a_name_and_a_path() {
    let model = specs::small();
    let reflector = Reflector::new(&model);
    for (text, wanted, path, offset) in WRONG {
        let wanted = (*wanted, (*path).to_owned(), *offset);
        assert_eq!(fault(&reflector, &model, text), wanted, "{text}");
    }
}

#[test]
fn a_refusal_is_understood_although_it_lacks_the_body() {
    let model = specs::small();
    let reflector = Reflector::new(&model);
    let operation = model.operation("set_light");
    let text = r#"{"rc":3,"say":"no"}"#.as_bytes();
    let message = reflector
        .message(operation, Direction::Response, text)
        .expect("an envelope");
    assert!(matches!(find(&message.envelope, "rc").value, Value::Int(3)));
    let error = message.body.expect_err("no body");
    assert_eq!(
        (error.kind(), error.path()),
        (BodyErrorKind::MissingField, "left")
    );
}

#[test]
fn body_that_breaks_a_constraint_is_not_sent() {
    let model = specs::small();
    let reflector = Reflector::new(&model);
    let operation = model.operation("set_light").expect("known");
    let id = reflector
        .id(operation, Direction::Request, ID)
        .expect("a code");
    let error = reflector
        .encode(id, br#"{"lvl":0}"#, Packing::Plain)
        .expect_err("refused");
    assert_eq!((error.name(), error.path()), ("out_of_range", "lvl"));

    let mut message = request(&reflector, &model, r#"{"lvl":1,"gain":0.5}"#);
    if let Ok(body) = &mut message.body {
        body[1].value = Value::Float(f64::NAN);
    }
    let error = message.canonical().expect_err("no number");
    assert_eq!(error.kind(), BodyErrorKind::OutOfRange);
}

#[test]
fn sensitive_values_are_hidden() {
    let model = specs::small();
    let reflector = Reflector::new(&model);
    let message = request(&reflector, &model, r#"{"lvl":77,"key":"AQID"}"#);
    assert!(find(message.body.as_ref().expect("right"), "key").is_sensitive());
    let shown = format!("{message:?}");
    assert!(shown.contains("77") && shown.contains("\"key\""), "{shown}");
    assert!(!shown.contains("[1, 2, 3]"), "{shown}");
}
