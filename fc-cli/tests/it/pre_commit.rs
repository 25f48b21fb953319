//! The hooks for pre-commit, run by pre-commit.

use std::path::Path;
use std::process::Command;

use crate::support::git::git;
use crate::support::{Project, Run, path_to_command};

/// Runs all hooks of a project as a commit does.
fn hooks(project: &Project, home: &Project) -> Run {
    let output = Command::new("pre-commit")
        .args(["run", "--all-files", "--color=never"])
        .env("PATH", path_to_command())
        .env("PRE_COMMIT_HOME", home.path(""))
        .env("GIT_CONFIG_GLOBAL", "")
        .env_remove("GIT_DIR")
        .env_remove("GIT_INDEX_FILE")
        .current_dir(project.path(""))
        .output();
    Run::new(&output.expect("pre-commit can be run"))
}

#[test]
fn hooks_check_format_spec_and_generated_files() {
    if Command::new("pre-commit")
        .arg("--version")
        .output()
        .is_err()
    {
        assert!(
            std::env::var_os("FC_CI").is_none(),
            "there is no pre-commit here"
        );
        println!("skipped: pre-commit is not there");
        return;
    }
    let commit = |project: &Project| {
        git(project, &["init", "--quiet", "--initial-branch=main"]);
        git(project, &["add", "--all"]);
        git(project, &["commit", "--quiet", "--message", "A commit"]);
        git(project, &["rev-parse", "HEAD"]).trim().to_owned()
    };
    // pre-commit takes hooks from a repository. This one contains only the hooks.
    let offers = Project::empty();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../.pre-commit-hooks.yaml");
    let file = std::fs::read_to_string(file).expect("the hooks");
    offers.write(".pre-commit-hooks.yaml", &file);
    let revision = commit(&offers);
    let project = Project::new();
    project.write("fc.yaml", "targets: { vectors: { out: golden } }\n");
    project.write(
        ".pre-commit-config.yaml",
        &format!(
            "repos:\n  - repo: {}\n    rev: {revision}\n    hooks: [{{ id: fc-fmt }}, {{ id: fc-check }}, {{ id: fc-generate }}]\n",
            offers.path("").display()
        ),
    );
    project.fc(&["fmt"]).expect(0);
    project.fc(&["generate"]).expect(0);
    commit(&project);
    let home = Project::empty();
    hooks(&project, &home).expect(0);

    // First one hook fails for the format. Then two fail, because a placeholder is a warning and the new command is not
    // generated.
    let types = project.read("spec/types.yaml");
    project.write(
        "spec/types.yaml",
        &types.replacen("  Colour:", "  Colour :", 1),
    );
    let run = hooks(&project, &home).expect(1);
    assert_eq!(run.stdout.matches("Failed").count(), 1, "{run:#?}");
    project.write("spec/types.yaml", &types);
    project.fc(&["new", "added", "--group", "lamp"]).expect(0);
    let run = hooks(&project, &home).expect(1);
    assert_eq!(run.stdout.matches("Failed").count(), 2, "{run:#?}");
    assert!(run.stdout.contains("(to be written"), "{run:#?}");
}
