//! `fcproto new`.

use crate::support::Project;

#[test]
fn a_command_begins_with_the_next_free_code() {
    let project = Project::new();
    let before = project.read("spec/commands/lamp.yaml");
    let run = project
        .fc(&["new", "get_battery", "--group", "lamp"])
        .expect(0);
    let said = run.stdout.lines().next().expect("a line");
    let (begun, line) = said
        .split_once(" in spec/commands/lamp.yaml:")
        .expect("the place");
    let code = begun.strip_prefix("added get_battery as ").expect("a code");
    let line: usize = line.parse().expect("a line number");

    let after = project.read("spec/commands/lamp.yaml");
    let mut lines: Vec<&str> = after.lines().collect();
    let length = lines.iter().skip(line).take_while(|line| !line.is_empty());
    let new: Vec<&str> = lines.drain(line - 2..line + length.count()).collect();
    assert_eq!(new.first(), Some(&""));
    assert_eq!(new.get(1), Some(&"  get_battery:"));
    assert_eq!(new.get(2), Some(&format!("    code: {code}").as_str()));
    assert_eq!(
        lines,
        before.lines().collect::<Vec<_>>(),
        "the rest is as it was"
    );
    // The spec is valid, and the next command gets another code.
    project.fc(&["check"]).expect(0);
    let again = project
        .fc(&["new", "get_voltage", "--group", "lamp"])
        .expect(0);
    assert!(!again.stdout.contains(code), "{again:#?}");
}

/// A group gets codes from the ranges that name it. Without such a range, it uses ranges that name no group, starting
/// with one where it already has codes.
#[test]
fn the_code_comes_from_the_range_of_the_group() {
    let project = Project::new();
    let protocol = project.read("spec/protocol.yaml");
    let with = |ranges: &str| {
        let text = protocol.replacen("  ranges:\n", &format!("  ranges:\n{ranges}"), 1);
        project.write("spec/protocol.yaml", &text);
        project.fc(&["check"]).expect(0);
    };
    let range = |first: &str, last: &str, groups: &str| {
        format!(
            "    - {{ from: {first}, to: {last}, use: commands, {groups}zh: 指令, en: Commands }}\n"
        )
    };
    let group = |id: &str, code: &str| {
        let text = format!(
            "group: {{ id: {id}, zh: 分组, en: Group }}\n\ncommands:\n  get_{id}: {{ code: {code}, zh: 读取, en: Get, effect: read, source: {{ sections: [] }} }}\n"
        );
        project.write(&format!("spec/commands/{id}.yaml"), &text);
    };
    group("control", "0x0C05");
    group("arm", "unassigned");
    let next = |group: &str, code: &str| {
        let before = project.read(&format!("spec/commands/{group}.yaml"));
        let run = project.fc(&["new", "added", "--group", group]).expect(0);
        assert!(
            run.stdout.contains(&format!(" as {code}")),
            "{group}: {run:#?}"
        );
        project.write(&format!("spec/commands/{group}.yaml"), &before);
    };
    let all = [range("0x0B01", "0x0B0F", ""), range("0x0C01", "0x0C0F", "")].concat();
    with(&all);
    next("control", "0x0C06");
    next("arm", "0x01");
    let named = "groups: [arm, control], ";
    with(&[&all, range("0x0D01", "0x0D02", named).as_str()].concat());
    next("control", "0x0D01");
    next("arm", "0x0D01");

    // A full range of the group does not fall back to other ranges.
    for name in ["one", "two"] {
        project.fc(&["new", name, "--group", "arm"]).expect(0);
    }
    let run = project.fc(&["new", "added", "--group", "arm"]).expect(2);
    let message = "no code is free in the ranges of the group `arm`";
    assert!(run.stderr.contains(message), "{run:#?}");
    let other = ["new", "added", "--group", "lamp", "--code", "0x0D02"];
    project
        .fc(&["retire", "two", "--zh", "不用", "--en", "Unused"])
        .expect(0);
    let run = project.fc(&other).expect(2);
    assert!(run.stderr.contains("is retired"), "{run:#?}");
    let wide = range("0x0D01", "0x0D0F", named);
    with(&[&all, wide.as_str()].concat());
    let other = ["new", "added", "--group", "lamp", "--code", "0x0D0F"];
    let run = project.fc(&other).expect(2);
    let message = "0x0D0F is in the range 0x0D01 to 0x0D0F, which is for arm, control";
    assert!(run.stderr.contains(message), "{run:#?}");
    let run = project.fc(&["codes"]).expect(0);
    assert!(run.stdout.contains("commands (arm, control)"), "{run:#?}");
}

