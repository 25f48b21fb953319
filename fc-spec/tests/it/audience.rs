//! Tests `Model::for_audience`: the model of one audience has only its part of the spec, and no dangling names.

use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{
    Asked, Condition, Dump, Example, Lang, Model, Number, ProjectionError, Scalar, TypeShape, Value,
};
use fc_spec::source::Sources;
use std::path::Path;

/// A group for the good spec. It limits items of every kind to an audience, and names such items in every way.
const MORE: &str = r#"
group: { id: more, zh: 更多, en: More }
commands:
  ask:
    code: 0x0102
    zh: 询问
    en: Ask
    effect: config
    sets_off: [{ report: heard, tied: { request.job: job, request.secret: secret } }, probed]
    accepted: { in: { Mood: [1, 2] }, after: [probe] }
    source: { sections: [] }
    request:
      extra: { type: "Extra?", available: { for: [debugging_app] }, kept: lab, zh: 附加, en: Extra }
      job: { type: "u32?", example: 1, zh: 编号, en: Job }
      secret: { type: "u32?", example: 1, available: { for: [debugging_app] }, zh: 暗号, en: Secret }
      mood: { type: Mood, example: 2, zh: 心情, en: Mood }
      why: { type: "u8?", when: { mood: 2 }, example: absent, zh: 奇怪的原因, en: Why it is odd }
      sane: { type: "u8?", unless: { mood: 2 }, example: 1, zh: 正常, en: Sane }
      plain: { type: "u8?", when: { mood: [1, 2] }, example: 1, zh: 平常, en: Plain }
      moods: { type: [Mood], example: [1, 2], zh: 各种心情, en: Moods }
      tone: { type: "Mood?", only: [1, 2], default: 2, zh: 语气, en: Tone }
      whole:
        zh: 整体
        en: A whole
        optional: true
        example: { mood: 1, hidden: 3 }
        fields:
          mood: { type: Mood, zh: 心情, en: Mood }
          hidden: { type: "u8?", example: 3, available: { for: [debugging_app] }, zh: 隐藏, en: Hidden }
      way:
        zh: 方式
        en: Way
        example: { probe: true }
        one_of:
          walk: { zh: 走, en: Walk, fields: { walk: { type: bool, zh: 走, en: Walk } } }
          probe: { zh: 探, en: Probe, available: { for: [debugging_app] }, fields: { probe: { type: bool, zh: 探, en: Probe } } }
          run: { zh: 跑, en: Run, fields: { run: { type: bool, zh: 跑, en: Run } } }
    deprecated: { zh: 由 probe 代替, en: Replaced, replaced_by: probe }
  probe:
    code: 0x0103
    zh: 探测
    en: Probe
    effect: read
    available: { for: [debugging_app] }
    source: { sections: [] }
    response:
      found: { type: Found, zh: 结果, en: What is found }
    answers:
      - { ids: [C900, C901], as: question, zh: 探测什么？, en: "What is probed?" }
  offer:
    code: 0x0104
    zh: 报价
    en: Offer
    effect: read
    available: { for: [product_app] }
    source: { sections: [] }
    answers:
      - { ids: [C901], as: note, zh: 没有, en: None }
reports:
  heard:
    code: 0x0202
    zh: 听到
    en: Heard
    source: { sections: [] }
    cadence: { on_change: secret }
    body:
      job: { type: "u32?", example: 1, zh: 编号, en: Job }
      secret: { type: "u32?", example: 1, available: { for: [debugging_app] }, zh: 暗号, en: Secret }
      mood: { type: Mood, zh: 心情, en: Mood }
  probed: { code: 0x0203, zh: 探到, en: Probed, available: { for: [debugging_app] }, source: { sections: [] } }
streams:
  noise: { code: unassigned, zh: 杂音, en: Noise, from: robot, started_by: probe, stopped_by: ask, source: { sections: [] } }
