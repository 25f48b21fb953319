//! `fcproto release`, and commands that need a release: `fcproto diff` without a version, `fcproto changelog` and
//! `fcproto generate --as-of`.

mod waivers;

use crate::support::Project;
use serde_json::Value;

const NEW: &str = "
  get_warmth:
    code: 0x0108
    zh: 查询色温
    en: Get the warmth
    effect: read
    source: { sections: [] }
    response:
      kelvin: { type: u16, example: 4000, zh: 色温, en: Colour temperature }
";

/// Creates a project that has released version 7 of its spec.
fn released() -> Project {
    let project = Project::new();
    project
        .fc(&["release", "7", "--today", "2026-09-01"])
        .expect(0);
    project
}

fn change(project: &Project, file: &str, from: &str, to: &str) {
    let path = format!("spec/{file}");
    let text = project.read(&path);
    assert!(text.contains(from), "{from}");
    project.write(&path, &text.replacen(from, to, 1));
}

/// Adds a command at the start of the first group.
fn add_command(project: &Project) {
    change(
        project,
        "commands/lamp.yaml",
        "\ncommands:\n",
        &format!("\ncommands:{NEW}"),
    );
}

/// Changes the wire format.
fn break_it(project: &Project) {
    change(
        project,
        "commands/lamp.yaml",
        "code: 0x0104",
        "code: 0x0109",
    );
}

#[test]
fn release_freezes_the_spec_and_lists_changes() {
    let project = released();
    assert_eq!(
        project.read("spec/releases/CHANGELOG.md"),
        "# 协议变更记录\n\n## 7 (2026-09-01)\n\n首次发布，共 8 个接口。\n"
    );
    let dump: Value = serde_json::from_str(&project.read("spec/releases/7.json")).expect("JSON");
    assert_eq!(dump["protocol"]["version"], "7");
    assert_eq!(project.fc(&["diff"]).expect(0).stdout, "no changes\n");

    add_command(&project);
    let unreleased = "\
## Unreleased

### New

- `get_warmth` (0x0108): Get the warmth
";
    assert_eq!(project.fc(&["changelog"]).expect(0).stdout, unreleased);
    let run = project.fc(&["release", "7.1", "--dry-run"]).expect(0);
    assert!(run.stdout.contains("+  version: \"7.1\""), "{run:#?}");
    assert!(!project.path("spec/releases/7.1.json").exists());

    let run = project
        .fc(&["release", "7.1", "--today", "2026-12-01"])
        .expect(0);
    assert_eq!(
        run.stdout,
        "\
released 7.1
  spec/releases/7.1.json
  spec/releases/CHANGELOG.md
  spec/releases/CHANGELOG.en.md
  spec/protocol.yaml
run `fcproto generate`, commit, and tag the commit
"
    );
    assert_eq!(
        project.read("spec/releases/CHANGELOG.en.md"),
        "\
# Changes of the protocol

## 7.1 (2026-12-01)

### New

- `get_warmth` (0x0108): Get the warmth

## 7 (2026-09-01)

First release, with 8 operations.
"
    );
    assert!(
        project
            .read("spec/protocol.yaml")
            .contains("  version: \"7.1\"\n")
    );
    let run = project
        .fc(&["changelog", "7", "7.1", "--lang", "zh"])
        .expect(0);
    assert_eq!(
        run.stdout,
        "## 7.1\n\n### 新增\n\n- `get_warmth`（0x0108）：查询色温\n"
    );
}

#[test]
fn unfit_release_number_writes_nothing() {
    let project = released();
    let before = project.files("spec");
    let refused = |number: &str, why: &str| {
        let run = project.fc(&["release", number]).expect(1);
        assert!(run.stderr.contains(why), "{run:#?}");
    };
    refused("8", "there are no changes since the last release");
    assert_eq!(project.files("spec"), before);
    add_command(&project);
    break_it(&project);
    let before = project.files("spec");
    refused("7", "the last release is 7; choose a later number");
    refused("7.1", "the first part of the number has to rise");
    refused("2026.12", "waive each of them: FC0717-");
    assert_eq!(project.files("spec"), before);
    project.fc(&["release", "8"]).expect(0);
    let run = project.fc(&["release", "v9"]).expect(2);
    assert!(run.stderr.contains("such as 2026.12 or 2.1.0"), "{run:#?}");
}

