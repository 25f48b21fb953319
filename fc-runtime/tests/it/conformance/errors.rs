//! `conformance/errors.json` lists the error names. The runtime has exactly these, and the golden frames use only
//! these.

use super::script::{folder, json_files};
use crate::tally::Tally;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Errors {
    format: u32,
    errors: Vec<Error>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Error {
    name: String,
    #[serde(rename = "where")]
    place: Place,
    /// Only for implementations with such a limit.
    #[serde(default)]
    own_limit: bool,
    zh: String,
    en: String,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
enum Place {
    Frame,
    Body,
    Call,
}

fn errors() -> Vec<Error> {
    let text = fs::read_to_string(folder().join("errors.json")).unwrap();
    let file: Errors = serde_json::from_str(&text).unwrap();
    assert_eq!(file.format, 1);
    file.errors
}

/// The names of a place.
fn listed(place: Place) -> BTreeSet<String> {
    let all = errors().into_iter().filter(|error| error.place == place);
    all.map(|error| error.name).collect()
}

/// The names that the function `name` of an enum gives: one for each variant, as the compiler makes sure.
fn given(source: &str, of: &str) -> BTreeSet<String> {
    let (_, rest) = source.split_once(&format!("impl {of} {{")).expect(of);
    let (_, rest) = rest.split_once("fn name(").expect("its names");
    let (names, _) = rest.split_once("\n    }\n").expect("their end");
    let quoted = |line: &str| {
        let (_, name) = line.split_once("=> \"")?;
        name.strip_suffix("\",").map(str::to_owned)
    };
    let arms = names.lines().filter(|line| line.contains("=>"));
    arms.map(|line| quoted(line).expect(line)).collect()
}

#[fc_test::test]
fn the_names_of_the_runtime_are_those_of_the_table() {
    let frame = include_str!("../../../src/frame/error.rs");
    let body = include_str!("../../../src/json/error.rs");
    let call = include_str!("../../../src/client/error.rs");
    for (place, source, of, kind) in [
        (Place::Frame, frame, "FrameError", "frame_errors"),
        (Place::Body, body, "BodyErrorKind", "body_errors"),
        (Place::Call, call, "CallError", "call_errors"),
    ] {
        let mut tally = Tally::of(kind);
        assert_eq!(given(source, of), listed(place));
        // Implementations need not have this limit.
        let shared = errors().into_iter().filter(|error| !error.own_limit);
        tally.held(shared.filter(|error| error.place == place).count());
    }
}

#[fc_test::test]
fn vectors_use_names_of_the_error_table() {
    let demanded = errors()
        .into_iter()
        .filter(|error| error.place != Place::Call && !error.own_limit);
    let known: BTreeSet<_> = demanded.map(|error| error.name).collect();
    let mut seen = BTreeSet::new();
    for (path, text) in json_files(&folder().join("../fc-generated/vectors")) {
        let file: Value = serde_json::from_str(&text).unwrap();
        for entry in file["rejected"].as_array().unwrap() {
            let name = entry["error"].as_str().unwrap();
            assert!(known.contains(name), "{}: {name}", path.display());
            seen.insert(name.to_owned());
        }
    }
    // These are errors of the frame format and of JSON, independent of the spec.
    for name in ["bad_head", "bad_digest", "bad_json", "wrong_type"] {
        assert!(seen.contains(name), "no vector is refused with {name}");
    }
}

#[fc_test::test]
fn each_error_is_listed_and_explained_once() {
    let mut names = BTreeSet::new();
    for error in errors() {
        assert!(
            names.insert(error.name.clone()),
            "{} is there twice",
            error.name
        );
        let is_chinese = error
            .zh
            .chars()
            .any(|c| ('\u{4E00}'..='\u{9FFF}').contains(&c));
        assert!(
            is_chinese && error.en.is_ascii() && !error.en.is_empty(),
            "{}",
            error.name
        );
    }
}
