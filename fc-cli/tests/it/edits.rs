//! Commands that edit the spec, in projects of `init`. They keep files formatted and keep line ends and byte order
//! marks.

use crate::support::{Project, Run, command};

const LIGHT: &str = "lamp/spec/commands/light.yaml";

const BYTE_ORDER_MARK: &str = "\u{feff}";

/// Strings and their replacements.
type Changes<'t> = &'t [(&'t str, &'t str)];

/// Runs `init` in `lamp` and applies changes to a group.
fn lamp(changes: Changes<'_>) -> Project {
    let place = Project::empty();
    place.fc(&["init", "lamp"]).expect(0);
    change(&place, LIGHT, changes);
    place
}

fn change(place: &Project, path: &str, changes: Changes<'_>) {
    let mut text = place.read(path);
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    place.write(path, &text);
}

fn settle(place: &Project, args: &[&str]) -> Run {
    let date = ["--by", "me", "--date", "2026-11-23"];
    place.fc_in("lamp", &[&["settle"], args, &date].concat())
}

/// Checks that the spec is formatted and has neither errors nor findings.
fn is_sound(place: &Project) {
    place.fc_in("lamp", &["fmt", "--check"]).expect(0);
    let run = place.fc_in("lamp", &["check", "--deny", "warnings"]);
    run.expect(0);
    place
        .fc_in("lamp", &["lint", "--deny", "warnings"])
        .expect(0);
}

