//! `fcproto diff`.

use crate::support;
use crate::support::Project;
use serde_json::{Value, json};
use std::process::Command;

/// Small changes of a spec that an earlier version missed: the file, the old text, the new text and the rule.
const FLIPS: [(&str, &str, &str, &str); 8] = [
    (
        "protocol.yaml",
        "byte_order: little",
        "byte_order: big",
        "byte-order-changed",
    ),
    (
        "protocol.yaml",
        "number: 4000",
        "number: 4009",
        "port-number-changed",
    ),
    (
        "protocol.yaml",
        "  0: { name: fine",
        "  9: { name: fine",
        "result-code-changed",
    ),
    (
        "commands/lamp.yaml",
        "code: 0x0104",
        "code: 0x0108",
        "code-changed",
    ),
    (
        "commands/lamp.yaml",
        "        armed: {",
        "        harmed: {",
        "required-field-removed",
    ),
    (
        "commands/lamp.yaml",
        "rest: { type: \"u16?\"",
        "rest: { type: \"u32?\"",
        "integer-widened",
    ),
    (
        "types.yaml",
        "calm: { name: calm, zh",
        "calx: { name: calm, zh",
        "value-renumbered",
    ),
    (
        "protocol.yaml",
        "request: [0x51, 0x3E]",
        "request: [0x51, 0x3F]",
        "head-bytes-changed",
    ),
];

/// Creates the project of the documentation, with a copy of its spec in `old`.
fn project() -> Project {
    let project = Project::new();
    support::copy(&project.path("spec"), &project.path("old/spec"));
    project
}

fn change(project: &Project, file: &str, from: &str, to: &str) {
    let path = format!("spec/{file}");
    let text = project.read(&path);
    assert!(text.contains(from), "{from}");
    project.write(&path, &text.replace(from, to));
}

#[test]
fn changed_values_are_reported_with_the_broken_sides() {
    for (file, from, to, rule) in FLIPS {
        let project = project();
        change(&project, file, from, to);
        if rule == "value-renumbered" {
            change(
                &project,
                "commands/lamp.yaml",
                "Mood: [calm,",
                "Mood: [calx,",
            );
        }
        let run = project.fc(&["diff", "old", "--format", "json"]).expect(0);
        let found: Vec<Value> = serde_json::from_str(&run.stdout).expect("JSON");
        let found = found.iter().find(|it| it["rule"] == rule);
        let found = found.unwrap_or_else(|| panic!("{rule}: {run:#?}"));
        assert_ne!(found["wire"], json!([]), "{rule}");
        project.fc(&["diff", "old", "--fail-on", "wire"]).expect(1);
    }
}

#[test]
fn people_see_both_versions() {
    let project = project();
    change(
        &project,
        "commands/lamp.yaml",
        "code: 0x0104",
        "code: 0x0108",
    );
    change(
        &project,
        "protocol.yaml",
        "version: \"7\"",
        "version: \"8\"",
    );
    let run = project.fc(&["diff", "old", "."]).expect(0);
    let expected = "\
FC0717 probe: an operation has another code (0x0104 → 0x0108)
    breaks: old apps with new robots; new apps with old robots
    waiver: FC0717-193de5bdee5c
  - spec/commands/lamp.yaml:121: code: 0x0104
  + spec/commands/lamp.yaml:121: code: 0x0108
FC0700 protocol.version: a change that no rule judges (7 → 8)

2 changes from old to .: 1 on the wire, 0 in sources, 0 in behaviour
";
    assert_eq!(run.stdout, expected);
    let run = project.fc(&["diff", "old", ".", "--lang", "zh", "--format", "markdown"]);
    let expected = "\
| 规则 | 变更 | 影响 |
|---|---|---|
| FC0717 | probe：功能码变更（0x0104 → 0x0108） | 旧 app 配新机器人；新 app 配旧机器人 |
| FC0700 | protocol.version：没有规则评估的变更（7 → 8） |  |
";
    assert_eq!(run.expect(0).stdout, expected);
    let run = project
        .fc(&["diff", "old", ".", "--format", "github"])
        .expect(0);
    let first = "::warning file=spec/commands/lamp.yaml,line=120,title=FC0717::probe: an operation";
    assert!(run.stdout.starts_with(first), "{run:#?}");
    let run = project
        .fc(&["diff", "old", ".", "--format", "sarif"])
        .expect(0);
    let log: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let result = &log["runs"][0]["results"][0];
    assert_eq!(result["ruleId"], "FC0717");
    let place = &result["locations"][0]["physicalLocation"];
    assert_eq!(place["artifactLocation"]["uri"], "spec/commands/lamp.yaml");
}

