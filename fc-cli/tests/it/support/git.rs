//! Git in a test's project, whatever is set for whoever runs the tests.

use std::process::Command;

use super::Project;

/// What git says; whether it succeeded is for the caller to ask.
pub fn run_git(project: &Project, args: &[&str]) -> (bool, String) {
    let mut command = Command::new("git");
    // A hook of git's that runs this test names its own repository in them.
    for variable in [
        "GIT_DIR",
        "GIT_WORK_TREE",
        "GIT_INDEX_FILE",
        "GIT_PREFIX",
        "GIT_COMMON_DIR",
        "GIT_OBJECT_DIRECTORY",
    ] {
        command.env_remove(variable);
    }
    let output = command
        .args(["-c", "user.name=Test", "-c", "user.email=test@example.org"])
        .args(["-c", "core.autocrlf=false", "-c", "commit.gpgsign=false"])
        .args(args)
        .env("GIT_CONFIG_GLOBAL", "")
        .env("GIT_CONFIG_NOSYSTEM", "1")
        .env("GIT_EDITOR", "true")
        .current_dir(project.path(""))
        .output()
        .expect("git can be run");
    let text = [output.stdout, output.stderr].concat();
    (
        output.status.success(),
        String::from_utf8_lossy(&text).into_owned(),
    )
}

/// What git says where it has to succeed.
pub fn git(project: &Project, args: &[&str]) -> String {
    let (succeeded, text) = run_git(project, args);
    assert!(succeeded, "git {args:?}: {text}");
    text
}
