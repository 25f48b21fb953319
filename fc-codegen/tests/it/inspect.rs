//! The output of `fcproto inspect` for the small good spec.

mod refused;

use crate::good_spec;
use crate::json_schema::Validator;
use fc_codegen::emit::generate;
use fc_codegen::inspect;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::Faults;
use fc_spec::load::load;
use fc_spec::model::{Dump, Model, Value};
use fc_spec::syntax::read_dir;
use serde_json::json;
use std::path::Path;

/// Path, type, optional or not, form on the wire, example.
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

/// Joins the words in sorted order, so that their order in the source does not matter.
fn sorted(words: &str) -> String {
    let mut words: Vec<_> = words.split_whitespace().collect();
    words.sort_unstable();
    words.join(" ")
}

/// The dump has the keys that the documentation of the format promises.
#[test]
fn a_dump_has_its_documented_keys() {
    let dump = inspect::value(&good_spec::model());
    let keys = |value: Option<&Value>| match value {
        Some(Value::Object(entries)) => {
            let keys: Vec<_> = entries.iter().map(|(key, _)| key.as_str()).collect();
            sorted(&keys.join(" "))
        }
        other => panic!("no object: {other:?}"),
    };
    let first = |key: &str| match dump.get(key) {
        Some(Value::Array(items)) => items.first(),
        other => panic!("{key}: {other:?}"),
    };
    assert_eq!(
        keys(Some(&dump)),
        sorted(
            "format protocol groups operations types result_codes ranges retired_codes tables entities availability coordinates stores glossary waivers conflicts answers \
         lost_sections changes open_questions questions"
        )
    );
    assert_eq!(
        keys(first("operations")),
        sorted(
            "name kind kind_state title_state sender code code_spelling code_state group zh en aliases about effect effect_state sets_off state failures accepted cadence kept \
         port_role sections lost since available deprecated changes request response ack content started_by stopped_by result_text errors place port"
        )
    );
    assert_eq!(
        keys(
            match first("operations").and_then(|operation| operation.get("errors")) {
                Some(Value::Array(errors)) => errors.first(),
                _ => None,
            }
        ),
        sorted("code cause")
    );
    assert_eq!(
        keys(first("operations").and_then(|operation| operation.get("request"))),
        sorted("state note type fields")
    );
    assert_eq!(
        keys(first("open_questions")),
        sorted("id severity category kind subject zh en gap place answers")
    );
    assert_eq!(
        keys(first("ranges")),
        sorted("from to from_spelling to_spelling use groups zh en next")
    );
    assert_eq!(
        keys(first("result_codes")),
        sorted("code name role zh en about")
    );
    assert_eq!(keys(first("entities")), sorted("name zh en place"));
    assert_eq!(keys(first("coordinates")), sorted("name zh en about place"));
    assert_eq!(
        keys(first("stores")),
        sorted("name zh en about survives_restart place")
    );
    assert_eq!(
        keys(first("tables")),
        sorted("id zh en about row rows kept place")
    );
    let availability = dump.get("availability");
    assert_eq!(keys(availability), sorted("audiences hardware releases"));
    for part in ["audiences", "hardware", "releases"] {
        let Some(Value::Array(declared)) = availability.and_then(|all| all.get(part)) else {
            panic!("{part}");
        };
        assert_eq!(keys(declared.first()), sorted("name zh en place"));
    }
    assert_eq!(keys(first("glossary")), sorted("id zh en means also place"));
    assert_eq!(
        keys(first("types")),
        sorted("name group zh en about kind fields state coordinates body_of since changes place")
    );
    let Some(Value::Array(types)) = dump.get("types") else {
        panic!("no types");
    };
    let values = types.iter().find_map(|ty| ty.get("values").zip(Some(ty)));
    let Some((Value::Array(values), choice)) = values else {
        panic!("no enum");
    };
    assert_eq!(
        keys(Some(choice)),
        sorted("name group zh en about kind repr closed order values body_of since changes place")
    );
    assert_eq!(
        keys(values.first()),
        sorted("value name start then final error zh en since available")
    );
}

#[test]
fn a_dump_says_when_a_field_is_there() {
    let dump = inspect::value(&model_in("fc-codegen/tests/docs"));
    let dump: serde_json::Value = serde_json::from_str(&dump.to_string()).expect("JSON");
    let operations = dump["operations"].as_array().expect("operations");
    let report = operations.iter().find(|it| it["name"] == "level_changed");
    let fields = report.expect("the report")["request"]["fields"].clone();
    let said = |path: &str| {
        let fields = fields.as_array().expect("fields");
        let field = fields.iter().find(|field| field["path"] == path);
        field.expect(path)["condition"].clone()
    };
    assert_eq!(said("pace"), serde_json::Value::Null);
    assert_eq!(
        said("rest"),
        json!({ "when": [
            { "path": "pace", "values": [4, 5] },
            { "path": "sudden", "values": [0] },
        ] })
    );
    assert_eq!(
        said("blink"),
        json!({ "unless": [{ "path": "pace", "values": [0, 4] }] })
    );
    let mut broken = dump;
    let types = broken["types"].as_array_mut().expect("types");
    let ty = types.iter_mut().find(|ty| ty["name"] == "LevelChanged");
    let fields = ty.expect("the body")["fields"].as_array_mut();
    let rest = fields
        .expect("fields")
        .iter_mut()
        .find(|field| field["path"] == "rest");
    rest.expect("the field")["condition"]["when"][0]["path"] = "rate".into();
    let refused = Dump::read(&broken.to_string())
        .err()
        .map(|error| error.to_string());
    assert_eq!(
        refused.as_deref(),
        Some("`LevelChanged.rest` names the field `rate`, which is not in the dump")
    );
}