#[test]
fn equal_specs_of_any_source_have_no_changes() {
    let project = project();
    for call in [
        &["diff", "old"][..],
        &["diff", "old/spec", "spec"],
        &["diff", "old", "--fail-on", "wire,source,behaviour"],
    ] {
        assert_eq!(
            project.fc(call).expect(0).stdout,
            "no changes\n",
            "{call:?}"
        );
    }
    let dump = project.fc(&["inspect"]).expect(0).stdout;
    project.write("old.json", &dump);
    assert_eq!(
        project.fc(&["diff", "old.json"]).expect(0).stdout,
        "no changes\n"
    );
}

#[test]
fn git_has_the_old_version() {
    let project = project();
    let git = |arguments: &[&str]| {
        let mut command = Command::new("git");
        let identity = ["-c", "user.name=a", "-c", "user.email=a@b"];
        command
            .args(identity)
            .args(arguments)
            .current_dir(project.path(""));
        let output = command.output().expect("git can be run");
        assert!(output.status.success(), "{output:?}");
    };
    git(&["init", "--quiet"]);
    git(&["add", "spec"]);
    git(&["commit", "--quiet", "--message", "first"]);
    assert_eq!(
        project.fc(&["diff", "git:HEAD"]).expect(0).stdout,
        "no changes\n"
    );
    change(&project, "protocol.yaml", "number: 4000", "number: 4009");
    let run = project
        .fc(&["diff", "git:HEAD", "--fail-on", "wire"])
        .expect(1);
    assert!(run.stdout.starts_with("FC0701 port.command"), "{run:#?}");
    let run = project.fc(&["diff", "git:nowhere"]).expect(2);
    assert!(
        run.stderr.contains("git cannot read `git:nowhere`"),
        "{run:#?}"
    );
    let run = project.fc(&["diff", "git:--all"]).expect(2);
    assert!(run.stderr.contains("such as git:main"), "{run:#?}");
}

#[test]
fn diff_names_versions_it_cannot_read() {
    let project = project();
    for (old, status, said) in [
        ("nowhere", 2, "cannot read `nowhere`"),
        ("spec/protocol.yaml", 2, "not a dump of `fcproto inspect`"),
        ("spec/commands", 2, "is not a directory with a spec"),
    ] {
        let run = project.fc(&["diff", old]).expect(status);
        assert!(run.stderr.contains(said), "{run:#?}");
    }
    change(
        &project,
        "protocol.yaml",
        "byte_order: little",
        "byte_order: middle",
    );
    let run = project.fc(&["diff", "old"]).expect(1);
    assert!(run.stderr.contains("the spec of `"), "{run:#?}");
    assert!(run.stderr.contains("protocol.yaml:29"), "{run:#?}");
}

#[test]
fn a_rule_is_explained_in_both_languages() {
    let project = Project::empty();
    for (lang, title, mark) in [
        (
            "en",
            "FC0731: a field has another key",
            "- Wire: breaks in both directions",
        ),
        ("zh", "FC0731：", "- 报文：两个方向都不兼容"),
    ] {
        let run = project.fc(&["explain", "FC0731", "--lang", lang]).expect(0);
        for part in [title, mark] {
            assert!(run.stdout.contains(part), "{run:#?}");
        }
    }
    let list = project.fc(&["explain"]).expect(0);
    assert!(list.stdout.contains("\nFC0764  "), "{list:#?}");
}
