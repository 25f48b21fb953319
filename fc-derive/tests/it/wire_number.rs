//! A bool with `wire = "number"`.

use fc_derive::Message;
use fc_runtime::json::{decode, to_vec};
use fc_runtime::{Allowance, BodyError};

/// Bools that travel as numbers.
#[derive(Clone, Debug, Default, PartialEq, Message)]
struct Switches {
    #[fc(wire = "number")]
    on: bool,
    #[fc(wire = "number", empty_is_absent)]
    armed: Option<bool>,
    #[fc(wire = "number", lenient(bool))]
    lenient: Option<bool>,
    #[fc(wire = "number")]
    all: Option<Vec<bool>>,
}

fn read(text: &str) -> Result<Switches, BodyError> {
    decode(text.as_bytes(), Allowance::depth(64))
}

fn written(switches: &Switches) -> String {
    String::from_utf8(to_vec(switches)).unwrap()
}

fn error(text: &str) -> (&'static str, String) {
    match read(text) {
        Ok(switches) => panic!("{text} was read as {switches:?}"),
        Err(error) => (error.name(), error.path().to_owned()),
    }
}

#[test]
fn a_bool_travels_as_a_number() {
    let text = r#"{"on":1,"armed":0,"lenient":1,"all":[1,0]}"#;
    let switches = Switches {
        on: true,
        armed: Some(false),
        lenient: Some(true),
        all: Some(vec![true, false]),
    };
    assert_eq!(read(text).unwrap(), switches);
    assert_eq!(written(&switches), text);
    assert_eq!(written(&Switches::default()), r#"{"on":0}"#);
    assert_eq!(error("{}"), ("missing_field", "on".to_owned()));
}

/// However they are written, as integers are.
#[test]
fn one_and_zero_are_read() {
    for (text, on) in [
        ("1.0", true),
        ("1e0", true),
        ("10e-1", true),
        ("0.0", false),
        ("-0", false),
    ] {
        let read = read(&format!(r#"{{"on":{text}}}"#)).unwrap();
        assert_eq!(read.on, on, "{text}");
    }
}

#[test]
fn other_spellings_are_refused() {
    for text in [
        "2",
        "-1",
        "0.5",
        "1e99",
        "18446744073709551616",
        "true",
        "false",
        "\"1\"",
        "\"true\"",
        "null",
        "[1]",
        "{}",
    ] {
        let found = error(&format!(r#"{{"on":{text}}}"#));
        assert_eq!(found, ("wrong_type", "on".to_owned()), "{text}");
    }
    for text in ["01", "1.", "-"] {
        let text = format!(r#"{{"on":{text}}}"#);
        assert_eq!(error(&text).0, "bad_json", "{text}");
    }
    assert_eq!(
        error(r#"{"on":1,"all":[1,true]}"#),
        ("wrong_type", "all[1]".to_owned())
    );
}

#[test]
fn quirks_accept_their_form() {
    for (text, armed) in [("null", None), ("[]", None), ("1", Some(true))] {
        let read = read(&format!(r#"{{"on":0,"armed":{text}}}"#)).unwrap();
        assert_eq!(read.armed, armed, "{text}");
    }
    for (text, lenient) in [("0", false), ("true", true), ("\"false\"", false)] {
        let read = read(&format!(r#"{{"on":0,"lenient":{text}}}"#)).unwrap();
        assert_eq!(read.lenient, Some(lenient), "{text}");
        let sent = u8::from(lenient);
        assert_eq!(
            written(&read),
            format!(r#"{{"on":0,"lenient":{sent}}}"#),
            "{text}"
        );
    }
}
