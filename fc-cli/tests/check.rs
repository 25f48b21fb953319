//! `fc check` and what all commands have in common.

#![allow(clippy::expect_used, clippy::indexing_slicing, reason = "tests")]

mod support;

use std::process::Stdio;

use serde_json::Value;
use support::Project;

/// Two broken files; the faults of both show up.
fn broken() -> Project {
    let project = Project::new();
    project.append("spec/protocol.yaml", "回充: [ 甲\n");
    project.append("spec/types.yaml", "twice: 1\ntwice: 2\n");
    project
}

#[test]
fn the_spec_has_no_faults() {
    let run = Project::new().fc(&["check"]).expect(0);
    assert!(run.stdout.starts_with("checked "), "{run:#?}");
    assert_eq!(run.stderr, "");
}

#[test]
fn faults_are_shown_for_people() {
    let run = broken().fc(&["check"]).expect(1);
    assert_eq!(run.stdout, "");
    let line = Project::new().read("spec/protocol.yaml").lines().count() + 1;
    for part in [
        "error[FC0008]: the `[` is never closed",
        "error[FC0012]: the key `twice` occurs twice",
        &format!("--> spec/protocol.yaml:{line}:5\n"),
        &format!("{line} | 回充: [ 甲\n"),
        "run `fc explain FC",
    ] {
        assert!(run.stderr.contains(part), "{part:?} in {}", run.stderr);
    }
}

#[test]
fn faults_are_shown_for_machines() {
    let project = broken();
    let codes = |run: &support::Run| -> Vec<String> {
        let faults = run.stdout.lines().map(serde_json::from_str::<Value>);
        faults
            .map(|fault| {
                fault.expect("JSON")["code"]
                    .as_str()
                    .expect("a code")
                    .to_owned()
            })
            .collect()
    };
    let run = project.fc(&["check", "--format", "json"]).expect(1);
    assert!(codes(&run).contains(&"FC0008".to_owned()), "{run:#?}");
    assert!(codes(&run).contains(&"FC0012".to_owned()), "{run:#?}");

    let run = project.fc(&["check", "--format", "sarif"]).expect(1);
    let log: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(log["version"], "2.1.0");
    let results = log["runs"][0]["results"].as_array().expect("results");
    assert!(results.iter().any(|result| result["ruleId"] == "FC0012"));

    let run = project.fc(&["check", "--format", "github"]).expect(1);
    assert!(
        run.stdout.contains("::error file=spec/types.yaml,line="),
        "{run:#?}"
    );
    assert!(
        run.stdout.lines().all(|line| line.starts_with("::error ")),
        "{run:#?}"
    );
}

#[test]
fn formats_without_faults() {
    let project = Project::new();
    assert_eq!(
        project.fc(&["check", "--format", "json"]).expect(0).stdout,
        ""
    );
    assert_eq!(
        project
            .fc(&["check", "--format", "github"])
            .expect(0)
            .stdout,
        ""
    );
    let run = project.fc(&["check", "--format", "sarif"]).expect(0);
    let log: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(log["runs"][0]["results"], Value::Array(Vec::new()));
}

#[test]
fn colors_are_a_choice() {
    let project = broken();
    assert!(!project.fc(&["check"]).stderr.contains('\x1b'));
    assert!(
        !project
            .fc(&["check", "--color", "never"])
            .stderr
            .contains('\x1b')
    );
    assert!(
        project
            .fc(&["check", "--color", "always"])
            .stderr
            .contains('\x1b')
    );
}

#[test]
fn the_root_is_found_from_below() {
    let project = Project::new();
    project.fc_in("spec/commands", &["check"]).expect(0);
    let elsewhere = Project::empty();
    let root = project.path("");
    elsewhere
        .fc(&["check", "--root", root.to_str().expect("UTF-8")])
        .expect(0);
}

#[test]
fn the_spec_may_have_another_name() {
    let project = Project::new();
    std::fs::rename(project.path("spec"), project.path("protocol")).expect("renamed");
    project.fc(&["check"]).expect(2);
    project.fc(&["check", "--spec", "protocol"]).expect(0);
    project.append("protocol/types.yaml", "x: [\n");
    let run = project
        .fc_in("protocol", &["check", "--spec", "protocol"])
        .expect(1);
    assert!(run.stderr.contains("--> protocol/types.yaml:"), "{run:#?}");
}

#[test]
fn wrong_usage_and_missing_files_are_status_two() {
    let project = Project::empty();
    let run = project.fc(&["check"]).expect(2);
    assert!(
        run.stderr.contains("no `spec/protocol.yaml` here"),
        "{run:#?}"
    );
    let run = project.fc(&["check", "--root", "."]).expect(2);
    assert!(
        run.stderr.contains("error[FC0001]: cannot read `spec`"),
        "{run:#?}"
    );
    let run = project.fc(&["check", "--root", "nowhere"]).expect(2);
    assert!(
        run.stderr.contains("`nowhere` is not a directory"),
        "{run:#?}"
    );
    for args in [
        &["chekc"][..],
        &[],
        &["check", "--format", "xml"],
        &["check", "spec"],
    ] {
        project.fc(args).expect(2);
    }
}

#[test]
fn help_says_how_it_ends() {
    let run = Project::empty().fc(&["--help"]).expect(0);
    for part in [
        "Exit status:",
        "Examples:",
        "fc generate --check",
        "--root <DIR>",
    ] {
        assert!(run.stdout.contains(part), "{part:?} in {}", run.stdout);
    }
    for command in ["check", "explain", "generate", "inspect", "schema"] {
        let run = Project::empty().fc(&[command, "--help"]).expect(0);
        assert!(
            run.stdout.lines().all(|line| line.chars().count() <= 100),
            "{}",
            run.stdout
        );
    }
}

/// A reader that goes away (`fc explain | head`) is no failure.
#[test]
fn nobody_reads_the_rest() {
    let mut command = support::command(&["explain"]);
    let mut child = command
        .stdout(Stdio::piped())
        .spawn()
        .expect("the command can be run");
    drop(child.stdout.take());
    assert!(child.wait().expect("it ends").success());
}
