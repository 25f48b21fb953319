//! `fcproto check`, and behaviour that all commands share.

use std::process::Stdio;

use crate::support::{self, Project, copy};
use serde_json::Value;

/// Creates a project with errors in two files. A run reports both.
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
        "run `fcproto explain FC",
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
        "fcproto generate --check",
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

/// A closed reader, as in `fcproto explain | head`, is not an error.
#[test]
fn closed_stdout_is_no_failure() {
    let mut command = support::command(&["explain"]);
    let mut child = command
        .stdout(Stdio::piped())
        .spawn()
        .expect("the command can be run");
    drop(child.stdout.take());
    assert!(child.wait().expect("it ends").success());
}

/// Code hosts resolve the paths of annotations from the root of the repository.
#[test]
fn paths_for_code_hosts_count_from_the_repository() {
    let outer = Project::empty();
    let inner = broken();
    let project = "tools/protocol";
    copy(&inner.path("spec"), &outer.path(project).join("spec"));
    let sarif = |run: &support::Run| -> Value {
        let log: Value = serde_json::from_str(&run.stdout).expect("JSON");
        let location = &log["runs"][0]["results"][0]["locations"][0];
        location["physicalLocation"]["artifactLocation"]["uri"].clone()
    };
    let expected = "tools/protocol/spec/protocol.yaml";

    // Runs outside with `--root`, before the repository exists.
    let args = ["check", "--root", project, "--format"];
    let github = outer.fc(&[&args[..], &["github"]].concat()).expect(1);
    assert!(
        github.stdout.contains(&format!("file={expected},")),
        "{github:#?}"
    );
    let log = outer.fc(&[&args[..], &["sarif"]].concat()).expect(1);
    assert_eq!(sarif(&log), expected);

    // Runs inside a repository.
    std::fs::create_dir(outer.path(".git")).expect("a directory");
    let github = outer
        .fc_in(project, &["check", "--format", "github"])
        .expect(1);
    assert!(
        github.stdout.contains(&format!("file={expected},")),
        "{github:#?}"
    );

    // `GITHUB_WORKSPACE` takes precedence.
    let output = support::command(&["check", "--format", "github"])
        .current_dir(outer.path(project))
        .env("GITHUB_WORKSPACE", outer.path("tools"))
        .output();
    let run = support::Run::new(&output.expect("the command can be run"));
    assert!(
        run.stdout.contains("file=protocol/spec/protocol.yaml,"),
        "{run:#?}"
    );

    // People and other programs get paths relative to the project's root.
    let run = outer.fc_in(project, &["check"]).expect(1);
    assert!(run.stderr.contains("--> spec/protocol.yaml:"), "{run:#?}");
    let run = outer
        .fc_in(project, &["check", "--format", "json"])
        .expect(1);
    assert!(
        run.stdout.contains("\"path\":\"spec/protocol.yaml\""),
        "{run:#?}"
    );
}

/// A missing part of the spec is the only error. Its consequences are not reported.
#[test]
fn missing_part_is_the_only_error() {
    let faults = |project: &Project| -> Vec<String> {
        let run = project
            .fc(&["check", "--root", ".", "--format", "json"])
            .expect(1);
        let faults = run.stdout.lines().map(serde_json::from_str::<Value>);
        let faults = faults.map(|fault| fault.expect("JSON"));
        faults
            .map(|fault| format!("{} {}", fault["code"], fault["message"]).replace('"', ""))
            .collect()
    };
    let remove = |project: &Project, path: &str| {
        let path = project.path(path);
        if path.is_dir() {
            std::fs::remove_dir_all(path).expect("removed");
        } else {
            std::fs::remove_file(path).expect("removed");
        }
    };

    let project = Project::new();
    remove(&project, "spec/protocol.yaml");
    assert_eq!(
        faults(&project),
        ["FC0115 the spec has no file `protocol.yaml`"]
    );

    let project = Project::new();
    remove(&project, "spec/commands");
    assert_eq!(
        faults(&project),
        ["FC0115 the spec has no file in `commands/`"]
    );

    let project = Project::new();
    std::fs::rename(project.path("spec/commands"), project.path("spec/command")).expect("renamed");
    assert_eq!(
        faults(&project),
        ["FC0004 `spec/command` is not read as part of the spec"]
    );

    let project = Project::new();
    remove(&project, "spec/commands/lamp.yaml");
    std::fs::create_dir(project.path("spec/commands/lamp.yaml")).expect("a directory");
    assert_eq!(
        faults(&project),
        ["FC0004 `spec/commands/lamp.yaml` is a directory, not a file"]
    );

    let project = Project::new();
    project.append("spec/types.yaml", "---\ntypes: {}\n");
    assert_eq!(faults(&project), ["FC0019 a second document in one file"]);

    let project = Project::new();
    let text = project.read("spec/types.yaml");
    let text = format!("<<<<<<< HEAD\n{text}=======\n{text}>>>>>>> other\n");
    project.write("spec/types.yaml", &text);
    assert_eq!(
        faults(&project),
        ["FC0023 `<<<<<<<` is a marker of an unresolved merge conflict"]
    );
}
