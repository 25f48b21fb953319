//! `fcproto lint` and `fcproto check --fix`.

use crate::support::{Project, Run};
use serde_json::Value;

/// Creates a project with one finding of a house rule. Built-in rules are off.
fn project() -> Project {
    let project = Project::new();
    project.write(
        "fc.yaml",
        "lint:
  levels: { STANDARD: 'off', DOCS: 'off', SUNSET: 'off' }
  house:
    - id: no-commands
      zh: 不要指令
      en: There is a command
      for: command
      where: { name: PLACE }
      require: { name: absent }
",
    );
    let dump: Value =
        serde_json::from_str(&project.fc(&["inspect"]).expect(0).stdout).expect("JSON");
    let operations = dump["operations"].as_array().expect("operations");
    let command = operations.iter().find(|it| it["kind"] == "command");
    let name = command.expect("a command")["name"]
        .as_str()
        .expect("a name")
        .to_owned();
    project.write("fc.yaml", &project.read("fc.yaml").replace("PLACE", &name));
    project
}

fn level(project: &Project, level: &str) {
    let yaml = project.read("fc.yaml");
    project.write(
        "fc.yaml",
        &yaml.replace(
            "for: command",
            &format!("level: {level}\n      for: command"),
        ),
    );
}

/// Returns the ID of the only finding.
fn id(run: &Run) -> String {
    let start = run.stderr.find("FC0890-").expect("an id");
    run.stderr[start..]
        .chars()
        .take("FC0890-1a2b3c4d5e6f".len())
        .collect()
}

#[test]
fn findings_are_shown_with_their_places() {
    let project = project();
    let run = project.fc(&["lint"]).expect(0);
    for part in [
        "warning[FC0890]: There is a command (no-commands)",
        "--> spec/commands/",
        "FC0890-",
    ] {
        assert!(run.stderr.contains(part), "{part:?} in {run:#?}");
    }
    let run = project.fc(&["lint", "--lang", "zh"]).expect(0);
    assert!(run.stderr.contains("不要指令"), "{run:#?}");
    let run = project.fc(&["lint", "--format", "json"]).expect(0);
    let line: Value = serde_json::from_str(run.stdout.trim()).expect("one line of JSON");
    assert_eq!(line["code"], "FC0890");
    let run = project.fc(&["lint", "--format", "sarif"]).expect(0);
    let log: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(log["runs"][0]["results"][0]["ruleId"], "FC0890");
    let run = project.fc(&["lint", "--format", "github"]).expect(0);
    assert!(
        run.stdout.starts_with("::warning file=spec/commands/"),
        "{run:#?}"
    );
}

#[test]
fn errors_and_denied_warnings_fail() {
    let project = project();
    project.fc(&["lint", "--deny", "warnings"]).expect(1);
    level(&project, "error");
    let run = project.fc(&["lint"]).expect(1);
    assert!(run.stderr.contains("error[FC0890]"), "{run:#?}");
    project.fc(&["lint", "--root", "nowhere"]).expect(2);
}

#[test]
fn lint_waiver_expires_and_diff_ignores_it() {
    let project = project();
    let id = id(&project.fc(&["lint"]).expect(0));
    let waivers =
        format!("\nwaivers:\n  {id}: {{ zh: 已知, en: Known, by: Owner, until: 2030-06 }}\n");
    project.append("spec/protocol.yaml", &waivers);
    project.fc(&["check"]).expect(0);
    let run = project
        .fc(&["lint", "--today", "2030-06-30", "--deny", "warnings"])
        .expect(0);
    assert!(run.stdout.contains("nothing found, 1 waived"), "{run:#?}");
    let run = project.fc(&["lint", "--today", "2030-07-01"]).expect(1);
    assert!(run.stderr.contains("FC0891"), "{run:#?}");
    let run = project
        .fc(&[
            "diff",
            ".",
            ".",
            "--format",
            "json",
            "--today",
            "2030-07-01",
        ])
        .expect(0);
    assert_eq!(run.stdout.trim(), "[]");
}

#[test]
fn invalid_settings_are_shown_with_their_place() {
    let project = project();
    level(&project, "eror");
    let run = project.fc(&["lint"]).expect(2);
    for part in [
        "error[FC0109]: `eror` is not allowed here",
        "--> fc.yaml:",
        "did you mean `error`?",
    ] {
        assert!(run.stderr.contains(part), "{part:?} in {run:#?}");
    }
    // Other commands that read the file ignore this error.
    project.fc(&["check"]).expect(0);
}

#[test]
fn a_spec_with_errors_is_not_linted() {
    let project = project();
    project.append("spec/types.yaml", "twice: 1\ntwice: 2\n");
    let run = project.fc(&["lint"]).expect(1);
    assert!(
        run.stderr.contains("FC0012") && !run.stderr.contains("FC0890"),
        "{run:#?}"
    );
}

#[test]
fn rules_are_explained_by_code_and_by_name() {
    let project = Project::empty();
    for word in ["FC0802", "802", "similar-keys"] {
        let run = project.fc(&["explain", word]).expect(0);
        assert!(run.stdout.starts_with("FC0802: "), "{run:#?}");
    }
    let run = project.fc(&["explain", "similar-kyes"]).expect(2);
    assert!(
        run.stderr.contains("did you mean `similar-keys`?"),
        "{run:#?}"
    );
    assert!(
        project
            .fc(&["explain"])
            .expect(0)
            .stdout
            .contains("FC0873  ")
    );
}

#[test]
fn certain_fixes_are_applied() {
    let project = Project::new();
    let good = project.read("spec/protocol.yaml");
    let broken = good.replacen("transport:", "transport：", 1);
    assert_ne!(good, broken);
    project.write("spec/protocol.yaml", &broken);
    project.fc(&["check"]).expect(1);

    let run = project.fc(&["check", "--fix", "--dry-run"]).expect(1);
    assert!(
        run.stdout.contains("-transport：\n+transport:\n"),
        "{run:#?}"
    );
    assert_eq!(project.read("spec/protocol.yaml"), broken);

    let run = project.fc(&["check", "--fix"]).expect(0);
    assert!(
        run.stdout.starts_with("fixed spec/protocol.yaml:"),
        "{run:#?}"
    );
    assert!(run.stdout.contains(" FC0024: "), "{run:#?}");
    assert_eq!(project.read("spec/protocol.yaml"), good);

    let run = project.fc(&["check", "--fix"]).expect(0);
    assert!(
        run.stdout.starts_with("no error has a certain fix"),
        "{run:#?}"
    );
    project.fc(&["check", "--dry-run"]).expect(2);
}