#[test]
fn new_report_follows_the_reports() {
    let project = Project::new();
    let before = project.read("spec/commands/lamp.yaml");
    let run = project.fc(&["new", "battery_low", "--group", "lamp", "--report"]);
    assert!(run.expect(0).stdout.contains(" as 0x0203 "));
    let after = project.read("spec/commands/lamp.yaml");
    let reports = after.find("\nreports:\n").expect("reports");
    assert!(after.find("\n  battery_low:\n").expect("the report") > reports);
    assert!(after.len() > before.len());
    // A group without reports gets the section.
    project.write(
        "spec/commands/identity.yaml",
        "group: { id: identity, zh: 标识, en: Identity }

commands:
  get_serial: { code: 0x010F, zh: 序列号, en: Serial, effect: read, source: { sections: [] } }
",
    );
    project
        .fc(&["new", "door_left_open", "--group", "identity", "--report"])
        .expect(0);
    let identity = project.read("spec/commands/identity.yaml");
    assert!(
        identity.contains("\nreports:\n  door_left_open:\n"),
        "{identity}"
    );
    project.fc(&["check"]).expect(0);
    project.fc(&["generate"]).expect(0);
}

/// A stream has the code of the command that starts it, a separate code, or no code yet.
#[test]
fn a_stream_shares_the_code_of_its_command() {
    let project = Project::new();
    let add = |arguments: &[&str]| {
        let all = [&["new"], arguments, &["--group", "lamp", "--stream"]].concat();
        project.fc(&all).expect(0).stdout
    };
    let command = ["new", "watch_heat", "--group", "lamp"];
    let said = project.fc(&command).expect(0).stdout;
    let code = said.split_once(" as ").expect("a code").1;
    let code = code.split(' ').next().expect("a code").to_owned();
    let said = add(&["heat", "--started-by", "watch_heat"]);
    assert!(said.contains(&format!("heat as {code} ")), "{said}");
    assert!(add(&["film"]).contains("film without a code "));
    let said = add(&["sound", "--code", "0x0502"]);
    assert!(said.contains("sound as 0x0502 "), "{said}");
    let lamp = project.read("spec/commands/lamp.yaml");
    let streams = lamp.find("\nstreams:\n").expect("streams");
    let begun = format!("\n  heat:\n    code: {code}\n");
    assert!(lamp.find(&begun).expect("the stream") > streams);
    assert!(lamp.contains("\n    started_by: watch_heat\n"), "{lamp}");
    project.fc(&["check"]).expect(0);
    project.fc(&["generate"]).expect(0);
}

