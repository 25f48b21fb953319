//! The documented schemas accept the existing files. Runner and schema reject the same mistakes.

use super::script::{File, Level, folder, json_files};
use crate::json_schema::Validator;
use serde_json::{Value, json};
use std::fs;

fn schema(name: &str) -> Value {
    let text = fs::read_to_string(folder().join(name)).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Returns `true` if a value fits the schema or one of its definitions.
fn fits(schema: &Value, definition: Option<&str>, value: &Value) -> bool {
    let part = match definition {
        Some(name) => &schema["$defs"][name],
        None => schema,
    };
    Validator { root: schema }.accepts(part, value)
}

#[fc_test::test]
fn every_script_fits_its_schema() {
    let schema = schema("session.schema.json");
    for (path, text) in json_files(&folder().join("sessions")) {
        let file: Value = serde_json::from_str(&text).unwrap();
        if fits(&schema, None, &file) {
            continue;
        }
        let path = path.display();
        for script in file["scripts"].as_array().expect("scripts") {
            for step in script["steps"].as_array().expect("steps") {
                assert!(
                    fits(&schema, Some("step"), step),
                    "{path}: {}: {step}",
                    script["name"]
                );
            }
            assert!(
                fits(&schema, Some("script"), script),
                "{path}: {}",
                script["name"]
            );
        }
        panic!("{path}: the keys around the scripts");
    }
}

#[fc_test::test]
fn every_vector_fits_its_schema() {
    let schema = schema("vectors.schema.json");
    let packages = ["vectors", "tests/meter/vectors", "tests/beacon/vectors"];
    let files = packages.map(|of| json_files(&folder().join("../fc-generated").join(of)));
    assert!(files.iter().all(|files| !files.is_empty()));
    for (path, text) in files.into_iter().flatten() {
        let file: Value = serde_json::from_str(&text).unwrap();
        assert!(fits(&schema, None, &file), "{}", path.display());
        for list in ["accepted", "rejected"] {
            let mut worse = file.clone();
            // Undocumented keys are rejected.
            if let Some(entry) = worse[list].get_mut(0) {
                entry["note"] = json!("x");
                assert!(!fits(&schema, None, &worse), "{}: {list}", path.display());
            }
        }
    }
}

/// A file of one script with this step.
fn file(step: &Value) -> Value {
    json!({
        "$schema": "../session.schema.json",
        "format": 1,
        "subject": "x",
        "level": "session",
        "scripts": [{
            "name": "x",
            "demands": "X because of y.",
            "given": { "side": "app", "first_id": 1 },
            "steps": [step],
        }],
    })
}

/// Returns `true` if the runner accepts it.
fn reads(file: &Value) -> bool {
    let file = serde_json::from_value::<File>(file.clone());
    file.is_ok_and(|file| file.scripts[0].steps[0].action().is_ok())
}

#[fc_test::test]
fn mistakes_are_refused_by_schema_and_runner() {
    let schema = schema("session.schema.json");
    let good = [
        json!({ "advance": 1 }),
        json!({ "call": { "as": "a", "code": 1 }, "expect": ["late", { "sends": { "as": "a" } }] }),
        json!({ "lose": {}, "then": { "next_due": null } }),
        json!({ "repeat": { "times": 2, "steps": [{ "reconnect": {} }] } }),
    ];
    for step in good {
        let file = file(&step);
        assert!(fits(&schema, None, &file) && reads(&file), "{file}");
    }
    let bad = [
        json!({}),
        json!({ "expect": [] }),
        json!({ "advance": 1, "reconnect": {} }),
        json!({ "advance": -1 }),
        json!({ "advance": "1" }),
        json!({ "wait": 1 }),
        json!({ "advance": 1, "expects": [] }),
        json!({ "advance": 1, "expect": ["answered"] }),
        json!({ "advance": 1, "expect": [{ "sends": "a" }] }),
        json!({ "advance": 1, "expect": [{ "sends": { "as": "a", "code": 1 } }] }),
        json!({ "advance": 1, "then": { "due": 1 } }),
        json!({ "call": { "code": 1 } }),
        json!({ "call": { "as": "a", "code": 65536 } }),
        json!({ "call": { "as": "a", "code": 1, "id": 1 } }),
        json!({ "receive": { "kind": "answer", "code": 1, "id": 1 } }),
        json!({ "receive": { "answer_to": "a", "result": "ok" } }),
        json!({ "reconnect": { "after": 1 } }),
        json!({ "repeat": { "steps": [{ "reconnect": {} }] } }),
        json!({ "repeat": { "times": 2, "steps": [{ "wait": 1 }] } }),
    ];
    for step in bad {
        let file = file(&step);
        assert!(!fits(&schema, None, &file), "the schema takes {file}");
        assert!(!reads(&file), "the runner takes {file}");
    }
    let mut around = file(&json!({ "advance": 1 }));
    around["scripts"][0]["given"]["speed"] = json!(1);
    assert!(!fits(&schema, None, &around) && !reads(&around));
    let mut around = file(&json!({ "advance": 1 }));
    around["scripts"][0]["given"]["id_bits"] = json!(16);
    assert!(fits(&schema, None, &around) && reads(&around));
    around["scripts"][0]["given"]["id_bits"] = json!(8);
    assert!(!fits(&schema, None, &around) && !reads(&around));
    let mut around = file(&json!({ "advance": 1 }));
    around["scripts"][0]["why"] = json!("y");
    assert!(!fits(&schema, None, &around) && !reads(&around));
}

#[fc_test::test]
fn a_peer_has_ids_of_its_protocol() {
    let mut narrow = file(&json!({ "advance": 1 }));
    narrow["scripts"][0]["given"]["id_bits"] = json!(16);
    let narrow: File = serde_json::from_value(narrow).unwrap();
    let script = &narrow.scripts[0];
    assert!(script.check(Level::Session).is_ok() && script.check(Level::Peer).is_err());
}

#[fc_test::test]
fn key_without_meaning_at_its_level_is_refused() {
    let of_peers = [
        json!({ "call": { "as": "a", "code": 1, "repeat": true } }),
        json!({ "report": { "as": "a", "code": 1, "repeat": true } }),
        json!({ "receive": { "answer_to": "a", "result": "success" } }),
        json!({ "receive": { "answer_to": "a", "broken": true } }),
    ];
    let of_sessions = [
        json!({ "call": { "as": "a", "code": 1, "retries": 1 } }),
        json!({ "report": { "as": "a", "code": 1, "timeout": 1 } }),
        json!({ "report": { "as": "a", "code": 1, "retries": 1 } }),
        json!({ "lose": { "keeps": ["a"] } }),
    ];
    for (steps, takes, refuses) in [
        (of_peers, Level::Peer, Level::Session),
        (of_sessions, Level::Session, Level::Peer),
    ] {
        for step in steps {
            let inside = json!({ "repeat": { "times": 1, "steps": [step] } });
            for step in [step, inside] {
                let file: File = serde_json::from_value(file(&step)).unwrap();
                let script = &file.scripts[0];
                let takes = script.check(takes).is_ok();
                assert!(takes && script.check(refuses).is_err(), "{step}");
            }
        }
    }
}
