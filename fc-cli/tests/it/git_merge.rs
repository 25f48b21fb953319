//! `fcproto git`, with two branches that each add a command at the same place in one group.

use crate::support;
use crate::support::Project;
use crate::support::git::{git, run_git};

const GROUP: &str = "spec/commands/left.yaml";

/// Creates a project under version control with the generated files of all targets.
fn project() -> Project {
    let project = Project::new();
    let protocol = project.read("spec/protocol.yaml");
    let range = "\n    - { from: 0x0A01, to: 0x0AFF, use: commands, zh: 新增, en: New ones }\n";
    let (before, after) = protocol
        .split_once("\n  ranges:\n")
        .expect("ranges of codes");
    let protocol = [before, "\n  ranges:", range, after].concat();
    project.write("spec/protocol.yaml", &protocol);
    let group = "group: { id: left, zh: 分组, en: A group }\n\ncommands:\n";
    project.write(GROUP, &format!("{group}{}", command("first", 0x0A01)));
    project.fc(&["fmt"]).expect(0);
    project.fc(&["generate"]).expect(0);
    git(&project, &["init", "--quiet", "--initial-branch=main"]);
    commit(&project);
    project
}

/// Returns a command. Its changelog entry has a date that occurs nowhere else.
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
    changes:
      - {{ date: 2031-05-01, zh: 新增 {name}, en: Added {name} }}
"
    )
}

/// Sets up a clone as the output of `fcproto git setup` describes, and commits the lines that it asks for.
fn set_up(project: &Project, options: &[&str]) {
    let setup = [&["git", "setup"], options].concat();
    let said = project.fc(&setup).expect(0).stdout;
    let (_, lines) = said.split_once(".gitattributes:\n").expect("lines to add");
    project.write(".gitattributes", lines);
    git(project, &["add", ".gitattributes"]);
    git(project, &["commit", "--quiet", "--message", "Attributes"]);
    let again = project.fc(&setup).expect(0).stdout;
    assert!(!again.contains(".gitattributes"), "{again}");
}

/// Creates a branch with another command after the first.
fn branch(project: &Project, name: &str, code: u16) {
    git(project, &["switch", "--quiet", "--create", name, "main"]);
    project.append(GROUP, &format!("\n{}", command(name, code)));
    project.fc(&["generate"]).expect(0);
    commit(project);
}

fn commit(project: &Project) {
    git(project, &["add", "--all"]);
    git(project, &["commit", "--quiet", "--message", "A commit"]);
}

fn branches(project: &Project) {
    branch(project, "apple", 0x0A05);
    branch(project, "pear", 0x0A06);
}

/// Adds the generated files to the last commit.
fn amend(project: &Project) {
    // The user who runs the tests may have no name set for git.
    for key in ["name", "email"] {
        git(
            project,
            &["config", &format!("user.{key}"), "test@example.org"],
        );
    }
    project.fc(&["git", "stage", "--amend"]).expect(0);
}

/// Returns the files in conflict.
fn conflicts(project: &Project) -> Vec<String> {
    let list = git(project, &["diff", "--name-only", "--diff-filter=U"]);
    list.lines().map(str::to_owned).collect()
}

/// Checks that both commands are in the spec and in each target. All files are up to date and committed.
fn is_whole(project: &Project) {
    project.fc(&["check", "-q", "--deny", "warnings"]).expect(0);
    project.fc(&["fmt", "--check"]).expect(0);
    project.fc(&["generate", "--check"]).expect(0);
    assert_eq!(git(project, &["status", "--porcelain"]), "");
    for name in ["apple", "pear"] {
        assert!(project.read(GROUP).contains(name));
        // The output of each target names the command.
        let found = git(project, &["grep", "-il", name]);
        for target in [
            "fc-generated/src",
            "fc-generated/vectors",
            "docs-site/reference",
            "docs-site/en",
            "stubs/typescript",
            "stubs/python",
            "stubs/kotlin",
            "stubs/cpp",
        ] {
            assert!(found.contains(target), "{name} in {target}: {found}");
        }
    }
}

#[test]
fn git_alone_leaves_conflicts() {
    let project = project();
    branches(&project);
    let (merged, text) = run_git(&project, &["merge", "--no-edit", "apple"]);
    assert!(!merged, "{text}");
    let conflicts = conflicts(&project);
    assert!(conflicts.contains(&GROUP.to_owned()), "{conflicts:?}");
    assert!(conflicts.len() > 1, "{conflicts:?}");
}

#[test]
fn merge_keeps_both_commands_and_generates() {
    for (ours, theirs) in [("apple", "pear"), ("pear", "apple")] {
        let project = project();
        set_up(&project, &[]);
        branches(&project);
        git(&project, &["switch", "--quiet", ours]);
        let text = git(&project, &["merge", "--no-edit", theirs]);
        assert!(
            text.contains("Keeping what both sides have added"),
            "{text}"
        );
        amend(&project);
        is_whole(&project);
    }
}

#[test]
fn hooks_complete_the_merge_commit() {
    let project = project();
    set_up(&project, &["--hooks"]);
    branches(&project);
    git(&project, &["merge", "--no-edit", "apple"]);
    is_whole(&project);
    git(&project, &["rev-parse", "--verify", "HEAD^2"]);
    assert!(git(&project, &["log", "-1", "--format=%s"]).contains("Merge branch"));
}

