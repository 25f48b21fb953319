//! Messages with `#[derive(Message)]`, for each attribute.

use fc_derive::{Message, OneOf, OpenEnum};
use fc_runtime::json::{decode, to_vec};
use fc_runtime::{Allowance, BodyError, Bytes64, Extra, Json, JsonRef, Message, transcode};

/// Every kind of field.
#[derive(Clone, Debug, PartialEq, Message)]
#[fc(example = r#"{"stationId":3,"x":"0.5","name":"A","serial":"123456789012345"}"#)]
struct Station {
    #[fc(key = "stationId", min = 0, max = 100)]
    station_id: i32,
    #[fc(wire = "string", min = -1.5, max = 1)]
    x: f64,
    #[fc(length = 1..=4, also("title", "label"))]
    name: String,
    #[fc(pattern = "[0-9]{15}", length = 15)]
    serial: String,
    #[fc(empty_is_absent)]
    data: Option<Inner>,
    #[fc(lenient(number))]
    count: Option<u16>,
    #[fc(lenient(bool))]
    open: Option<bool>,
    #[fc(lenient(number), wire = "string", empty_is_absent)]
    speed: Option<f32>,
    r#type: Option<Kind>,
    #[fc(wire = "string")]
    kinds: Option<Vec<Kind>>,
    #[fc(length = 0..=2)]
    list: Option<Vec<Inner>>,
    image: Option<Bytes64>,
    any: Option<Json>,
    /// The thirteenth: more than the longest tuple that implements anything.
    #[fc(key = "a \"quoted\" key\\", sensitive)]
    quoted: Option<bool>,
    #[fc(extra)]
    extra: Extra,
}

/// A message without unknown keys.
#[derive(Clone, Debug, Default, PartialEq, Message)]
struct Inner {
    #[fc(max = 9)]
    level: Option<u8>,
}

/// No fields but the unknown ones.
#[derive(Clone, Debug, PartialEq, Message)]
struct Open {
    #[fc(extra)]
    extra: Extra,
}

/// No fields at all.
#[derive(Clone, Copy, Debug, PartialEq, Message)]
struct Nothing;

#[derive(Clone, Copy, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = u8)]
enum Kind {
    #[fc(value = 0)]
    Dock,
    #[fc(value = 0x10)]
    Shelf,
    #[fc(other)]
    Unknown(u8),
}

#[derive(Clone, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = str)]
enum Mode {
    #[fc(value = "day")]
    Day,
    #[fc(value = "night")]
    Night,
    #[fc(value = "dusk")]
    Dusk,
    #[fc(other)]
    Other(String),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = i16)]
enum Slope {
    #[fc(value = -3)]
    Down,
    #[fc(value = 0)]
    Flat,
}

/// Fields that take some values of their enums.
#[derive(Clone, Debug, PartialEq, Message)]
struct Chosen {
    #[fc(only(0))]
    kind: Option<Kind>,
    #[fc(only("day", "dusk"))]
    mode: Option<Mode>,
    #[fc(only(-3))]
    slope: Option<Slope>,
    #[fc(only(0x10, 0))]
    kinds: Option<Vec<Kind>>,
}

#[derive(Clone, Debug, PartialEq, OneOf)]
enum Cells {
    Active(Active),
    Layout(Layout),
}

#[derive(Clone, Debug, PartialEq, Message)]
struct Active {
    #[fc(key = "activeIndex", also("index"), max = 3)]
    active_index: u8,
    note: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Message)]
struct Layout {
    rows: u8,
    columns: u8,
    #[fc(extra)]
    extra: Extra,
}

const ALLOWANCE: Allowance = Allowance::depth(64);

fn read<M: Message>(text: &str) -> Result<M, BodyError> {
    decode(text.as_bytes(), ALLOWANCE)
}

fn written<M: Message>(message: &M) -> String {
    String::from_utf8(to_vec(message)).unwrap_or_default()
}

/// Reads a station whose required keys are given, followed by `rest`.
fn station(rest: &str) -> Result<Station, BodyError> {
    let known = r#""stationId":3,"x":"0.5","name":"A","serial":"123456789012345""#;
    read(&format!("{{{known}{rest}}}"))
}

