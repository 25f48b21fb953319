//! A protocol grows. Code that was written before compiles unchanged, except a robot that implements all commands.

use crate::support;
use crate::support::nested;
use std::fs;
use std::path::{Path, PathBuf};

/// An addition to a spec: the file, the lines before the addition, and the new lines.
type Added = (&'static str, &'static str, &'static str);

/// A new command.
const COMMAND: &[Added] = &[(
    "commands/lamp.yaml",
    "commands:",
    "  blink:
    code: 0x0105
    zh: 闪烁
    en: Blink
    effect: motion
    source: { sections: [] }
",
)];

/// Optional keys, each before the existing ones: in a request, a response, a report, and a type that a list holds.
const KEYS: &[Added] = &[
    (
        "commands/lamp.yaml",
        "    request:\n      data:",
        "        hint: { type: \"string?\", zh: 提示, en: Hint }",
    ),
    (
        "commands/lamp.yaml",
        "        quirk: [empty_is_absent]\n        fields:",
        "          spent: { type: \"u8?\", zh: 用时, en: Time spent }",
    ),
    (
        "commands/lamp.yaml",
        "    ack: { timeout_ms: 500, retries: 0 }\n    body:",
        "      by: { type: \"string?\", zh: 操作者, en: By whom }",
    ),
    (
        "types.yaml",
        "    since: 2024-03\n    fields:",
        "      blue: { type: \"u8?\", zh: 蓝, en: Blue }",
    ),
];

/// Copies the protocol and generates a crate with these tests from it. Returns the folder of both.
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

/// Inserts additions into the spec.
fn grow(project: &Path, added: &[Added]) {
    for (file, behind, lines) in added {
        let file = project.join("spec").join(file);
        let text = fs::read_to_string(&file).unwrap();
        let behind = format!("\n{behind}\n");
        assert_eq!(text.matches(&behind).count(), 1, "{behind}");
        fs::write(&file, text.replace(&behind, &format!("{behind}{lines}\n"))).unwrap();
    }
}

#[test]
#[ignore = "compiles a crate of its own"]
fn a_new_command_breaks_a_complete_robot_and_no_other() {
    let tests = ["partial.rs", "complete.rs"];
    let project = crate_before("growing", &tests);
    nested::cargo(
        &project,
        &["test", "--test", "partial", "--test", "complete"],
    );
    grow(&project, COMMAND);
    generate(&project, &tests);
    nested::cargo(&project, &["test", "--test", "partial"]);
    let errors = nested::refused(&project, &["check", "--test", "complete"]);
    assert!(
        errors.contains("not all trait items implemented, missing: `blink`"),
        "{errors}"
    );
}

#[test]
#[ignore = "compiles a crate of its own"]
fn new_optional_key_breaks_no_peer() {
    let tests = ["app.rs", "partial.rs", "complete.rs", "literal.rs"];
    let run = [
        "test", "--test", "app", "--test", "partial", "--test", "complete",
    ];
    let project = crate_before("growing_keys", &tests);
    nested::cargo(&project, &run);
    // A new key would break a struct literal, so the compiler refuses it from the start.
    let errors = nested::refused(&project, &["check", "--test", "literal"]);
    let refused = "cannot create non-exhaustive struct using struct expression";
    assert!(errors.contains(refused), "{errors}");
    grow(&project, KEYS);
    generate(&project, &tests);
    nested::cargo(&project, &run);
}
