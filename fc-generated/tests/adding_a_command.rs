//! Adding a command is eight lines of YAML and nothing else: everything that follows from them
//! appears with them and disappears with them.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    clippy::wildcard_imports,
    missing_docs,
    reason = "tests"
)]

mod support;

use fc_codegen::emit::{Artifact, generate};
use fc_codegen::model::{Model, RangeUse};
use fc_codegen::output::plan;
use std::collections::BTreeMap;
use std::fs;

#[test]
fn eight_lines_are_enough_and_leave_no_trace() {
    let project = tempfile::tempdir().unwrap();
    let root = project.path();
    support::copy(&support::root().join("spec"), &root.join("spec"));
    let model = support::model(root);
    let code = free_code(&model);
    let write = || {
        plan(generate(&support::model(root), &[]), root, &[])
            .unwrap()
            .write()
            .unwrap();
    };
    write();
    let before = support::tree(root);

    let file = root.join("spec/commands/recharge.yaml");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, with_command(&text, code)).unwrap();
    let artifacts = generate(&support::model(root), &[]);
    for (path, part) in [
        (
            "fc-generated/src/messages/recharge.rs",
            "pub struct GetBatteryRequest {",
        ),
        ("fc-generated/src/messages/recharge.rs", "pub level: u8,"),
        ("fc-generated/src/client.rs", "pub async fn get_battery("),
        ("fc-generated/src/robot.rs", "async fn get_battery("),
        (
            "fc-generated/src/descriptors.rs",
            "const GET_BATTERY: OperationInfo",
        ),
        (
            "fc-generated/src/each.rs",
            "get_battery GetBatteryRequest GetBatteryResponse;",
        ),
        ("fc-generated/vectors/get_battery.json", "\"accepted\""),
        ("docs-site/reference/commands/get_battery.md", "获取电量"),
        (
            "docs-site/en/reference/commands/get_battery.md",
            "Get the battery level",
        ),
        ("docs-site/reference/codes.md", &format!("0x{code:04X}")),
        ("docs-site/en/reference/codes.md", &format!("0x{code:04X}")),
    ] {
        let artifact = find(&artifacts, path);
        assert!(
            artifact.contents.contains(part),
            "{path} has no {part}:\n{}",
            artifact.contents
        );
    }
    write();
    assert_ne!(support::tree(root), before);

    fs::write(&file, text).unwrap();
    write();
    let after = support::tree(root);
    assert_eq!(changed(&before, &after), Vec::<&String>::new());
}

/// The spec's file with one command more.
fn with_command(text: &str, code: u16) -> String {
    let lines = [
        "  get_battery:",
        &format!("    code: 0x{code:04X}"),
        "    zh: 获取电量",
        "    en: Get the battery level",
        "    effect: read",
        "    source: { sections: [] }",
        "    response:",
        "      level: { type: u8, max: 100, unit: \"%\", example: 80, zh: 电量, en: Battery level }",
    ];
    let (head, tail) = text
        .split_once("commands:\n")
        .expect("the file has commands");
    format!("{head}commands:\n{}\n{tail}", lines.join("\n"))
}

/// A code in the range of new commands that nobody has.
fn free_code(model: &Model) -> u16 {
    let mut ranges = model
        .ranges
        .iter()
        .filter(|range| range.usage == RangeUse::Commands);
    let range = ranges.next().expect("new commands have a range");
    let taken = |code: &u16| {
        model
            .operations
            .iter()
            .any(|operation| operation.code.value == Some(*code))
            || model.retired.iter().any(|retired| retired.code == *code)
    };
    (range.first..=range.last)
        .find(|code| !taken(code))
        .expect("the range is not full")
}

fn find<'a>(artifacts: &'a [Artifact], path: &str) -> &'a Artifact {
    let found = artifacts.iter().find(|artifact| artifact.path == path);
    found.unwrap_or_else(|| panic!("{path} is not made"))
}

fn changed<'a>(
    before: &'a BTreeMap<String, Vec<u8>>,
    after: &'a BTreeMap<String, Vec<u8>>,
) -> Vec<&'a String> {
    let paths = before.keys().chain(after.keys());
    paths
        .filter(|path| before.get(*path) != after.get(*path))
        .collect()
}
