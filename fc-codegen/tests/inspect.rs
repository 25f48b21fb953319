//! What `fc inspect` tells of the small good spec.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "tests"
)]

#[path = "../../fc-spec/tests/good_spec/mod.rs"]
mod good_spec;
#[path = "../../fc-spec/tests/json_schema/mod.rs"]
mod json_schema;

use fc_codegen::emit::generate;
use fc_codegen::inspect;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::Faults;
use fc_spec::load::load;
use fc_spec::model::{Dump, DumpError, Model, Value};
use fc_spec::syntax::read_dir;
use json_schema::Validator;
use std::path::Path;

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

/// In one line and in an order that does not depend on how they are written.
fn sorted(words: &str) -> String {
    let mut words: Vec<_> = words.split_whitespace().collect();
    words.sort_unstable();
    words.join(" ")
}

/// The keys that the documentation of the format promises, wherever they stand.
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
            "format protocol groups operations types result_codes ranges retired_codes tables entities availability coordinates stores glossary conflicts answers \
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
        sorted("from to from_spelling to_spelling use zh en next")
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
        serde_json::json!({ "when": [
            { "path": "pace", "values": [4, 5] },
            { "path": "sudden", "values": [0] },
        ] })
    );
    assert_eq!(
        said("blink"),
        serde_json::json!({ "unless": [{ "path": "pace", "values": [0, 4] }] })
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

/// The model of a project of this repository.
fn model_in(project: &str) -> Model {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(project);
    let mut faults = Faults::new();
    let sources = read_dir(&root, Path::new("spec"), &mut faults);
    load(&sources, &mut faults).model().expect("a sound spec")
}

/// Byte for byte, for protocols with other headers, names and orders of bytes.
#[test]
fn what_is_made_of_a_dump_is_what_is_made_of_the_spec() {
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
    }
}

