//! Two branches that each add a command, merged by plain git.
//!
//! Generated files are committed, so they must merge like the spec. No line may change with every addition, such as a
//! count, a line number or the next free code. No list may put two additions next to each other.

use crate::support::Project;
use crate::support::git::{git, run_git};

/// Creates a generated project under version control, with two groups of two commands each.
fn project() -> Project {
    let project = Project::new();
    let protocol = project.read("spec/protocol.yaml");
    let range = "\n    - { from: 0x0A01, to: 0x0AFF, use: commands, zh: 新增, en: New ones }\n";
    let (before, after) = protocol
        .split_once("\n  ranges:\n")
        .expect("ranges of codes");
    let protocol = [before, "\n  ranges:", range, after].concat();
    project.write("spec/protocol.yaml", &protocol);
    for (group, first) in [("left", 0x0A01), ("right", 0x0A03)] {
        project.write(
            &file_of(group),
            &format!(
                "group: {{ id: {group}, zh: 分组, en: A group }}\n\ncommands:\n{}{}",
                command(&format!("{group}_a"), first),
                command(&format!("{group}_b"), first + 1)
            ),
        );
    }
    project.fc(&["generate"]).expect(0);
    git(&project, &["init", "--quiet", "--initial-branch=main"]);
    commit(&project);
    project
}

fn file_of(group: &str) -> String {
    format!("spec/commands/{group}.yaml")
}

fn command(name: &str, code: u16) -> String {
    format!(
        "  {name}:
    code: 0x{code:04X}
    zh: 指令
    en: A command
    effect: read
    source: {{ sections: [] }}
    response:
      level: {{ type: u8, max: 100, example: 80, zh: 电量, en: Charge }}
"
    )
}

/// Creates a branch with another command at the end of a group.
fn branch(project: &Project, name: &str, group: &str, code: u16) {
    git(project, &["switch", "--quiet", "--create", name, "main"]);
    project.append(&file_of(group), &command(name, code));
    project.fc(&["generate"]).expect(0);
    commit(project);
}

fn commit(project: &Project) {
    git(project, &["add", "--all"]);
    git(project, &["commit", "--quiet", "--message", "A commit"]);
}

#[test]
fn two_branches_with_a_command_each_merge() {
    let project = project();
    branch(&project, "one", "left", 0x0A05);
    branch(&project, "two", "right", 0x0A06);
    let (merged, text) = run_git(&project, &["merge", "--quiet", "--no-edit", "one"]);
    assert!(merged, "{text}");
    project.fc(&["generate", "--check"]).expect(0);
}

#[test]
fn added_command_changes_no_generated_line() {
    let project = project();
    branch(&project, "one", "left", 0x0A05);
    let changed = git(&project, &["diff", "--numstat", "main", "one"]);
    for line in changed.lines() {
        let deleted = line.split('\t').nth(1).expect("three columns");
        assert_eq!(deleted, "0", "lines deleted by adding a command: {line}");
    }
}

#[test]
fn generated_files_name_no_line_numbers() {
    let project = project();
    assert!(git(&project, &["grep", "-l", "yaml"]).contains("reference/"));
    let (found, text) = run_git(&project, &["grep", "-E", r"\.yaml(:|#L)[0-9]"]);
    assert!(!found && text.is_empty(), "{text}");
}

#[test]
fn same_code_on_two_branches_is_an_error() {
    let project = project();
    branch(&project, "one", "left", 0x0A05);
    branch(&project, "two", "right", 0x0A05);
    run_git(&project, &["merge", "--quiet", "--no-edit", "one"]);
    let run = project.fc(&["check"]).expect(1);
    assert!(
        run.stdout.contains("FC0301") || run.stderr.contains("FC0301"),
        "{run:#?}"
    );
}
