//! Waivers of changes, and their effect on releases.

use super::{break_it, change, released};
use crate::support::Project;
use serde_json::Value;

fn waiver(project: &Project) -> String {
    let run = project.fc(&["diff"]).expect(0);
    let mut lines = run.stdout.lines();
    let line = lines.find_map(|line| line.trim().strip_prefix("waiver: "));
    line.expect("the id of a waiver").to_owned()
}

#[test]
fn a_waiver_accepts_one_change_for_a_time() {
    let project = released();
    break_it(&project);
    let break_ = ["diff", "--fail-on", "wire", "--today", "2027-03-31"];
    let run = project.fc(&break_).expect(1);
    assert!(run.stdout.contains("FC0763 "), "{run:#?}");
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
    assert!(!run.stdout.contains("FC0763 "), "it is announced: {run:#?}");
    let json = project
        .fc(&[&break_[..], &["--format", "json"]].concat())
        .expect(0);
    let list: Value = serde_json::from_str(&json.stdout).expect("JSON");
    assert_eq!(list[0]["waived"]["until"], "2027-03");

    // The month has ended.
    let run = project.fc(&["diff", "--today", "2027-04-01"]).expect(1);
    assert!(
        run.stdout
            .contains(&format!("FC0765 {id}: the waiver has expired")),
        "{run:#?}"
    );
    let run = project
        .fc(&["release", "2027.04", "--today", "2027-04-01"])
        .expect(1);
    assert!(run.stderr.contains("the waiver has expired"), "{run:#?}");
}

/// With a waiver, a calendar number is enough. The release removes the waiver, because it no longer accepts anything.
#[test]
fn a_release_takes_out_the_waivers_that_have_served() {
    let project = released();
    break_it(&project);
    let id = waiver(&project);
    let waiver = format!("  {id}: {{ zh: 已商定, en: Agreed, by: 张伟, until: 2027-03 }}\n");
    let other =
        "  FC0801-000000000000: { zh: 无关, en: Of another check, by: 李雷, until: 2099-01 }\n";
    project.write(
        "spec/waivers.yaml",
        &format!("# Breaks.\nwaivers:\n{waiver}{other}"),
    );
    let run = project.fc(&["release", "2026.12", "--dry-run"]).expect(0);
    let shown = format!("spec/waivers.yaml\n-{waiver}");
    assert!(run.stdout.contains(&shown), "{run:#?}");
    let release = ["release", "2026.12", "--today", "2026-12-01"];
    let run = project.fc(&release).expect(0);
    assert!(run.stdout.contains("  spec/waivers.yaml\n"), "{run:#?}");
    let left = format!("# Breaks.\nwaivers:\n{other}");
    assert_eq!(project.read("spec/waivers.yaml"), left);
    let changelog = project.read("spec/releases/CHANGELOG.md");
    assert!(
        changelog.contains("（影响：旧 app 配新机器人、新 app 配旧机器人）。已商定\n"),
        "{changelog}"
    );
    assert_eq!(project.fc(&["diff"]).expect(0).stdout, "no changes\n");

    // A restored waiver accepts nothing. A comparison with another version cannot detect that.
    project.write("spec/waivers.yaml", &format!("waivers:\n{waiver}"));
    let run = project.fc(&["diff"]).expect(1);
    let unused = format!("FC0766 {id}: the waiver accepts nothing");
    assert!(run.stdout.contains(&unused), "{run:#?}");
    project
        .fc(&["diff", "7", "--today", "2026-12-01"])
        .expect(0);
}

/// A file that contains only waivers stays valid.
#[test]
fn the_last_waiver_leaves_an_empty_list() {
    let project = released();
    break_it(&project);
    let id = waiver(&project);
    let waivers = format!(
        "waivers:\n  {id}:\n    zh: 已商定\n    en: Agreed\n    by: 张伟\n    until: 2027-03\n"
    );
    project.write("spec/waivers.yaml", &waivers);
    project
        .fc(&["release", "2026.12", "--today", "2026-12-01"])
        .expect(0);
    assert_eq!(project.read("spec/waivers.yaml"), "waivers: {}\n");
    project.fc(&["check"]).expect(0);
}

#[test]
fn a_waiver_in_braces_is_left_to_people() {
    let project = released();
    break_it(&project);
    let id = waiver(&project);
    let waivers =
        format!("waivers: {{ {id}: {{ zh: 已商定, en: Agreed, by: 张伟, until: 2027-03 }} }}\n");
    project.write("spec/waivers.yaml", &waivers);
    let run = project
        .fc(&["release", "2026.12", "--today", "2026-12-01"])
        .expect(0);
    let left = format!("remove these waivers, which are used up: {id}\n");
    assert!(run.stdout.contains(&left), "{run:#?}");
    assert_eq!(project.read("spec/waivers.yaml"), waivers);
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
