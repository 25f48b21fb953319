//! A protocol grows: what was written against it before compiles unchanged, but for the robot that says
//! it is complete.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    clippy::wildcard_imports,
    missing_docs,
    reason = "tests"
)]

#[path = "support/nested.rs"]
mod nested;
mod support;

use std::fs;
use std::path::{Path, PathBuf};

/// What is added to the protocol of `fc-codegen/tests/docs`: file, line, what comes before that line.
const ADDED: &[(&str, &str, &str)] = &[(
    "commands/lamp.yaml",
    "  probe:",
    "  blink:
    code: 0x0105
    zh: 闪烁
    en: Blink
    effect: motion
    source: { sections: [] }
",
)];

/// A copy of the protocol, and a crate made from it with tests that were written against it.
fn crate_before(name: &str, tests: &[&str]) -> PathBuf {
    let project = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let spec = project.join("spec");
    if project.exists() {
        fs::remove_dir_all(&project).unwrap();
    }
    let root = support::root();
    support::copy(&root.join("fc-codegen/tests/docs/spec"), &spec);
    generate(&project, tests);
    project
}

fn generate(project: &Path, tests: &[&str]) {
    let folder = support::root().join("fc-generated/tests/growing");
    let tests: Vec<PathBuf> = tests.iter().map(|test| folder.join(test)).collect();
    let tests: Vec<&Path> = tests.iter().map(PathBuf::as_path).collect();
    nested::write_crate(project, &support::model(project), &tests);
}

/// Adds what is to be added.
fn grow(project: &Path) {
    for (file, line, lines) in ADDED {
        let file = project.join("spec").join(file);
        let text = fs::read_to_string(&file).unwrap();
        let line = format!("\n{line}\n");
        assert_eq!(text.matches(&line).count(), 1, "{line}");
        fs::write(
            &file,
            text.replace(&line, &format!("\n{lines}{}", &line[1..])),
        )
        .unwrap();
    }
}

#[test]
fn a_new_command_breaks_a_complete_robot_and_no_other() {
    let tests = ["partial.rs", "complete.rs"];
    let project = crate_before("growing", &tests);
    nested::cargo(
        &project,
        &["test", "--test", "partial", "--test", "complete"],
    );
    grow(&project);
    generate(&project, &tests);
    nested::cargo(&project, &["test", "--test", "partial"]);
    let errors = nested::refused(&project, &["check", "--test", "complete"]);
    assert!(
        errors.contains("not all trait items implemented, missing: `blink`"),
        "{errors}"
    );
}