types:
  Extra: { zh: 附加, en: Extra, fields: { deep: { type: Deep, zh: 深处, en: Deep } } }
  Deep: { enum: u8, zh: 深, en: Deep, values: { 1: { name: very, zh: 很深, en: Very } } }
  Found: { zh: 结果, en: Found, fields: { mood: { type: Mood, zh: 心情, en: Mood } } }
  Mood:
    enum: u8
    zh: 心情
    en: Mood
    order: normal
    values:
      1: { name: calm, start: true, then: [odd, glad], zh: 平静, en: Calm }
      2: { name: odd, available: { for: [debugging_app] }, zh: 奇怪, en: Odd }
      3: { name: glad, zh: 高兴, en: Glad }
  Setting:
    zh: 设置
    en: Setting
    fields:
      mood: { type: Mood, example: 1, zh: 心情, en: Mood }
      hidden: { type: "u8?", example: 3, available: { for: [debugging_app] }, zh: 隐藏, en: Hidden }
tables:
  settings: { zh: 设置表, en: Settings, row: Setting, rows: [{ mood: 1, hidden: 4 }, { mood: 2 }, { mood: 3 }] }
conflicts:
  C900: { category: fields, severity: low, zh: 探测不明, en: Probing is unclear }
  C901: { category: fields, severity: low, zh: 都不明, en: Both are unclear }
"#;

fn model() -> Model {
    let good = ["protocol.yaml", "commands/demo.yaml"].map(|path| {
        let place = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("tests/good")
            .join(path);
        let text = std::fs::read_to_string(place).expect("good");
        // A spec has only one list of stores, so `MORE` cannot add one.
        let stores = "\nstores:\n  lab: { zh: 实验室, en: Laboratory }\n";
        (format!("spec/{path}"), text.replace("\nstores:\n", stores))
    });
    let more = ("spec/commands/more.yaml".to_owned(), MORE.to_owned());
    let sources = Sources::from_texts(good.into_iter().chain([more]));
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    model.unwrap_or_else(|| panic!("{}", render(&faults, &sources, Format::Text, Lang::En)))
}

fn part(audience: &str) -> Model {
    model().for_audience(audience).expect("a part")
}

fn json(model: &Model) -> String {
    serde_json::to_string(&Dump::from(model)).expect("JSON")
}

fn fields(model: &Model, ty: &str) -> Vec<String> {
    match model.types.named(ty).map(|ty| &ty.shape) {
        Some(TypeShape::Struct(shape)) => shape.fields.iter().map(|it| it.wire.clone()).collect(),
        other => panic!("{ty}: {other:?}"),
    }
}

#[test]
fn projection_removes_other_parts_and_their_types() {
    let model = part("product_app");
    let operations: Vec<&str> = model.operations.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(
        operations,
        [
            "get_thing",
            "thing_moved",
            "thing_picture",
            "ask",
            "offer",
            "heard",
            "noise"
        ]
    );
    for gone in [
        "Extra",
        "Deep",
        "Found",
        "ProbeRequest",
        "ProbeResponse",
        "AskRequestWayProbe",
    ] {
        assert!(model.types.named(gone).is_none(), "{gone}");
    }
    // `why` is gone too: it is sent only with a value of the other audience.
    let body = [
        "job", "mood", "sane", "plain", "moods", "tone", "whole", "way",
    ];
    assert_eq!(fields(&model, "AskRequest"), body);
    assert_eq!(fields(&model, "AskRequestWhole"), ["mood"]);
    assert_eq!(fields(&model, "Setting"), ["mood"]);
    let Some(TypeShape::Enum(mood)) = model.types.named("Mood").map(|ty| &ty.shape) else {
        panic!("an enum");
    };
    let states = mood
        .values
        .iter()
        .map(|it| (it.name.as_str(), it.then.join(" ")));
    let states: Vec<_> = states.collect();
    assert_eq!(
        states,
        [("calm", "glad".to_owned()), ("glad", String::new())]
    );
}

