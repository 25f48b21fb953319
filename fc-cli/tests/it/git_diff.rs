//! `fcproto git diff`: the output of git for changes of the spec.

use crate::support::Project;
use crate::support::git::git;

const LAMP: &str = "spec/commands/lamp.yaml";
const TYPES: &str = "spec/types.yaml";

fn project() -> Project {
    let project = Project::new();
    git(&project, &["init", "--quiet", "--initial-branch=main"]);
    project.write(".gitattributes", "/spec/**/*.yaml diff=fc\n");
    project.fc(&["git", "setup", "-q"]).expect(0);
    commit(&project);
    project
}

fn commit(project: &Project) {
    git(project, &["add", "--all"]);
    git(project, &["commit", "--quiet", "--message", "A commit"]);
}

fn change(project: &Project, file: &str, from: &str, to: &str) {
    let text = project.read(file);
    assert!(text.contains(from), "{from}");
    project.write(file, &text.replacen(from, to, 1));
}

/// Checks that the output contains all of `all` and none of `none`.
fn says(text: &str, all: &[&str], none: &[&str]) {
    for wanted in all {
        assert!(text.contains(wanted), "no `{wanted}` in {text}");
    }
    for unwanted in none {
        assert!(!text.contains(unwanted), "`{unwanted}` in {text}");
    }
}

#[test]
fn changes_are_described_with_the_sides_they_break() {
    let project = project();
    change(&project, LAMP, "code: 0x0104", "code: 0x0109");
    let said = git(&project, &["diff"]);
    let head = "diff --fc a/spec/commands/lamp.yaml b/spec/commands/lamp.yaml\nFC07";
    says(
        &said,
        &[head, "old apps with new robots", "0x0104", "0x0109"],
        &["@@"],
    );
    let lines = git(&project, &["diff", "--no-ext-diff"]);
    says(&lines, &["@@", "+    code: 0x0109"], &["FC07"]);
    commit(&project);
    assert_eq!(said, git(&project, &["show", "--ext-diff", "--format="]));
    assert_eq!(said, git(&project, &["diff", "HEAD~", "HEAD"]));
}

#[test]
fn a_change_over_several_files_is_told_of_each_apart() {
    let project = project();
    // Changes a value and a command, then renames a type. After the rename, neither file alone fits the other version.
    change(&project, TYPES, "burning", "alight");
    change(&project, TYPES, "burning", "alight");
    change(&project, LAMP, "code: 0x0104", "code: 0x0109");
    let said = git(&project, &["diff"]);
    let (lamp, types) = said
        .split_once("diff --fc a/spec/types.yaml")
        .expect("two files");
    says(lamp, &["0x0109"], &["alight"]);
    says(types, &["alight"], &["0x0109"]);

    let renamed = project.read(LAMP).replace("Mood", "Temper");
    project.write(LAMP, &renamed);
    let renamed = project.read(TYPES).replace("Mood", "Temper");
    project.write(TYPES, &renamed);
    for said in [git(&project, &["diff"]), {
        commit(&project);
        git(&project, &["show", "--ext-diff", "--format="])
    }] {
        let (lamp, types) = said
            .split_once("diff --fc a/spec/types.yaml")
            .expect("two files");
        says(lamp, &["0x0109"], &["alight", "@@"]);
        says(types, &["Temper", "alight"], &["0x0109", "@@"]);
    }
}

#[test]
fn diff_without_changed_meaning_shows_lines() {
    let project = project();
    project.append(LAMP, "# A remark.\n");
    says(
        &git(&project, &["diff"]),
        &["no change in meaning", "@@", "+# A remark."],
        &["FC07"],
    );
    project.append(LAMP, "commands: [\n");
    says(
        &git(&project, &["diff"]),
        &["@@", "+commands: ["],
        &["FC07", "the same"],
    );
}

#[test]
fn files_come_and_go() {
    let project = project();
    let path = "spec/commands/fan.yaml";
    let command = "  get_fan: { code: 0x0109, zh: 风扇, en: Fan, effect: read, source: { sections: [] }, response: { lit: { type: bool, example: true, zh: 亮, en: Lit } } }\n";
    project.write(
        path,
        &format!("group: {{ id: fan, zh: 风扇, en: Fan }}\n\ncommands:\n{command}"),
    );
    git(&project, &["add", "--all"]);
    says(
        &git(&project, &["diff", "--cached"]),
        &["get_fan"],
        &["@@", "set_level"],
    );
    commit(&project);
    git(&project, &["mv", path, "spec/commands/wind.yaml"]);
    change(&project, "spec/commands/wind.yaml", "0x0109", "0x010A");
    git(&project, &["add", "--all"]);
    let said = git(&project, &["diff", "--cached", "--find-renames=20%"]);
    says(&said, &["b/spec/commands/wind.yaml", "0x010A"], &["@@"]);
    git(
        &project,
        &["rm", "--quiet", "--force", "spec/commands/wind.yaml"],
    );
    says(&git(&project, &["diff", "--cached"]), &["get_fan"], &["@@"]);
}

#[test]
fn the_alias_says_the_same() {
    let project = project();
    change(&project, LAMP, "code: 0x0104", "code: 0x0109");
    project.write(
        "old.yaml",
        &git(&project, &["show", "HEAD:spec/commands/lamp.yaml"]),
    );
    let hex = "0000000000000000000000000000000000000000";
    let versions = [LAMP, "old.yaml", "1111111", "100644", LAMP, hex, "100644"];
    let run = |command: &[&str]| project.fc(&[command, &versions].concat()).expect(0).stdout;
    let said = run(&["git", "diff"]);
    says(&said, &["0x0109"], &[]);
    assert_eq!(said, run(&["git-diff"]));
}