const CODE: (&str, &str) = ("    code: 0x0102\n", "    code: unassigned\n");
const REQUEST: &str = "    request:
      brightness: { type: u8, max: 100, unit: \"%\", example: 80, zh: 亮度, en: Brightness }
      mood: { type: \"Mood?\", zh: 色调；缺省为不变, en: \"Mood; absent leaves it as it is\" }
";

/// Settles each kind of fact that a spec can leave open.
#[test]
fn settle_works_in_a_project_of_init() {
    let body = "level: { type: u8, max: 100, example: 1, zh: 级别, en: Level }\n";
    let cases: [(Changes<'_>, &[&str]); 9] = [
        (&[CODE], &["set_light.code", "--code", "0x0102"]),
        (
            &[(
                "    code: 0x0102\n",
                "    code: { value: 0x0102, state: inferred }\n",
            )],
            &["set_light.code", "--confirm"],
        ),
        (
            &[("    effect: config\n", "    effect: unknown\n")],
            &["set_light.effect", "--effect", "config"],
        ),
        (
            &[(
                "    effect: config\n",
                "    effect: { value: config, state: inferred }\n",
            )],
            &["set_light.effect", "--confirm"],
        ),
        (
            &[(REQUEST, "    request_state: open\n")],
            &["set_light.request", "--request", "../body.yaml"],
        ),
        (
            &[(REQUEST, "    response_state: open\n")],
            &["set_light.response", "--response", "../body.yaml"],
        ),
        (
            &[(
                REQUEST,
                "    request_state: inferred\n    request:\n      level: { type: u8, max: 9, example: 1, zh: 级别, en: Level }\n",
            )],
            &["set_light.request", "--confirm"],
        ),
        (
            &[("    code: 0x0201\n", "    code: unassigned\n")],
            &["light_changed.code", "--code", "0x0201"],
        ),
        (
            &[(
                "    cadence: { on_change: brightness }\n    body:\n      brightness: { type: u8, max: 100, unit: \"%\", example: 80, zh: 亮度, en: Brightness }\n      mood: { type: Mood, zh: 色调, en: Mood }\n",
                "    cadence: { every_ms: 1000 }\n    request_state: open\n",
            )],
            &["light_changed.request", "--request", "../body.yaml"],
        ),
    ];
    for (changes, args) in cases {
        let place = lamp(changes);
        place.write("body.yaml", body);
        let asked = place.fc_in("lamp", &["questions"]).expect(0);
        assert!(asked.stdout.contains(args[0]), "{args:?}: {asked:#?}");
        settle(&place, args).expect(0);
        is_sound(&place);
        let asked = place.fc_in("lamp", &["questions"]).expect(0);
        assert_eq!(asked.stdout, "no questions\n", "{args:?}");
    }
}

/// The question states its fact, and the answer is long.
#[test]
fn settle_leaves_a_formatted_file() {
    let answer = "    answers:
      - as: question
        about: { code: open }
        zh: 功能码是多少？
        en: Which code is it?
";
    let place = lamp(&[CODE, (REQUEST, &format!("{REQUEST}{answer}"))]);
    place.fc_in("lamp", &["fmt", "--check"]).expect(0);
    let reply = "可以用 0x0102，".repeat(20);
    let args = ["set_light.code", "--code", "0x0102", "--reply", &reply];
    let run = settle(&place, &args).expect(0);
    is_sound(&place);
    // The output shows the lines as written.
    let text = place.read(LIGHT);
    let added = run.stdout.lines().filter_map(|line| line.strip_prefix('+'));
    for line in added {
        assert!(text.lines().any(|it| it == line), "{line}\n{text}");
    }
}

#[test]
fn retire_leaves_a_formatted_file() {
    let place = lamp(&[]);
    let why = "Replaced by the report on changes of the light. ".repeat(5);
    let args = [
        "retire",
        "get_light",
        "--zh",
        "由上报代替",
        "--en",
        why.trim(),
    ];
    place.fc_in("lamp", &args).expect(0);
    place.fc_in("lamp", &["fmt", "--check"]).expect(0);
    place.fc_in("lamp", &["check"]).expect(0);
}

#[test]
fn new_leaves_a_formatted_file_in_both_languages() {
    for lang in ["en", "zh"] {
        for kind in [&[][..], &["--report"], &["--stream"]] {
            let place = lamp(&[]);
            let new = ["new", "added", "--group", "light", "--lang", lang];
            place.fc_in("lamp", &[&new[..], kind].concat()).expect(0);
            place.fc_in("lamp", &["fmt", "--check"]).expect(0);
            let text = place.read(LIGHT);
            let comments = text.lines().filter_map(|line| line.split_once(" # "));
            for (_, comment) in comments {
                let is_chinese = comment.chars().any(|c| c > '\u{2fff}');
                assert_eq!(is_chinese, lang == "zh", "{comment}");
            }
        }
    }
}

#[test]
fn fix_leaves_a_formatted_file() {
    for (old, new) in [
        ("    effect: config\n", "    effect： config\n"),
        ("    effect: config\n", "    efect: config\n"),
        ("    effect: config\n", "    effect:config\n"),
        ("    zh: 设置灯光\n", "\t\tzh: 设置灯光\n"),
        ("zh: 灯光, en: Light }", "zh: 灯光, en: yes }"),
    ] {
        let place = lamp(&[(old, new)]);
        place.fc_in("lamp", &["check", "--fix"]).expect(0);
        place.fc_in("lamp", &["fmt", "--check"]).expect(0);
    }
}

/// An editor on Windows ends lines with CR LF and starts the file with a byte order mark.
#[test]
fn editing_commands_keep_line_ends_and_mark() {
    let answered = ["settle", "set_light.code", "--code", "0x0102", "--by", "me"];
    let retired = ["retire", "get_light", "--zh", "不用", "--en", "Unused"];
    let commands: [(Changes<'_>, &[&str]); 8] = [
        (&[], &["new", "added", "--group", "light"]),
        (&[], &["new", "added", "--group", "light", "--report"]),
        (&[], &["new", "added", "--group", "light", "--stream"]),
        (&[CODE], &answered),
        (&[], &retired),
        (
            &[("    effect: config\n", "    efect: config\n")],
            &["check", "--fix"],
        ),
        (
            &[("    effect: config\n", "    effect:   config\n")],
            &["fmt"],
        ),
        (&[], &["release", "2"]),
    ];
    for (changes, args) in commands {
        let place = lamp(changes);
        let paths = [LIGHT, "lamp/spec/protocol.yaml"];
        for path in paths {
            let text = place.read(path).replace('\n', "\r\n");
            place.write(path, &format!("{BYTE_ORDER_MARK}{text}"));
        }
        let before = paths.map(|path| place.read(path));
        place.fc_in("lamp", args).expect(0);
        let after = paths.map(|path| place.read(path));
        assert_ne!(before, after, "{args:?}");
        for text in after {
            let text = text.strip_prefix(BYTE_ORDER_MARK).expect("the mark");
            assert!(!text.contains(BYTE_ORDER_MARK), "{args:?}");
            let lines = text.matches('\n').count();
            assert_eq!(text.matches("\r\n").count(), lines, "{args:?}\n{text}");
        }
        place.fc_in("lamp", &["fmt", "--check"]).expect(0);
    }
}

#[test]
fn release_keeps_line_ends_and_mark_of_changelogs() {
    let place = lamp(&[]);
    place.fc_in("lamp", &["release", "1"]).expect(0);
    let paths = ["CHANGELOG.md", "CHANGELOG.en.md"];
    let paths = paths.map(|name| format!("lamp/spec/releases/{name}"));
    for path in &paths {
        let text = place.read(path).replace('\n', "\r\n");
        place.write(path, &format!("{BYTE_ORDER_MARK}{text}"));
    }
    let new = ["new", "added", "--group", "light"];
    place.fc_in("lamp", &new).expect(0);
    place.fc_in("lamp", &["release", "2"]).expect(0);
    for path in &paths {
        let text = place.read(path);
        assert_eq!(text.matches(BYTE_ORDER_MARK).count(), 1);
        assert!(text.starts_with(BYTE_ORDER_MARK));
        let lines = text.matches('\n').count();
        assert_eq!(text.matches("\r\n").count(), lines, "{text}");
    }
}

#[test]
fn standard_input_keeps_its_mark() {
    let text = format!("{BYTE_ORDER_MARK}group:  {{ id: a, zh: 甲, en: A }}\r\n");
    let run = Run::with_input(&mut command(&["fmt", "-"]), text);
    let expected = format!("{BYTE_ORDER_MARK}group: {{ id: a, zh: 甲, en: A }}\r\n");
    assert_eq!(run.stdout, expected);
}

/// The command changes the file and keeps the link to it.
#[cfg(unix)]
#[test]
fn a_linked_file_stays_linked() {
    let place = lamp(&[]);
    let text = place.read(LIGHT);
    place.write("shared.yaml", &text);
    std::fs::remove_file(place.path(LIGHT)).expect("removed");
    let link = place.path(LIGHT);
    std::os::unix::fs::symlink(place.path("shared.yaml"), &link).expect("a link");
    place
        .fc_in("lamp", &["new", "added", "--group", "light"])
        .expect(0);
    assert!(link.is_symlink());
    assert!(place.read("shared.yaml").contains("  added:\n"));
}
