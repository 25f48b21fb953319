//! Tests the model of the small valid spec.

use crate::good_spec;
use fc_spec::diagnostic::Faults;
use fc_spec::load::load;
use fc_spec::model::{
    Ack, BodyState, Direction, Example, Exchange, Field, Kind, Model, PortRole, Side, Text,
    TypeShape, Value,
};
use fc_spec::source::Sources;

fn field<'m>(model: &'m Model, ty: &str, wire: &str) -> &'m Field {
    match &model.types.named(ty).expect(ty).shape {
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
    let data = model.types.named("GetThingResponseData").expect("made");
    let body = data.body_of.as_ref().expect("of a body");
    assert_eq!(
        (body.operation.as_str(), body.side),
        ("get_thing", Direction::Response)
    );
    assert_eq!(body.path, ["data"]);
    assert_eq!(data.group.as_deref(), Some("demo_group"));
}

#[test]
fn omitted_values_get_their_defaults() {
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
    let Exchange::Report { ack, .. } = report.exchange else {
        panic!("a report");
    };
    assert_eq!(
        ack,
        Ack {
            timeout_ms: 500,
            retries: 1
        }
    );
    assert_eq!(command.kind(), Kind::Command);
    assert_eq!(
        model.calls.ack,
        Ack {
            timeout_ms: 2000,
            retries: 3
        }
    );
    assert_eq!(model.calls.max_age_ms, None);
    assert_eq!(command.body_state(Direction::Request), BodyState::Stated);
    assert_eq!(command.body_state(Direction::Response), BodyState::Inferred);
    assert!(stream.messages().is_none());
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

/// Answers are in the order of the files and of their lines.
#[test]
fn answers_keep_their_order() {
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

#[test]
fn an_error_has_the_cause_that_its_operation_gives() {
    let texts = good_spec::FILES.map(|path| {
        let causes = "errors: [3, { code: 0x2, zh: 太重, en: Too heavy }]";
        let text = good_spec::file(path).replace("errors: [2, 3]", causes);
        (format!("spec/{path}"), text)
    });
    let mut faults = Faults::new();
    let model = load(&Sources::from_texts(texts), &mut faults).model();
    let model = model.expect("a sound spec");
    let command = model.operation("get_thing").expect("a command");
    let cause = Text {
        zh: "太重".to_owned(),
        en: "Too heavy".to_owned(),
    };
    let errors = command.errors.iter().map(|it| (it.code, it.cause.as_ref()));
    assert_eq!(errors.collect::<Vec<_>>(), [(2, Some(&cause)), (3, None)]);
}

#[test]
fn inline_type_may_have_a_name() {
    let texts = good_spec::FILES.map(|path| {
        let text = good_spec::file(path);
        let text = text.replace(
            "          zh: 选择\n",
            "          zh: 选择\n          type_name: Pick\n",
        );
        let named = "pair: { type_name: Couple, zh";
        (format!("spec/{path}"), text.replace("pair: { zh", named))
    });
    let mut faults = Faults::new();
    let model = load(&Sources::from_texts(texts), &mut faults).model();
    let model = model.expect("a sound spec");
    let names = model.types.iter().map(|ty| ty.name.as_str());
    let names: Vec<_> = names.skip(2).take(4).collect();
    assert_eq!(
        names,
        ["GetThingResponseData", "Pick", "Couple", "PickSingle"]
    );
    let body = model.types.named("Pick").and_then(|ty| ty.body_of.as_ref());
    assert_eq!(body.expect("of a body").path, ["data", "choice"]);
}

/// A stream has the code of the command that starts it, in whichever file each is. Its body has no envelope.
#[test]
fn a_stream_shares_the_code_of_its_command() {
    let streams = "group: { id: a_before, zh: 前, en: Before }\nstreams:\n  \
         thing_curve: { code: 0x0101, zh: 曲线, en: Curve, from: robot, started_by: get_thing, stopped_by: get_thing, \
         source: { sections: [] }, body: { result: { type: u8, example: 1, zh: 值, en: Value } } }\n  \
         thing_film: { code: 0x0502, zh: 影片, en: Film, from: app, content: video/mp4, source: { sections: [] } }\n";
    let files = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    let more = ("spec/commands/a_before.yaml".to_owned(), streams.to_owned());
    let sources = Sources::from_texts(files.into_iter().chain([more]));
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model().expect("a model");
    assert!(faults.is_empty(), "{faults:?}");
    let command = model.operation("get_thing").expect("a command");
    let curve = model.operation("thing_curve").expect("a stream");
    assert_eq!(curve.code.value, command.code.value);
    let started: Vec<_> = model.streams_of(command).map(|it| &*it.name).collect();
    assert_eq!(started, ["thing_curve"]);
    let media_type = |name| {
        let stream = model.operation(name).and_then(|it| it.stream());
        stream.expect("a stream").content.media_type()
    };
    assert_eq!(media_type("thing_curve"), Some("application/json"));
    assert_eq!(media_type("thing_film"), Some("video/mp4"));
    assert_eq!(media_type("thing_picture"), None);
    let body = curve.body(Direction::Request).expect("JSON");
    assert_eq!(body.ty.name(), "ThingCurve");
    assert!(curve.body(Direction::Response).is_none());
}
