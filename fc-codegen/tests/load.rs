//! What the small good spec becomes.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "tests"
)]

mod good_spec;

use fc_codegen::inspect;
use fc_codegen::model::{
    Ack, BodyState, Example, Field, Model, PortRole, Side, Text, TypeShape, Value,
};

fn field<'m>(model: &'m Model, ty: &str, wire: &str) -> &'m Field {
    match &model.type_named(ty).expect(ty).shape {
        TypeShape::Struct(shape) => shape
            .fields
            .iter()
            .find(|field| field.wire == wire)
            .expect(wire),
        _ => panic!("{ty} is no struct"),
    }
}

#[test]
fn types_are_made_in_the_order_written() {
    let model = good_spec::model();
    let names: Vec<_> = model.types.iter().map(|ty| ty.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "GetThingRequest",
            "GetThingResponse",
            "GetThingResponseData",
            "GetThingResponseDataChoice",
            "GetThingResponseDataChoicePair",
            "GetThingResponseDataChoiceSingle",
            "ThingMoved",
            "ThingMovedAck",
            "Color",
            "Size",
        ]
    );
    let data = model.type_named("GetThingResponseData").expect("made");
    let body = data.body_of.as_ref().expect("of a body");
    assert_eq!(
        (body.operation.as_str(), body.request),
        ("get_thing", false)
    );
    assert_eq!(body.path, ["data"]);
    assert_eq!(data.group.as_deref(), Some("demo_group"));
}

#[test]
fn what_is_left_out_is_filled_in() {
    let model = good_spec::model();
    let command = model.operation("get_thing").expect("a command");
    let report = model.operation("thing_moved").expect("a report");
    let stream = model.operation("thing_picture").expect("a stream");
    assert_eq!(
        [command.port, report.port, stream.port],
        [PortRole::Command, PortRole::Command, PortRole::Data]
    );
    assert_eq!(
        [command.sender, report.sender, stream.sender],
        [Side::App, Side::Robot, Side::Robot]
    );
    assert_eq!(
        report.ack,
        Some(Ack {
            timeout_ms: 500,
            retries: 1
        })
    );
    assert_eq!(command.ack, None);
    assert_eq!(
        model.calls.ack,
        Ack {
            timeout_ms: 2000,
            retries: 3
        }
    );
    assert_eq!(model.calls.max_age_ms, None);
    assert_eq!(command.request.state, BodyState::Stated);
    assert_eq!(command.response.state, BodyState::Inferred);
    assert_eq!(stream.request.ty, None);
    assert_eq!(
        field(&model, "GetThingResponseData", "color").text,
        Text {
            zh: "颜色".into(),
            en: "Color".into()
        }
    );
    assert_eq!(
        field(&model, "GetThingResponse", "data").text,
        Text {
            zh: "业务数据".into(),
            en: "Payload".into()
        }
    );
    let success = model.results.first().expect("a result");
    assert_eq!(success.about, success.text);
}

#[test]
fn examples_are_given_derived_or_absent() {
    let model = good_spec::model();
    for (ty, wire, expected) in [
        (
            "GetThingResponseData",
            "name",
            Example::Given(Value::String("box".into())),
        ),
        (
            "GetThingResponseData",
            "x",
            Example::Given(Value::String("0.5".into())),
        ),
        ("GetThingResponseData", "color", Example::Derived),
        ("GetThingResponseData", "y", Example::Absent),
        ("GetThingResponse", "data", Example::Derived),
        ("ThingMoved", "color", Example::Derived),
    ] {
        assert_eq!(field(&model, ty, wire).example, expected, "{ty}.{wire}");
    }
}

#[test]
fn header_fields_know_their_place() {
    let model = good_spec::model();
    let offsets: Vec<_> = model
        .frame
        .header
        .iter()
        .map(|field| field.offset)
        .collect();
    assert_eq!(offsets, [0, 2, 3, 5, 9, 10, 11, 15, 19, 35]);
    assert_eq!(model.frame.header_len(), 36);
}

/// Order of the files and of the lines in them.
#[test]
fn answers_stand_in_the_order_written() {
    let model = good_spec::model();
    let ids: Vec<_> = model
        .answers
        .iter()
        .flat_map(|answer| &answer.ids)
        .collect();
    assert_eq!(ids, ["C001"]);
    let answer = model.answers.first().expect("an answer");
    assert_eq!(answer.location.file, "spec/commands/demo.yaml");
    assert_eq!(answer.location.line, 29);
}

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