fn error<M: Message + std::fmt::Debug>(text: &str) -> (&'static str, String) {
    match read::<M>(text) {
        Ok(message) => panic!("{text} was read as {message:?}"),
        Err(error) => (error.name(), error.path().to_owned()),
    }
}

#[test]
fn keys_come_in_any_order_and_are_written_in_theirs() {
    let text = r#"{"stationId":3,"x":"0.5","name":"A","serial":"123456789012345","data":{"level":1},"count":5,"open":true,"speed":"1.5","type":16,"kinds":["0","77"],"list":[{"level":2},{}],"image":"aGk=","any":[ 1, null],"a \"quoted\" key\\":false}"#;
    let message: Station = read(text).unwrap();
    assert_eq!(message.r#type, Some(Kind::Shelf));
    assert_eq!(message.kinds, Some(vec![Kind::Dock, Kind::Unknown(77)]));
    assert_eq!(message.quoted, Some(false));
    assert!(message.extra.is_empty());
    assert_eq!(written(&message), text);

    // The same with the members turned round and spread out.
    let parts: Vec<&str> = vec![
        r#""a \"quoted\" key\\":false"#,
        r#""any":[ 1, null]"#,
        r#""image" : "aGk=""#,
        r#""list":[{"level":2},{}]"#,
        r#""kinds":["0","77"]"#,
        r#""type":16"#,
        r#""speed":"1.5""#,
        r#""open":true"#,
        r#""count":5"#,
        r#""data":{"level":1}"#,
        r#""\u0073erial":"123456789012345""#,
        r#""name":"A""#,
        r#""x":"0.5""#,
        r#""stationId":3"#,
    ];
    let turned: Station = read(&format!(" {{\n{}\r\n}}\t", parts.join(" ,\n "))).unwrap();
    assert_eq!(turned, message);
}

#[test]
fn unknown_keys_are_kept_or_skipped() {
    let message = station(r#","new":{"a":[1 , 2]},"newer":null"#).unwrap();
    let mut keys = message.extra.iter();
    let mut next = || {
        keys.next()
            .map(|(key, value)| (key.into_owned(), value.as_str()))
    };
    assert_eq!(next(), Some(("new".to_owned(), r#"{"a":[1 , 2]}"#)));
    assert_eq!(next(), Some(("newer".to_owned(), "null")));
    assert_eq!(next(), None);
    assert!(written(&message).ends_with(r#","new":{"a":[1 , 2]},"newer":null}"#));

    let inner: Inner = read(r#"{"new":{"a":1},"level":7,"newer":2}"#).unwrap();
    assert_eq!(written(&inner), r#"{"level":7}"#);
    assert_eq!(read::<Nothing>(r#"{"a":1}"#).unwrap(), Nothing);
    assert_eq!(written(&Nothing), "{}");
    let open: Open = read(r#"{"b":1,"a":2}"#).unwrap();
    assert_eq!(written(&open), r#"{"b":1,"a":2}"#);
    assert_eq!(
        read::<Open>("").unwrap(),
        Open {
            extra: Extra::new()
        }
    );
}

#[test]
fn keys_are_known_however_they_are_spelled() {
    let text = r#"{"\u006eew" : 1,"seri\u0061l" : "123456789012345","x":"0","l\u0061bel":"A" , "stationId" :3,"a \u0022quoted\u0022 key\u005c":true}"#;
    let message: Station = read(text).unwrap();
    assert_eq!((message.station_id, message.quoted), (3, Some(true)));
    assert_eq!(message.extra.get("new").map(JsonRef::as_str), Some("1"));

    // A value is no key, and the end of the text is no place to look for one.
    for text in [
        r#"{"activeIndex" :"activeIndex":1}"#,
        r#"{"new" :"activeIndex":1}"#,
        r#"{"new":"activeIndex":1}"#,
        r#"{"activeIndex""#,
        r#"{"new" :"#,
    ] {
        assert_eq!(error::<Active>(text).0, "bad_json", "{text}");
    }

    let text = br#"{"rows" :1,"new":2,"index" :3,"newer" :4,"c\u006flumns":5}"#;
    let both = fc_runtime::read_enveloped::<Active, Layout>(text, ALLOWANCE).unwrap();
    assert_eq!(both.envelope.active_index, 3);
    let body = both.body.unwrap();
    assert_eq!((body.rows, body.columns, body.extra.len()), (1, 5, 2));

    // An envelope keeps nothing that may be the body's, whatever becomes of the body.
    for text in [
        r#"{"rows":1,"new":2}"#,
        r#"{"new" :2,"rows":"","columns":1}"#,
    ] {
        let both = fc_runtime::read_enveloped::<Open, Layout>(text.as_bytes(), ALLOWANCE).unwrap();
        assert!(both.envelope.extra.is_empty() && both.body.is_err());
    }
    let text = br#"{"rows":"","new":nil}"#;
    let error = fc_runtime::read_enveloped::<Open, Layout>(text, ALLOWANCE).unwrap_err();
    assert_eq!(error.name(), "bad_json");
}

#[test]
fn a_known_key_comes_once_under_one_of_its_names() {
    for (text, path) in [
        (r#"{"level":1,"level":2}"#, "level"),
        (r#"{"level":1,"x":0,"level":null}"#, "level"),
        (r#"{"level":null,"level":1}"#, "level"),
    ] {
        assert_eq!(error::<Inner>(text), ("duplicate_key", path.to_owned()));
    }
    for (text, path) in [
        (r#"{"activeIndex":1,"index":2}"#, "index"),
        (r#"{"index":1,"new":0,"activeIndex" :1}"#, "activeIndex"),
    ] {
        assert_eq!(error::<Active>(text), ("duplicate_key", path.to_owned()));
    }
    // Open values and unknown keys keep everything unchanged.
    let text = r#","any":{"a":1,"a":2},"new":1,"new":2"#;
    assert!(written(&station(text).unwrap()).ends_with(&format!("{text}}}")));
}

#[test]
fn other_keys_are_read_and_not_written() {
    let text = r#"{"stationId":3,"x":"0","label":"B","serial":"123456789012345"}"#;
    let message: Station = read(text).unwrap();
    assert_eq!(message.name, "B");
    assert!(written(&message).contains(r#","name":"B","#));
}

#[test]
fn lenient_fields_accept_their_forms() {
    for (text, count) in [
        ("5", 5),
        ("5.0", 5),
        ("\"5\"", 5),
        ("\"5.0\"", 5),
        ("\"0x1F\"", 31),
        ("\"0Xff\"", 255),
    ] {
        assert_eq!(
            station(&format!(r#","count":{text}"#)).unwrap().count,
            Some(count)
        );
    }
    for text in [
        "\"\"", "\" 5\"", "\"5 \"", "\"0x\"", "\"+5\"", "\"0x+5\"", "5.5", "\"5.5\"", "true",
    ] {
        assert_eq!(
            station(&format!(r#","count":{text}"#)).unwrap_err().name(),
            "wrong_type",
            "{text}"
        );
    }
    for text in [
        "65536",
        "\"65536\"",
        "\"0x10000\"",
        "-1",
        "\"-1\"",
        "\"0xffffffffffffffffff\"",
    ] {
        assert_eq!(
            station(&format!(r#","count":{text}"#)).unwrap_err().name(),
            "out_of_range",
            "{text}"
        );
    }
    for (text, open) in [
        ("true", true),
        ("\"true\"", true),
        ("1", true),
        ("0", false),
        ("1.0", true),
        ("-0e1", false),
        ("\"false\"", false),
    ] {
        assert_eq!(
            station(&format!(r#","open":{text}"#)).unwrap().open,
            Some(open)
        );
    }
    for text in ["2", "-1", "\"yes\"", "\"1\"", "[]", "0.5"] {
        assert_eq!(
            station(&format!(r#","open":{text}"#)).unwrap_err().name(),
            "wrong_type",
            "{text}"
        );
    }
    for (text, speed) in [
        ("1.5", 1.5),
        ("\"1.5\"", 1.5),
        ("\"0x10\"", 16.0),
        ("\"0x100000000\"", 4_294_967_296.0),
        ("\"2\"", 2.0),
        ("2", 2.0),
    ] {
        assert_eq!(
            station(&format!(r#","speed":{text}"#)).unwrap().speed,
            Some(speed)
        );
    }
    for (text, name) in [
        ("\"0x1FFFFFFFFFFFFFFFF\"", "out_of_range"),
        ("\"0x\"", "wrong_type"),
        ("\"0x1.8\"", "wrong_type"),
        ("\"-0x1\"", "wrong_type"),
    ] {
        assert_eq!(
            station(&format!(r#","speed":{text}"#)).unwrap_err().name(),
            name,
            "{text}"
        );
    }
    for text in ["null", "\"\"", "{}", "[]", "{ }", "[\n]"] {
        assert_eq!(
            station(&format!(r#","speed":{text}"#)).unwrap().speed,
            None,
            "{text}"
        );
        assert_eq!(
            station(&format!(r#","data":{text}"#)).unwrap().data,
            None,
            "{text}"
        );
    }
}

#[test]
fn a_quoted_number_is_a_string_and_nothing_else() {
    for text in [
        "0.5", "null", "true", "\"\"", "\"a\"", "\"1,5\"", "\"NaN\"", "\" 1\"",
    ] {
        let text = format!(r#"{{"stationId":3,"x":{text},"name":"A","serial":"123456789012345"}}"#);
        assert_eq!(
            error::<Station>(&text),
            ("wrong_type", "x".into()),
            "{text}"
        );
    }
}

#[test]
fn constraints_hold_on_reading_and_on_checking() {
    let cases = [
        (
            r#"{"stationId":-1,"x":"0","name":"A","serial":"123456789012345"}"#,
            "out_of_range",
            "stationId",
        ),
        (
            r#"{"stationId":101,"x":"0","name":"A","serial":"123456789012345"}"#,
            "out_of_range",
            "stationId",
        ),
        (
            r#"{"stationId":1,"x":"-1.6","name":"A","serial":"123456789012345"}"#,
            "out_of_range",
            "x",
        ),
        (
            r#"{"stationId":1,"x":"1.1","name":"A","serial":"123456789012345"}"#,
            "out_of_range",
            "x",
        ),
        (
            r#"{"stationId":1,"x":"0","name":"","serial":"123456789012345"}"#,
            "bad_length",
            "name",
        ),
        (
            r#"{"stationId":1,"x":"0","name":"一二三四五","serial":"123456789012345"}"#,
            "bad_length",
            "name",
        ),
        (
            r#"{"stationId":1,"x":"0","name":"A","serial":"12345678901234x"}"#,
            "bad_pattern",
            "serial",
        ),
    ];
    for (text, name, path) in cases {
        assert_eq!(error::<Station>(text), (name, path.into()), "{text}");
    }
    let inner = station(r#","data":{"level":10}"#).unwrap_err();
    assert_eq!((inner.name(), inner.path()), ("out_of_range", "data.level"));
    let listed = station(r#","list":[{},{"level":10}]"#).unwrap_err();
    assert_eq!(
        (listed.name(), listed.path()),
        ("out_of_range", "list[1].level")
    );
    assert_eq!(
        station(r#","list":[{},{},{}]"#).unwrap_err().name(),
        "bad_length"
    );

    let mut message = Station::example();
    assert_eq!(message.check(), Ok(()));
    message.list = Some(vec![Inner { level: Some(3) }, Inner { level: Some(12) }]);
    let error = message.check().unwrap_err();
    assert_eq!(
        (error.name(), error.path()),
        ("out_of_range", "list[1].level")
    );
    message.list = None;
    message.x = f64::NAN;
    assert_eq!(message.check().unwrap_err().path(), "x");
}

#[test]
fn a_field_accepts_only_its_named_values() {
    for text in [
        "{}",
        r#"{"kind":0,"mode":"dusk","slope":-3,"kinds":[0,16,0]}"#,
        r#"{"mode":"day","kinds":[]}"#,
    ] {
        let message = read::<Chosen>(text).unwrap();
        assert_eq!(message.check(), Ok(()), "{text}");
    }
    let cases = [
        (r#"{"kind":16}"#, "out_of_range", "kind"),
        // The open enum keeps it; the field does not take it.
        (r#"{"kind":99}"#, "out_of_range", "kind"),
        (r#"{"mode":"night"}"#, "out_of_range", "mode"),
        (r#"{"mode":"noon"}"#, "out_of_range", "mode"),
        (r#"{"slope":0}"#, "out_of_range", "slope"),
        (r#"{"slope":7}"#, "unknown_value", "slope"),
        (r#"{"kinds":[16,1]}"#, "out_of_range", "kinds"),
    ];
    for (text, name, path) in cases {
        assert_eq!(error::<Chosen>(text), (name, path.into()), "{text}");
    }

    let mut message = read::<Chosen>(r#"{"mode":"day"}"#).unwrap();
    for refused in [Mode::Night, Mode::Other("noon".to_owned())] {
        message.mode = Some(refused);
        let error = message.check().unwrap_err();
        assert_eq!((error.name(), error.path()), ("out_of_range", "mode"));
        assert_eq!(error.detail(), "the value must be one of: day, dusk");
    }
}

#[test]
fn errors_have_a_path() {
    let text = r#"{"stationId":3,"x":"0.5","name":"A","serial":"123456789012345","list":[{"level":1},{"level":"2"}]}"#;
    let error = read::<Station>(text).unwrap_err();
    assert_eq!(
        (error.name(), error.path()),
        ("wrong_type", "list[1].level")
    );
    assert_eq!(error.offset(), text.find("\"2\"").unwrap());

    let text = r#"{"stationId":3,"x":"0.5","name":"A"}"#;
    let error = read::<Station>(text).unwrap_err();
    assert_eq!(
        (error.name(), error.path(), error.offset()),
        ("missing_field", "serial", 0)
    );
}

#[test]
fn a_choice_goes_by_required_keys() {
    let read = |text: &str| Json::new(text).unwrap().read_as::<Cells>();
    assert!(matches!(read(r#"{"activeIndex":1}"#), Ok(Cells::Active(_))));
    assert!(matches!(
        read(r#"{"index":1,"columns":2}"#),
        Ok(Cells::Active(_))
    ));
    // Both would do: the first one is taken.
    assert!(matches!(
        read(r#"{"rows":1,"columns":2,"activeIndex":1}"#),
        Ok(Cells::Active(_))
    ));
    let layout = read(r#" { "columns":2, "x":[], "rows":1 }"#).unwrap();
    assert!(matches!(&layout, Cells::Layout(layout) if layout.extra.get("x").is_some()));
    assert_eq!(to_vec(&layout), br#"{"rows":1,"columns":2,"x":[]}"#);
    for text in ["{}", r#"{"rows":1}"#, r#"{"note":""}"#] {
        assert_eq!(read(text).unwrap_err().name(), "no_variant", "{text}");
    }
    assert_eq!(read("[]").unwrap_err().name(), "wrong_type");
    // Chosen by its keys. Errors inside are errors of that variant.
    assert_eq!(
        read(r#"{"activeIndex":"1"}"#).unwrap_err().name(),
        "wrong_type"
    );
    assert_eq!(
        read(r#"{"activeIndex":4}"#).unwrap_err().path(),
        "activeIndex"
    );
}

#[test]
fn examples_are_read_and_transcoded() {
    assert_eq!(Station::example().station_id, 3);
    assert_eq!(Open::EXAMPLE, "{}");
    let text = transcode::<Station>(
        br#"{"serial":"123456789012345","x":"5e-1","title":"A","stationId":3}"#,
    );
    assert_eq!(text.unwrap(), Station::EXAMPLE.as_bytes());
}

#[test]
fn fields_struct_has_the_required_fields() {
    let lacking = |keys: &[&'static str]| {
        let keys: Vec<_> = keys.iter().map(|&key| key.into()).collect();
        fc_runtime::json::lacking::<Station>(&keys)
    };
    // By their names in front of the value.
    let required = [r#""stationId":"#, r#""x":"#, r#""name":"#, r#""serial":"#];
    assert_eq!(lacking(&[]), required);
    assert_eq!(lacking(&["title", "serial", "stationId"]), [r#""x":"#]);
}
