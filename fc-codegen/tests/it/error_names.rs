//! The page about the wire names exactly the errors of `conformance/errors.json` that every implementation must have.

use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    fs::read_to_string(path).unwrap()
}

/// Returns the code spans of a line.
fn quoted(line: &str) -> impl Iterator<Item = String> {
    line.split('`').skip(1).step_by(2).map(str::to_owned)
}

#[test]
fn the_page_on_the_wire_names_the_errors_of_the_table() {
    let table: Value = serde_json::from_str(&read("../conformance/errors.json")).unwrap();
    let errors = table["errors"].as_array().unwrap().iter();
    let demanded = errors.filter(|error| error["where"] != "call" && error["own_limit"] != true);
    let demanded: BTreeSet<String> = demanded
        .map(|error| error["name"].as_str().unwrap().to_owned())
        .collect();
    let template = read("src/emit/markdown/templates/wire.md.j2");
    // The order of checks is a table. The first cell of a row is a number or the step counter of the template. One line
    // lists the errors of bodies.
    let is_check = |line: &str| {
        let first = line.strip_prefix("| ");
        first.is_some_and(|first| {
            first.starts_with(|first: char| first.is_ascii_digit()) || first.starts_with("{{ step")
        })
    };
    let lines = template
        .lines()
        .filter(|line| is_check(line) || line.contains("Body errors"));
    let named: BTreeSet<String> = lines.flat_map(quoted).collect();
    assert_eq!(named, demanded);
}
