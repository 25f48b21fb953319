//! Runs git in the project of a test, independent of the user's settings.

use std::process::Command;

use super::Project;

/// Runs git. Returns `true` on success, and the output.
pub fn run_git(project: &Project, args: &[&str]) -> (bool, String) {
    let mut command = Command::new("git");
    // If a git hook runs this test, these variables name its repository.
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

/// Runs git and returns its output. Fails the test on an error.
pub fn git(project: &Project, args: &[&str]) -> String {
    let (succeeded, text) = run_git(project, args);
    assert!(succeeded, "git {args:?}: {text}");
    text
}