#[test]
fn a_dump_is_json() {
    let model = good_spec::model();
    let text = inspect::json(&model);
    let parsed: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(parsed["format"], Dump::FORMAT);
    assert_eq!(parsed["ranges"][0]["next"], 0x019A);
    assert!(text.ends_with("}\n"));
}

/// Returns the model of a project in this repository.
fn model_in(project: &str) -> Model {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(project);
    let mut faults = Faults::new();
    let sources = read_dir(&root, Path::new("spec"), &mut faults);
    load(&sources, &mut faults).model().expect("a sound spec")
}

/// The dump and the spec generate the same bytes, also for protocols with other headers, names and byte orders.
#[test]
fn dump_and_spec_generate_the_same() {
    for model in [
        good_spec::model(),
        model_in("."),
        model_in("fc-generated/tests/odd"),
        model_in("fc-generated/tests/meter"),
        model_in("fc-generated/tests/beacon"),
        model_in("fc-codegen/tests/docs"),
    ] {
        let text = inspect::json(&model);
        let read = Dump::read(&text).expect("a dump");
        let targets = Targets::default();
        assert!(
            generate(&read, &targets).expect("made") == generate(&model, &targets).expect("made")
        );
        assert!(inspect::json(&read) == text);
        let kept = Dump::read(&inspect::release_dump(&model)).expect("a dump");
        assert!(inspect::json(&kept) == text);
    }
}

#[test]
fn a_dump_fits_its_schema() {
    let schema: serde_json::Value =
        serde_json::from_str(&fc_spec::model::Dump::schema()).expect("a schema");
    let validator = Validator { root: &schema };
    for model in [good_spec::model(), model_in(".")] {
        let mut dump: serde_json::Value =
            serde_json::from_str(&inspect::json(&model)).expect("JSON");
        assert!(validator.accepts(&schema, &dump));
        for (at, wrong) in [
            ("/format", "1".into()),
            ("/operations/0/kind", "order".into()),
            ("/operations/0/request/state", serde_json::Value::Null),
            ("/protocol/frame/header/0/type", 2.into()),
            ("/types/0/kind", "record".into()),
            ("/ranges/0/from", 65536.into()),
        ] {
            let right = std::mem::replace(dump.pointer_mut(at).expect(at), wrong);
            assert!(!validator.accepts(&schema, &dump), "{at}");
            *dump.pointer_mut(at).expect(at) = right;
        }
        let groups = dump.as_object_mut().and_then(|dump| dump.remove("groups"));
        assert!(groups.is_some() && !validator.accepts(&schema, &dump));
    }
}

#[test]
fn the_yaml_is_that_of_the_json() {
    let model = good_spec::model();
    let yaml: Value = serde_yaml::from_str(&inspect::yaml(&model)).expect("YAML");
    assert_eq!(yaml, inspect::value(&model));
}

/// Users keep dumps of old protocols. This one is from the start of the current format and must not be regenerated.
/// Additions to the format must be optional.
#[test]
fn a_kept_dump_of_this_format_is_read() {
    let kept = include_str!("../dumps/3.json");
    let model = Dump::read(kept).expect("what was a dump is one");
    assert_eq!(model.operations.len(), 3);
    assert!(Dump::read(&inspect::json(&model)).is_ok());
}

/// The dump has the audiences of each item as documented, and a dump for one audience has its part only.
#[test]
fn dump_has_the_audiences() {
    let model = good_spec::model();
    let dump = inspect::json(&model);
    let dump: serde_json::Value = serde_json::from_str(&dump).expect("JSON");
    let fields = |dump: &serde_json::Value| {
        let operations = dump["operations"].as_array().expect("a list");
        let operation = operations.iter().find(|it| it["name"] == "get_thing");
        let fields = operation.expect("it is there")["response"]["fields"].clone();
        fields.as_array().expect("a list").clone()
    };
    let limit = |key: &str| {
        let fields = fields(&dump);
        let field = fields.iter().find(|it| it["path"] == key);
        field.expect("it is there")["available"].clone()
    };
    let expected = json!({
        "for": ["debugging_app"], "hardware": ["second_generation"], "from": { "adp": "3.8" }, "until": {},
    });
    assert_eq!(limit("data.y"), expected);
    assert_eq!(limit("data.x"), serde_json::Value::Null);
    let part = model.for_audience("product_app").expect("a part");
    let part: serde_json::Value = serde_json::from_str(&inspect::json(&part)).expect("JSON");
    let has = |dump| fields(dump).iter().any(|it| it["path"] == "data.y");
    assert!(has(&dump) && !has(&part));
}