#[test]
fn a_dump_fits_its_schema() {
    let schema: serde_json::Value =
        serde_json::from_str(&fc_spec::schema::dump()).expect("a schema");
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

#[test]
fn what_is_no_dump_is_refused_with_a_reason() {
    let text = inspect::json(&good_spec::model());
    let refused = |text: &str| {
        Dump::read(text)
            .err()
            .map_or_else(String::new, |error| error.to_string())
    };
    assert!(refused("[]").starts_with("not a dump of `fc inspect`: "));
    assert!(refused(&text[..text.len() / 2]).contains("EOF while parsing"));
    let other = text.replacen("\"format\": 2", "\"format\": 1", 1);
    assert!(matches!(Dump::read(&other), Err(DumpError::Format(1))));
    let unknown = text.replace("\"type\": \"Color\"", "\"type\": \"Colour\"");
    assert_eq!(
        refused(&unknown),
        "`GetThingResponseData.color` names the type `Colour`, which is not in the dump"
    );
    let mut dump: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let types = dump["types"].as_array_mut().expect("types");
    let color = types.iter_mut().find(|ty| ty["name"] == "Color");
    color.expect("an enum")["values"][1]["then"] = serde_json::json!(["red", "blue"]);
    assert_eq!(
        refused(&dump.to_string()),
        "`Color.green` names the value `blue`, which is not in the dump"
    );
    let mut dump: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    dump["operations"][0]["sets_off"] = serde_json::json!([
        { "report": "thing_moved", "tied": [] },
        { "report": "get_thing", "tied": [] },
    ]);
    assert_eq!(
        refused(&dump.to_string()),
        "`get_thing` names the report `get_thing`, which is not in the dump"
    );
    for (precondition, missing) in [
        (
            serde_json::json!({ "in": null, "after": ["get_thing", "thing_moved"], "note": null }),
            "command `thing_moved`",
        ),
        (
            serde_json::json!({ "in": { "states": [{ "type": "Colour", "values": [0] }] }, "after": [], "note": null }),
            "type `Colour`",
        ),
    ] {
        let mut dump: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        dump["operations"][0]["accepted"] = precondition;
        assert_eq!(
            refused(&dump.to_string()),
            format!("`get_thing` names the {missing}, which is not in the dump")
        );
    }
    for key in ["started_by", "stopped_by"] {
        let mut dump: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let operations = dump["operations"].as_array_mut().expect("operations");
        let mut operations = operations.iter_mut();
        let stream = operations.find(|it| it["name"] == "thing_picture");
        stream.expect("a stream")[key] = "thing_moved".into();
        assert_eq!(
            refused(&dump.to_string()),
            "`thing_picture` names the command `thing_moved`, which is not in the dump"
        );
    }
    let tied = |command: &str, report: &str| {
        let mut dump: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let tie =
            serde_json::json!({ "side": "request", "command": [command], "report": [report] });
        dump["operations"][0]["sets_off"] =
            serde_json::json!([{ "report": "thing_moved", "tied": [tie] }]);
        refused(&dump.to_string())
    };
    assert_eq!(tied("thingId", "thingId"), "");
    for refusal in [tied("id", "thingId"), tied("thingId", "id")] {
        assert_eq!(
            refusal,
            "`get_thing` names the key `id`, which is not in the dump"
        );
    }
    for user in ["GetThingResponse", "get_thing"] {
        let mut dump: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let lists = ["types", "operations"].map(|list| format!("/{list}"));
        for list in lists {
            let items = dump.pointer_mut(&list).and_then(|it| it.as_array_mut());
            for item in items
                .expect("a list")
                .iter_mut()
                .filter(|it| it["name"] == user)
            {
                item["group"] = "nowhere".into();
            }
        }
        let expected = format!("`{user}` names the group `nowhere`, which is not in the dump");
        assert_eq!(refused(&dump.to_string()), expected);
    }
    let nothing = text.replace("\"refers\": \"thing\"", "\"refers\": \"nothing\"");
    assert_eq!(
        refused(&nothing),
        "`ThingMoved.thingId` names the entity `nothing`, which is not in the dump"
    );
    let nowhere = text.replace("\"kept\": \"config_file\"", "\"kept\": \"nowhere\"");
    assert_eq!(
        refused(&nowhere),
        "`Size.depth` names the store `nowhere`, which is not in the dump"
    );
    let nowhere = text.replace("\"coordinates\": \"plan\"", "\"coordinates\": \"nowhere\"");
    assert_eq!(
        refused(&nowhere),
        "`Size` names the coordinate system `nowhere`, which is not in the dump"
    );
    for (word, other, missing) in [
        ("debugging_app", "nobody", "the audience `nobody`"),
        (
            "second_generation",
            "hovercraft",
            "the hardware `hovercraft`",
        ),
        ("adp", "bdp", "the releases `bdp`"),
    ] {
        let declared = format!("\"name\": \"{word}\"");
        let renamed = text.replace(&declared, "\"name\": \"another\"");
        let renamed = renamed.replace(&format!("\"{word}\""), &format!("\"{other}\""));
        assert_eq!(
            refused(&renamed),
            format!("`GetThingResponseData.y` names {missing}, which is not in the dump")
        );
    }
    let role = text.replacen("\"role\": \"digest\"", "\"role\": \"hash\"", 1);
    assert!(refused(&role).contains("unknown variant `hash`"));
}

/// For whom a thing is, as the documentation of the format says it; and what one audience has of it all.
#[test]
fn a_dump_says_for_whom_things_are() {
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
    let expected = serde_json::json!({
        "for": ["debugging_app"], "hardware": ["second_generation"], "from": { "adp": "3.8" }, "until": {},
    });
    assert_eq!(limit("data.y"), expected);
    assert_eq!(limit("data.x"), serde_json::Value::Null);
    let part = model.for_audience("product_app").expect("a part");
    let part: serde_json::Value = serde_json::from_str(&inspect::json(&part)).expect("JSON");
    let has = |dump| fields(dump).iter().any(|it| it["path"] == "data.y");
    assert!(has(&dump) && !has(&part));
}
