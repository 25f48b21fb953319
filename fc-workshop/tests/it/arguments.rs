//! Arguments as text.

use crate::support::small;
use fc_spec::model::Direction;
use fc_workshop::arguments::Arguments;

/// Arguments of `set_light`, and the object or the error.
const CASES: &[(&[&str], &str)] = &[
    (&["lvl=7"], r#"{"lvl":7}"#),
    (&["level=0x10"], r#"{"lvl":16}"#),
    (&["lvl=7", "lvl=8"], r#"{"lvl":8}"#),
    (
        &["gain=0.5", "ratio=0.25"],
        r#"{"gain":0.5,"ratio":"0.25"}"#,
    ),
    (
        &["on=true", "word=true", "lit=true"],
        r#"{"on":true,"word":"true","lit":1}"#,
    ),
    (&["name=a=b"], r#"{"name":"a=b"}"#),
    (&["mode=night", "mood=bad"], r#"{"mode":2,"mood":"b\"d"}"#),
    (&["mode=1"], r#"{"mode":1}"#),
    (&["grid=[[1,2]]"], r#"{"grid":[[1,2]]}"#),
    (&["grid.1.0=3"], r#"{"grid":[null,[3]]}"#),
    (&["spot.x=1", "spot.y=2"], r#"{"spot":{"x":1.0,"y":2.0}}"#),
    (&["spot.room=hall"], r#"{"spot":{"room":"hall"}}"#),
    (&["tree.next.0.leaf=4"], r#"{"tree":{"next":[{"leaf":4}]}}"#),
    (&["any={\"a\":[1]}"], r#"{"any":{"a":[1]}}"#),
    (&["lvl"], "expected `key=value`, found `lvl`"),
    (
        &["lux=1"],
        "`lux`: there is no key `lux`; the keys are lvl, gain",
    ),
    (
        &["lvl=much"],
        "expected an integer from 0 to 255 for `lvl`, found `much`",
    ),
    (&["gain=NaN"], "expected a number for `gain`, found `NaN`"),
    (
        &["mode=dusk"],
        "expected one of day (1), night (2) for `mode`, found `dusk`",
    ),
    (&["on=1"], "expected `true` or `false` for `on`, found `1`"),
    (
        &["lvl.x=1"],
        "`lvl.x`: the value before `x` is not an object",
    ),
    (
        &["grid.a=1"],
        "`grid.a`: expected an index from 0 instead of `a`",
    ),
    (
        &["grid.9999999999=1"],
        "`grid.9999999999`: expected an index below 4096",
    ),
];

#[test]
fn arguments_give_an_object_or_an_error() {
    let model = small();
    let body = model
        .operation("set_light")
        .unwrap()
        .body(Direction::Request);
    let body = &body.unwrap().ty;
    for (arguments, expected) in CASES {
        let shown = match Arguments::new(&model).object(body, arguments.iter().copied()) {
            Ok(object) => object.to_string(),
            Err(error) => error.to_string(),
        };
        assert!(shown.starts_with(expected), "{arguments:?}: {shown}");
    }
}
