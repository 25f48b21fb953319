//! `fc release`, and what stands on it: `fc diff` without a version, waivers, `fc changelog`, `fc generate --as-of`.

#![allow(clippy::expect_used, clippy::indexing_slicing, reason = "tests")]

mod support;

use serde_json::Value;
use support::Project;

const NEW: &str = "
  get_warmth:
    code: 0x0108
    zh: 查询色温
    en: Get the warmth
    effect: read
    source: { sections: [] }
    response:
      kelvin: { type: u16, example: 4000, zh: 色温, en: Colour temperature }
";

/// A project that has released version 7 of its spec.
fn released() -> Project {
    let project = Project::new();
    project
        .fc(&["release", "7", "--today", "2026-09-01"])
        .expect(0);
    project
}

fn change(project: &Project, file: &str, from: &str, to: &str) {
    let path = format!("spec/{file}");
    let text = project.read(&path);
    assert!(text.contains(from), "{from}");
    project.write(&path, &text.replacen(from, to, 1));
}

/// Puts a command behind the first group's `commands:`.
fn add_command(project: &Project) {
    change(
        project,
        "commands/lamp.yaml",
        "\ncommands:\n",
        &format!("\ncommands:{NEW}"),
    );
}

/// Changes what is sent.
fn break_it(project: &Project) {
    change(
        project,
        "commands/lamp.yaml",
        "code: 0x0104",
        "code: 0x0109",
    );
}

fn waiver(project: &Project) -> String {
    let run = project.fc(&["diff"]).expect(0);
    let mut lines = run.stdout.lines();
    let line = lines.find_map(|line| line.trim().strip_prefix("waiver: "));
    line.expect("the id of a waiver").to_owned()
}

#[test]
fn a_release_freezes_the_spec_and_tells_what_is_new() {
    let project = released();
    assert_eq!(
        project.read("spec/releases/CHANGELOG.md"),
        "# 协议变更记录\n\n## 7 (2026-09-01)\n\n首次发布，共 8 个接口。\n"
    );
    let dump: Value = serde_json::from_str(&project.read("spec/releases/7.json")).expect("JSON");
    assert_eq!(dump["protocol"]["version"], "7");
    assert_eq!(project.fc(&["diff"]).expect(0).stdout, "no changes\n");

    add_command(&project);
    let unreleased = "\
## Unreleased

### New

- `get_warmth` (0x0108): Get the warmth
";
    assert_eq!(project.fc(&["changelog"]).expect(0).stdout, unreleased);
    let run = project.fc(&["release", "7.1", "--dry-run"]).expect(0);
    assert!(run.stdout.contains("+  version: \"7.1\""), "{run:#?}");
    assert!(!project.path("spec/releases/7.1.json").exists());

    let run = project
        .fc(&["release", "7.1", "--today", "2026-12-01"])
        .expect(0);
    assert_eq!(
        run.stdout,
        "\
released 7.1
  spec/protocol.yaml
  spec/releases/7.1.json
  spec/releases/CHANGELOG.md
  spec/releases/CHANGELOG.en.md
run `fc generate`, commit, and tag the commit
"
    );
    assert_eq!(
        project.read("spec/releases/CHANGELOG.en.md"),
        "\
# Changes of the protocol

## 7.1 (2026-12-01)

### New

- `get_warmth` (0x0108): Get the warmth

## 7 (2026-09-01)

First release, with 8 operations.
"
    );
    assert!(
        project
            .read("spec/protocol.yaml")
            .contains("  version: \"7.1\"\n")
    );
    let run = project
        .fc(&["changelog", "7", "7.1", "--lang", "zh"])
        .expect(0);
    assert_eq!(
        run.stdout,
        "## 7.1\n\n### 新增\n\n- `get_warmth`（0x0108）：查询色温\n"
    );
}

#[test]
fn a_number_that_does_not_fit_is_refused_and_nothing_is_written() {
    let project = released();
    let before = project.files("spec");
    let refused = |number: &str, why: &str| {
        let run = project.fc(&["release", number]).expect(1);
        assert!(run.stderr.contains(why), "{run:#?}");
    };
    refused("8", "nothing has changed since the last release");
    assert_eq!(project.files("spec"), before);
    add_command(&project);
    break_it(&project);
    let before = project.files("spec");
    refused("7", "the last release is 7; choose a later number");
    refused("7.1", "the first part of the number has to rise");
    refused("2026.12", "accept each with a waiver: FC0717-");
    assert_eq!(project.files("spec"), before);
    project.fc(&["release", "8"]).expect(0);
    let run = project.fc(&["release", "v9"]).expect(2);
    assert!(run.stderr.contains("such as 2026.12 or 2.1.0"), "{run:#?}");
}