#[test]
fn a_rebase_ends_whole_at_each_commit() {
    let project = project();
    set_up(&project, &[]);
    branches(&project);
    let stage = format!("{} -q git stage --amend", env!("CARGO_BIN_EXE_fcproto"));
    git(&project, &["rebase", "--quiet", "apple", "--exec", &stage]);
    is_whole(&project);
}

#[test]
fn a_commit_that_is_picked_has_no_conflict() {
    let project = project();
    set_up(&project, &[]);
    branches(&project);
    git(&project, &["cherry-pick", "apple"]);
    amend(&project);
    is_whole(&project);
}

#[test]
fn only_lines_changed_by_both_conflict() {
    let project = project();
    set_up(&project, &["--hooks"]);
    let change = |branch: &str, from: &str, to: &str| {
        git(&project, &["switch", "--quiet", "--create", branch, "main"]);
        project.write(GROUP, &project.read(GROUP).replacen(from, to, 1));
        project.fc(&["generate"]).expect(0);
        commit(&project);
    };
    change("apple", "max: 100", "max: 90");
    change("pear", "max: 100", "max: 80");
    let (merged, text) = run_git(&project, &["merge", "--no-edit", "apple"]);
    assert!(!merged, "{text}");
    assert_eq!(conflicts(&project), [GROUP]);
    assert!(project.read(GROUP).contains("<<<<<<< "));
    // After the conflict is resolved, the hook of the commit reports the stale files.
    git(&project, &["checkout", "--quiet", "--theirs", GROUP]);
    git(&project, &["add", GROUP]);
    let (committed, text) = run_git(&project, &["commit", "--no-edit"]);
    assert!(!committed && text.contains("fcproto generate"), "{text}");
    project.fc(&["git", "stage"]).expect(0);
    git(&project, &["commit", "--quiet", "--no-edit"]);
    assert_eq!(git(&project, &["status", "--porcelain"]), "");
}

#[test]
fn commits_of_others_are_not_amended() {
    let project = project();
    set_up(&project, &["--hooks"]);
    git(&project, &["switch", "--quiet", "--create", "stale"]);
    project.append(GROUP, &format!("\n{}", command("apple", 0x0A05)));
    git(
        &project,
        &[
            "commit",
            "--quiet",
            "--all",
            "--no-verify",
            "--message",
            "Stale",
        ],
    );
    let commit = git(&project, &["rev-parse", "HEAD"]);
    git(&project, &["switch", "--quiet", "main"]);
    let text = git(&project, &["merge", "stale"]);
    assert!(text.contains("Fast-forward"), "{text}");
    assert_eq!(git(&project, &["rev-parse", "HEAD"]), commit);
    project.fc(&["generate", "--check"]).expect(1);
}

#[test]
fn a_hook_of_somebody_else_stays() {
    let project = project();
    project.write(".git/hooks/pre-commit", "#!/bin/sh\necho mine\n");
    let run = project.fc(&["git", "setup", "--hooks"]).expect(2);
    assert!(run.stderr.contains("fcproto git check"), "{run:#?}");
    assert!(project.read(".git/hooks/pre-commit").contains("mine"));
    assert!(!project.path(".git/hooks/post-merge").exists());
}

/// An earlier version of the program was called `fc`. Its hooks contain its path.
#[test]
fn hooks_with_the_old_name_are_replaced() {
    let project = project();
    set_up(&project, &["--hooks"]);
    let hooks = [".git/hooks/pre-commit", ".git/hooks/post-merge"];
    let written = hooks.map(|hook| project.read(hook));
    for (hook, text) in hooks.iter().zip(&written) {
        project.write(hook, &text.replace("fcproto", "fc"));
    }
    assert_ne!(hooks.map(|hook| project.read(hook)), written);
    project.fc(&["git", "setup", "--hooks"]).expect(0);
    assert_eq!(hooks.map(|hook| project.read(hook)), written);
}

#[test]
fn project_below_the_repository_root_is_found() {
    let outer = Project::empty();
    support::copy(&project().path("spec"), &outer.path("robots/lamp/spec"));
    let inner = |args: &[&str]| outer.fc_in("robots/lamp", args).expect(0);
    inner(&["generate"]);
    git(&outer, &["init", "--quiet", "--initial-branch=main"]);
    let said = inner(&["git", "setup", "--hooks"]).stdout;
    let (_, lines) = said.split_once(".gitattributes:\n").expect("lines to add");
    outer.write("robots/lamp/.gitattributes", lines);
    commit(&outer);
    let path = format!("robots/lamp/{GROUP}");
    for (name, code) in [("apple", 0x0A05), ("pear", 0x0A06)] {
        git(&outer, &["switch", "--quiet", "--create", name, "main"]);
        outer.append(&path, &format!("\n{}", command(name, code)));
        inner(&["generate"]);
        commit(&outer);
    }
    git(&outer, &["merge", "--no-edit", "apple"]);
    inner(&["generate", "--check"]);
    assert_eq!(git(&outer, &["status", "--porcelain"]), "");
}