/// Adds a field to the request of `set_level`.
fn add_field(project: &Project, field: &str) {
    let last = "          deprecated: { since: 2024-06, zh: 不再使用, en: No longer used }\n";
    change(
        project,
        "commands/lamp.yaml",
        last,
        &format!("{last}{field}"),
    );
}

#[test]
fn optional_field_added_breaks_nothing() {
    let project = released();
    add_field(
        &project,
        "        heat: { type: \"u8?\", example: 3, zh: 热度, en: Heat }\n",
    );
    project
        .fc(&["diff", "--fail-on", "wire,source,behaviour"])
        .expect(0);
    let changelog = project.fc(&["changelog"]).expect(0).stdout;
    let changed = "### Changed\n\n- set_level.request.data.heat: an optional field is new (heat)\n";
    assert!(changelog.contains(changed), "{changelog}");
    project.fc(&["release", "7.1", "--dry-run"]).expect(0);
}

#[test]
fn key_back_with_another_type_breaks_a_release() {
    let project = Project::new();
    let heat = "        heat: { type: \"u8?\", example: 3, zh: 热度, en: Heat }\n";
    add_field(&project, heat);
    project
        .fc(&["release", "7", "--today", "2026-09-01"])
        .expect(0);
    change(&project, "commands/lamp.yaml", heat, "");
    project
        .fc(&["release", "7.1", "--today", "2026-10-01"])
        .expect(0);
    project.fc(&["diff", "--fail-on", "breaking"]).expect(0);

    add_field(
        &project,
        "        heat: { type: \"string?\", example: a, zh: 热度, en: Heat }\n",
    );
    let run = project.fc(&["diff", "--fail-on", "breaking"]).expect(1);
    let found = "FC0776 set_level.request.data.heat: an earlier release used this for something else (u8 (7) → string)\n";
    assert!(run.stdout.contains(found), "{run:#?}");
    assert!(run.stdout.contains("FC0763"), "{run:#?}");
    // A comparison of earlier releases ignores later ones.
    project
        .fc(&["diff", "7", "7.1", "--fail-on", "breaking"])
        .expect(0);
    let run = project.fc(&["release", "7.2"]).expect(1);
    assert!(
        run.stderr
            .contains("the first part of the number has to rise"),
        "{run:#?}"
    );
    let changelog = project.fc(&["changelog"]).expect(0).stdout;
    assert!(
        changelog.contains("### Breaking\n\n- set_level.request.data.heat"),
        "{changelog}"
    );
    project.fc(&["release", "8", "--dry-run"]).expect(0);
}

#[test]
fn unit_changed_needs_a_major_release() {
    let project = released();
    change(
        &project,
        "types.yaml",
        "size: { type: u16, unit: mm",
        "size: { type: u16, unit: m",
    );
    project.fc(&["diff", "--fail-on", "breaking"]).expect(1);
    let run = project.fc(&["release", "7.1"]).expect(1);
    assert!(
        run.stderr
            .contains("the first part of the number has to rise"),
        "{run:#?}"
    );
    let changelog = project.fc(&["changelog"]).expect(0).stdout;
    assert!(
        changelog.contains("### Breaking\n\n- Spot.size: a number is in another unit (mm → m)"),
        "{changelog}"
    );
}