#[test]
fn projection_leaves_no_dangling_name() {
    let model = part("product_app");
    let ask = model.operation("ask").expect("it is for all");
    let keys = |path: &[String]| path.join(".");
    let ties = ask.sets_off().iter().map(|it| {
        let ties = it.tied.iter();
        let ties = ties.map(|tie| (keys(&tie.command), keys(&tie.report)));
        (it.report.as_str(), ties.collect())
    });
    let ties: Vec<(&str, Vec<_>)> = ties.collect();
    assert_eq!(
        ties,
        [("heard", vec![("job".to_owned(), "job".to_owned())])]
    );
    let accepted = ask.accepted().expect("something is left of it");
    assert_eq!(accepted.after, [""; 0]);
    let sets = accepted.state_sets().iter();
    let values: Vec<_> = sets.flat_map(|set| &set.values).collect();
    assert_eq!(values, [&Scalar::Number(Number::Int(1))]);
    let heard = model.operation("heard").expect("it is for all");
    assert_eq!(heard.cadence(), None);
    let noise = model.operation("noise").and_then(|it| it.stream());
    let noise = noise.expect("it is for all");
    assert_eq!(noise.commands().collect::<Vec<_>>(), ["ask"]);
    let deprecated = ask.deprecated.as_ref().expect("it is withdrawn");
    assert_eq!(deprecated.replaced_by, None);
    let Some(TypeShape::Struct(body)) = model.types.named("AskRequest").map(|ty| &ty.shape) else {
        panic!("a struct");
    };
    let field = |key: &str| {
        body.fields
            .iter()
            .find(|it| it.wire == key)
            .expect("a field")
    };
    for (key, example) in [
        ("mood", Example::Derived),
        ("moods", Example::Derived),
        ("way", Example::Derived),
        (
            "whole",
            Example::Given(Value::Object(vec![(
                "mood".to_owned(),
                Value::Number(Number::Int(1)),
            )])),
        ),
    ] {
        assert_eq!(field(key).example, example, "{key}");
    }
    assert_eq!(field("sane").details().condition, None);
    let asked = Asked {
        wire: "mood".to_owned(),
        values: vec![Scalar::Number(Number::Int(1))],
    };
    let plain = Some(Condition::When(vec![asked]));
    assert_eq!(field("plain").details().condition, plain);
    let tone = field("tone").details();
    assert_eq!(tone.constraints.only, [Scalar::Number(Number::Int(1))]);
    assert_eq!(tone.default, None);
    let rows = model
        .tables
        .iter()
        .find(|it| it.id == "settings")
        .map(|it| it.rows.clone());
    let row =
        |mood: i128| Value::Object(vec![("mood".to_owned(), Value::Number(Number::Int(mood)))]);
    assert_eq!(rows, Some(vec![row(1), row(3)]));
    // C900 is gone, because only an operation of the other audience asks it.
    let conflicts: Vec<&str> = model.conflicts.iter().map(|it| it.id.as_str()).collect();
    assert_eq!(conflicts, ["C001", "C901"]);
    assert!(
        model
            .questions
            .iter()
            .all(|it| !it.ids.contains(&"C900".to_owned()))
    );
    let read = Dump::read(&json(&model)).expect("a whole model");
    assert_eq!(json(&read), json(&model));
}

/// A code that the other audience uses is not free.
#[test]
fn codes_of_others_stay_taken() {
    let whole = model();
    for audience in ["product_app", "debugging_app"] {
        let part = whole.for_audience(audience).expect("a part");
        assert_eq!(part.taken_codes(), whole.taken_codes());
    }
    let retired: Vec<u16> = part("product_app")
        .retired
        .iter()
        .map(|it| it.code)
        .collect();
    assert_eq!(retired, [0x0103, 0x0199, 0x0203]);
}

#[test]
fn a_part_of_a_part_is_their_intersection() {
    let both = part("product_app")
        .for_audience("debugging_app")
        .expect("both");
    let names = ["ask", "offer", "probe"];
    let there = names.map(|name| both.operation(name).is_some());
    assert_eq!(there, [true, false, false]);
    let once = part("product_app");
    let twice = once.for_audience("product_app").expect("the same");
    assert_eq!(json(&twice), json(&once));
}

#[test]
fn an_audience_that_is_not_declared_is_refused() {
    let error = model().for_audience("produkt_app").expect_err("a slip");
    assert!(matches!(error, ProjectionError::Unknown { .. }));
    assert_eq!(
        error.to_string(),
        "there is no audience `produkt_app`; the spec declares `product_app`, `debugging_app`"
    );
}