#[test]
fn refused_operation_changes_nothing() {
    let project = Project::new();
    let before = project.files("spec");
    for (arguments, status, said) in [
        (
            &["Battery", "--group", "lamp"][..],
            2,
            "is not a snake_case name",
        ),
        (&["a: b", "--group", "lamp"], 2, "is not a snake_case name"),
        (
            &["get_battery", "--group", "power"],
            2,
            "the groups are lamp",
        ),
        (
            &["set_level", "--group", "lamp"],
            2,
            "`set_level` already exists, in spec/commands/lamp.yaml:",
        ),
        (
            &["get_battery", "--group", "lamp", "--code", "0x0101"],
            2,
            "0x0101 is the code of `set_level`, in spec/commands/lamp.yaml:",
        ),
        (
            &["get_battery", "--group", "lamp", "--code", "0x0503"],
            2,
            "0x0503 is in the range 0x0500 to 0x0503, which is closed for new operations; the next free code is 0x01",
        ),
        (
            &["get_battery", "--group", "lamp", "--code", "0x020A"],
            2,
            "which is for reports, and this is a command",
        ),
        (
            &["get_battery", "--group", "lamp", "--code", "0xFFFF"],
            2,
            "0xFFFF is outside all code ranges; the next free code is 0x01",
        ),
        (
            &["get_battery", "--group", "lamp", "--code", "65536"],
            2,
            "from 0x0000 to 0xFFFF",
        ),
        (
            &["film", "--group", "lamp", "--stream", "--code", "0x0101"],
            2,
            "0x0101 is the code of `set_level`, in spec/commands/lamp.yaml:",
        ),
        (
            &[
                "film",
                "--group",
                "lamp",
                "--stream",
                "--started-by",
                "alarm",
            ],
            2,
            "there is no command `alarm`",
        ),
        (
            &["film", "--group", "lamp", "--started-by", "set_level"],
            2,
            "--stream",
        ),
        (&["get_battery"], 2, "--group"),
    ] {
        let run = project.fc(&[&["new"], arguments].concat()).expect(status);
        assert!(run.stderr.contains(said), "{said:?} in {}", run.stderr);
        assert_eq!(run.stdout, "");
        // Messages do not point into text that is not on disk.
        assert!(!run.stderr.contains("-->"), "{}", run.stderr);
    }
    assert_eq!(project.files("spec"), before);
}

/// The test creates the groups of the examples in another spec, where the names are free.
#[test]
fn the_examples_of_the_help_run() {
    let project = Project::new();
    let help = project.fc(&["new", "--help"]).expect(0).stdout;
    let examples: Vec<Vec<&str>> = help
        .lines()
        .filter_map(|line| line.trim().strip_prefix("fcproto new "))
        .map(|arguments| arguments.split(' ').collect())
        .collect();
    assert!(examples.len() >= 3, "{help}");
    let protocol = project.read("spec/protocol.yaml");
    let more = "    - { from: 0x0A01, to: 0x0AFF, use: commands, zh: 指令, en: Commands }";
    let ranges = format!("  ranges:\n{more}\n");
    project.write(
        "spec/protocol.yaml",
        &protocol.replacen("  ranges:\n", &ranges, 1),
    );
    for (number, example) in examples.iter().enumerate() {
        let at = example.iter().position(|word| *word == "--group");
        let group = at
            .and_then(|at| example.get(at + 1))
            .expect("it names a group");
        let path = format!("spec/commands/{group}.yaml");
        if !project.path(&path).exists() {
            project.write(
                &path,
                &format!(
                    "group: {{ id: {group}, zh: 分组, en: A group }}

commands:
  first_{number}: {{ code: 0x0AF{number}, zh: 指令, en: A command, effect: read, source: {{ sections: [] }} }}
"
                ),
            );
        }
        project
            .fc(&[&["new"], example.as_slice()].concat())
            .expect(0);
        project.fc(&["check"]).expect(0);
    }
}

/// A placeholder text is a warning in every format until it is replaced.
#[test]
fn placeholder_is_a_warning() {
    let project = Project::new();
    project
        .fc(&["new", "get_battery", "--group", "lamp"])
        .expect(0);
    let run = project.fc(&["check"]).expect(0);
    let said = "warning[FC0613]: this text is a placeholder";
    assert!(run.stderr.contains(said), "{run:#?}");
    assert!(run.stdout.contains("checked "), "{run:#?}");
    let run = project.fc(&["generate"]).expect(0);
    assert!(run.stderr.contains(said), "{run:#?}");
    for (format, said) in [
        ("json", "\"severity\":\"warning\""),
        ("sarif", "\"level\": \"warning\""),
        ("github", "::warning file=spec/commands/lamp.yaml,"),
    ] {
        let run = project.fc(&["check", "--format", format]).expect(0);
        assert!(run.stdout.contains(said), "{run:#?}");
    }
}