#[test]
fn refers_changed_breaks_sources_with_newtypes() {
    let project = Project::new();
    change(
        &project,
        "protocol.yaml",
        "  person: {",
        "  shade: { zh: 灯罩, en: Shade }\n  person: {",
    );
    let scene = "scene: { type: \"u32?\", refers: scene, example: 7";
    let shade = "shade: { type: \"u32?\", refers: shade, example: 8, zh: 灯罩, en: Shade }";
    change(
        &project,
        "commands/lamp.yaml",
        scene,
        &format!("{shade}\n      {scene}"),
    );
    project
        .fc(&["release", "7", "--today", "2026-09-01"])
        .expect(0);
    let shade = scene.replace("refers: scene", "refers: shade");
    change(&project, "commands/lamp.yaml", scene, &shade);
    project.fc(&["diff", "--fail-on", "source"]).expect(0);
    project.write("fc.yaml", "targets:\n  rust: { newtypes: true }\n");
    let run = project.fc(&["diff", "--fail-on", "source"]).expect(1);
    assert!(
        run.stdout.contains("FC0775 get_level.response.scene: "),
        "{run:#?}"
    );
    assert!(run.stdout.contains("sources in Rust, Kotlin"), "{run:#?}");
}

#[test]
fn old_release_is_generated_again() {
    let project = released();
    project.fc(&["generate"]).expect(0);
    let before = project.read("fc-generated/vectors/frames.json");
    let messages = project.read("fc-generated/src/lib.rs");
    add_command(&project);
    break_it(&project);
    project.fc(&["generate"]).expect(0);
    project
        .fc(&["generate", "--as-of", "7", "--out", "old"])
        .expect(0);
    assert_eq!(project.read("old/fc-generated/vectors/frames.json"), before);
    assert_eq!(project.read("old/fc-generated/src/lib.rs"), messages);
    project
        .fc(&["generate", "--as-of", "7", "--out", "old", "--check"])
        .expect(0);

    let run = project
        .fc(&["generate", "--as-of", "6", "--out", "old"])
        .expect(2);
    assert!(
        run.stderr.contains("there is no release `6`; there are 7"),
        "{run:#?}"
    );
    project.fc(&["generate", "--as-of", "7"]).expect(2);
}

#[test]
fn first_release_is_at_least_the_spec_version() {
    let project = Project::new();
    let before = project.files("spec");
    let run = project.fc(&["release", "6.9"]).expect(1);
    assert_eq!(
        run.stderr,
        "error: the version of the spec is 7; choose that or a later number\n6.9 is not released\n"
    );
    let run = project
        .fc(&["release", "7", "--dry-run", "--today", "2026-09-01"])
        .expect(0);
    assert_eq!(
        run.stdout,
        "\
would release 7

## 7 (2026-09-01)

首次发布，共 8 个接口。

## 7 (2026-09-01)

First release, with 8 operations.
"
    );
    assert_eq!(project.files("spec"), before);

    // The release exists already, also with trailing zeros.
    project.fc(&["release", "7"]).expect(0);
    let before = project.files("spec");
    for number in ["7", "7.0"] {
        let run = project.fc(&["release", number]).expect(1);
        let said = "error: the last release is 7; choose a later number\n";
        assert!(run.stderr.starts_with(said), "{run:#?}");
    }
    assert_eq!(project.files("spec"), before);

    // A version that was raised by hand stays.
    add_command(&project);
    change(
        &project,
        "protocol.yaml",
        "version: \"7\"",
        "version: \"7.3\"",
    );
    let run = project.fc(&["release", "7.2"]).expect(1);
    assert!(
        run.stderr.contains("the version of the spec is 7.3"),
        "{run:#?}"
    );
    project.fc(&["release", "7.3"]).expect(0);
}

#[test]
fn changelog_keeps_handwritten_text() {
    let project = released();
    let path = "spec/releases/CHANGELOG.en.md";
    let old = "## 7 (2026-09-01)\n\nFirst release. Thanks to all.\n\n## 6\n\nLost.\n";
    for head in ["", "# Our changes\n\nA word before.\n\n"] {
        project.write(path, &format!("{head}{old}"));
        std::fs::remove_file(project.path("spec/releases/7.1.json")).ok();
        if head.is_empty() {
            add_command(&project);
        }
        project
            .fc(&["release", "7.1", "--today", "2026-12-01"])
            .expect(0);
        let new = "## 7.1 (2026-12-01)\n\n### New\n\n- `get_warmth` (0x0108): Get the warmth\n\n";
        assert_eq!(project.read(path), format!("{head}{new}{old}"));
    }
}