#[test]
fn a_waiver_accepts_one_change_for_a_time() {
    let project = released();
    break_it(&project);
    let break_ = ["diff", "--fail-on", "wire", "--today", "2027-03-31"];
    project.fc(&break_).expect(1);
    let id = waiver(&project);
    let waivers =
        format!("waivers:\n  {id}: {{ zh: 已商定, en: Agreed, by: 张伟, until: 2027-03 }}\n");
    project.write("spec/waivers.yaml", &waivers);
    let run = project.fc(&break_).expect(0);
    assert!(
        run.stdout
            .contains("    waived by 张伟 until 2027-03: Agreed\n"),
        "{run:#?}"
    );
    let json = project
        .fc(&[&break_[..], &["--format", "json"]].concat())
        .expect(0);
    let list: Value = serde_json::from_str(&json.stdout).expect("JSON");
    assert_eq!(list[0]["waived"]["until"], "2027-03");

    // The month is over.
    let run = project.fc(&["diff", "--today", "2027-04-01"]).expect(1);
    assert!(
        run.stdout
            .contains(&format!("FC0765 {id}: the waiver has expired")),
        "{run:#?}"
    );
    // With it, a number by the calendar will do; after the release it accepts nothing any more.
    let release = ["release", "2026.12", "--today", "2026-12-01"];
    project.fc(&release).expect(0);
    let changelog = project.read("spec/releases/CHANGELOG.md");
    assert!(
        changelog.contains("（影响：旧 app 配新机器人、新 app 配旧机器人）。已商定\n"),
        "{changelog}"
    );
    let run = project.fc(&["diff"]).expect(1);
    assert!(
        run.stdout
            .contains(&format!("FC0766 {id}: the waiver accepts nothing")),
        "{run:#?}"
    );
    // Against another version that cannot be said.
    project
        .fc(&["diff", "7", "--today", "2026-12-01"])
        .expect(0);
}

#[test]
fn a_code_that_is_used_again_cannot_be_waived() {
    let project = released();
    change(
        &project,
        "commands/lamp.yaml",
        "code: 0x0104",
        "code: 0x0109",
    );
    let protocol = project.read("spec/protocol.yaml");
    let retired = protocol
        .lines()
        .find_map(|line| line.trim().strip_prefix("- { code: "));
    let retired = retired.and_then(|it| it.get(..6)).expect("a retired code");
    let without: Vec<_> = protocol
        .lines()
        .filter(|line| !line.contains(&format!("code: {retired}")))
        .collect();
    let without = without.join("\n") + "\n";
    project.write("spec/protocol.yaml", &without.replace("  retired:\n", ""));
    change(
        &project,
        "commands/lamp.yaml",
        "code: 0x0109",
        &format!("code: {retired}"),
    );
    let run = project.fc(&["diff", "--format", "json"]).expect(0);
    let list: Vec<Value> = serde_json::from_str(&run.stdout).expect("JSON");
    let found = list.iter().find(|it| it["rule"] == "retired-code-reused");
    let print = found.expect("the finding")["fingerprint"]
        .as_str()
        .expect("a text");
    let waivers = format!(
        "waivers:\n  FC0718-{print}: {{ zh: 已商定, en: Agreed, by: 张伟, until: 2099-01 }}\n"
    );
    project.write("spec/waivers.yaml", &waivers);
    let run = project.fc(&["diff"]).expect(1);
    assert!(run.stdout.contains("FC0767"), "{run:#?}");
}

#[test]
fn what_a_release_said_is_made_again() {
    let project = released();
    project.fc(&["generate"]).expect(0);
    let before = project.read("fc-generated/vectors/frames.json");
    let messages = project.read("fc-generated/src/lib.rs");
    add_command(&project);
    break_it(&project);
    project.fc(&["generate"]).expect(0);
    project
        .fc(&["generate", "--as-of", "7", "--out", "old"])
        .expect(0);
    assert_eq!(project.read("old/fc-generated/vectors/frames.json"), before);
    assert_eq!(project.read("old/fc-generated/src/lib.rs"), messages);
    project
        .fc(&["generate", "--as-of", "7", "--out", "old", "--check"])
        .expect(0);

    let run = project
        .fc(&["generate", "--as-of", "6", "--out", "old"])
        .expect(2);
    assert!(
        run.stderr.contains("there is no release `6`; there are 7"),
        "{run:#?}"
    );
    project.fc(&["generate", "--as-of", "7"]).expect(2);
}

#[test]
fn without_a_release_there_is_nothing_to_compare_with() {
    let project = Project::new();
    for command in ["diff", "changelog"] {
        let run = project.fc(&[command]).expect(2);
        assert!(
            run.stderr.contains("there is no release to compare with"),
            "{run:#?}"
        );
    }
}
