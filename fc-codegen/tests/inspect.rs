//! What `fc inspect` tells of the small good spec.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "tests"
)]

#[path = "../../fc-spec/tests/good_spec/mod.rs"]
mod good_spec;

use fc_codegen::inspect;
use fc_spec::model::Value;

/// path, type, whether optional, how it travels, example.
type Row<'a> = (&'a str, &'a str, bool, &'a str, &'a str);

const RESPONSE: &[Row<'static>] = &[
    ("data", "GetThingResponseData", false, "object", "*"),
    ("data.name", "string", false, "string", "\"box\""),
    ("data.color", "Color", false, "number", "0"),
    ("data.x", "f64", false, "string", "\"0.5\""),
    ("data.y", "f64", true, "number", "null"),
    ("data.tags", "[string]", false, "array", "[\"a\",\"b\"]"),
    ("data.tags[]", "string", false, "string", "\"a\""),
    (
        "data.choice",
        "GetThingResponseDataChoice",
        false,
        "object",
        "{\"a\":1,\"b\":2}",
    ),
    ("data.choice.a", "u8", true, "number", "1"),
    ("data.choice.b", "u8", true, "number", "2"),
];

#[test]
fn a_dump_lists_everything_in_a_body() {
    let dump = inspect::value(&good_spec::model());
    let Some(Value::Array(operations)) = dump.get("operations") else {
        panic!("no operations");
    };
    let fields = operations
        .first()
        .and_then(|operation| operation.get("response"))
        .and_then(|body| body.get("fields"));
    let Some(Value::Array(fields)) = fields else {
        panic!("no fields");
    };
    let show = |field: &Value, key: &str| field.get(key).map(ToString::to_string);
    let text = |field: &Value, key: &str| match field.get(key) {
        Some(Value::String(text)) => text.clone(),
        other => panic!("{key}: {other:?}"),
    };
    assert_eq!(fields.len(), RESPONSE.len());
    for (field, (path, ty, optional, wire, example)) in fields.iter().zip(RESPONSE) {
        assert_eq!(text(field, "path"), *path);
        assert_eq!(text(field, "type"), *ty, "{path}");
        assert_eq!(text(field, "wire"), *wire, "{path}");
        assert_eq!(
            show(field, "optional"),
            Some(optional.to_string()),
            "{path}"
        );
        if *example != "*" {
            assert_eq!(show(field, "example").as_deref(), Some(*example), "{path}");
        }
    }
    let variants = fields.get(8).and_then(|field| show(field, "variants"));
    assert_eq!(variants.as_deref(), Some("[\"pair\",\"single\"]"));
}

/// The keys that the documentation of the format promises, wherever they stand.
#[test]
fn a_dump_has_its_documented_keys() {
    let dump = inspect::value(&good_spec::model());
    let keys = |value: Option<&Value>| match value {
        Some(Value::Object(entries)) => entries
            .iter()
            .map(|(key, _)| key.clone())
            .collect::<Vec<_>>()
            .join(" "),
        other => panic!("no object: {other:?}"),
    };
    let first = |key: &str| match dump.get(key) {
        Some(Value::Array(items)) => items.first(),
        other => panic!("{key}: {other:?}"),
    };
    assert_eq!(
        keys(Some(&dump)),
        "format protocol operations types result_codes ranges retired_codes tables open_questions \
         lost_sections changes"
    );
    assert_eq!(
        keys(first("operations")),
        "name kind kind_state group zh en aliases about code code_state sender port effect effect_state sections lost request \
         response ack result_text errors since deprecated changes place"
    );
    assert_eq!(
        keys(first("operations").and_then(|operation| operation.get("request"))),
        "state note type fields"
    );
    assert_eq!(
        keys(first("open_questions")),
        "id severity category kind subject zh en gap place answers"
    );
    assert_eq!(keys(first("ranges")), "from to use next zh en");
    assert_eq!(keys(first("result_codes")), "code name role zh en about");
    assert_eq!(
        keys(first("types")),
        "name kind group body_of zh en about since changes place state fields"
    );
}

#[test]
fn a_dump_is_json() {
    let model = good_spec::model();
    let text = inspect::json(&model);
    let parsed: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(parsed["format"], inspect::FORMAT);
    assert_eq!(parsed["ranges"][0]["next"], 0x0100);
    assert!(text.ends_with("}\n"));
}