#[test]
fn a_spec_with_errors_is_not_released() {
    let project = released();
    change(
        &project,
        "commands/lamp.yaml",
        "effect: motion",
        "effect: red",
    );
    let before = project.files("spec");
    let run = project.fc(&["release", "8"]).expect(1);
    assert!(run.stderr.contains("`red`"), "{run:#?}");
    assert_eq!(project.files("spec"), before);
}

#[test]
fn a_release_that_cannot_be_read_is_named() {
    let project = released();
    project.write("spec/releases/8.json", r#"{ "format": 99 }"#);
    // A file whose name is not a number is not a release.
    project.write("spec/releases/draft.json", "{}");
    for arguments in [
        &["diff"][..],
        &["changelog"],
        &["release", "9"],
        &["generate", "--as-of", "8", "--out", "old"],
    ] {
        let run = project.fc(arguments).expect(2);
        let said = "a dump of format 99; this version reads format";
        assert!(run.stderr.contains(said), "{run:#?}");
        assert!(run.stderr.contains('8'), "{run:#?}");
    }
    let run = project.fc(&["diff", "draft"]).expect(2);
    assert!(run.stderr.contains("cannot read `draft`"), "{run:#?}");
    project.fc(&["diff", "7"]).expect(0);
    let run = project.fc(&["diff", "6.2"]).expect(2);
    assert_eq!(
        run.stderr,
        "error: there is no release `6.2`; there are 7, 8\n"
    );

    std::fs::remove_dir_all(project.path("spec/releases")).expect("removed");
    project.write("spec/releases", "");
    let run = project.fc(&["diff"]).expect(2);
    assert!(run.stderr.contains("cannot read `"), "{run:#?}");
    assert!(run.stderr.contains("spec/releases"), "{run:#?}");
}

/// A directory with the name of a release is not used instead of it.
#[test]
fn a_release_counts_before_a_directory_of_its_name() {
    let project = released();
    project.write("7/nothing", "");
    assert_eq!(project.fc(&["diff"]).expect(0).stdout, "no changes\n");
    let run = project.fc(&["diff", "./7"]).expect(2);
    assert!(
        run.stderr.contains("`./7` is not a directory with a spec"),
        "{run:#?}"
    );
}

#[test]
fn changelog_has_the_part_of_an_audience() {
    let project = released();
    let unknown = project.fc(&["changelog", "--for", "nobody"]).expect(2);
    assert!(unknown.stderr.contains("nobody"), "{unknown:#?}");
    let run = project.fc(&["changelog", "--for", "user_app"]).expect(0);
    assert_eq!(run.stdout, "## Unreleased\n\nNothing has changed.\n");

    change(
        &project,
        "protocol.yaml",
        "    tester_app:",
        "    new_app: { zh: 新 app, en: new app }\n    tester_app:",
    );
    let only = NEW.replace(
        "    effect: read",
        "    effect: read\n    available: { for: [new_app] }",
    );
    change(
        &project,
        "commands/lamp.yaml",
        "\ncommands:\n",
        &format!("\ncommands:{only}"),
    );
    let of = |audience: &str| {
        project
            .fc(&["changelog", "--for", audience])
            .expect(0)
            .stdout
    };
    assert!(!of("user_app").contains("get_warmth"));
    // The last release does not contain the command.
    assert!(of("new_app").contains("- `get_warmth` (0x0108): Get the warmth\n"));
}

#[test]
fn first_release_has_no_comparison() {
    let project = Project::new();
    for command in ["diff", "changelog"] {
        let run = project.fc(&[command]).expect(2);
        assert!(
            run.stderr.contains("there is no release to compare with"),
            "{run:#?}"
        );
    }
}
