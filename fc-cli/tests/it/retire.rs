//! `fcproto retire`.

use crate::support::Project;

/// A separate group, so that the tests do not depend on the content of the spec.
const GROUP: &str = "\
group: { id: fan, zh: 风扇, en: Fan }

commands:
  # Stays.
  get_fan:
    code: 0x0108
    zh: 查询风扇
    en: Get the fan
    effect: read
    source: { sections: [] }
    response:
      speed: { type: u8, example: 1, zh: 转速, en: Speed }

  # Goes,
  # with this.
  turn_fan: # and this
    code: 0x0109
    zh: 转动风扇
    en: Turn the fan
    effect: motion
    source: { sections: [] }
    request:
      blades: { type: [Blade], zh: 叶片, en: Blades }

reports:
  fan_stuck:
    code: 0x0208
    zh: 风扇卡住
    en: The fan is stuck
    source: { sections: [] }
    body:
      speed: { type: u8, example: 1, zh: 转速, en: Speed }

types:
  # Of a blade.
  Blade:
    zh: 叶片
    en: Blade
    fields:
      tilt: { type: Tilt, zh: 倾角, en: Tilt }

  Tilt:
    zh: 倾角
    en: Tilt
    enum: u8
    values:
      0: { name: flat, zh: 平, en: Flat }
";

const FAN: &str = "spec/commands/fan.yaml";

fn project() -> Project {
    let project = Project::new();
    project.write(FAN, GROUP);
    project.fc(&["check"]).expect(0);
    project
}

fn without(from: &str, to: &str) -> String {
    let (head, rest) = GROUP.split_once(from).expect("its beginning");
    let end = rest.find(to).expect("what follows");
    format!("{head}{}", rest.get(end..).expect("the rest"))
}

#[test]
fn retire_removes_comments_and_types_keeps_code() {
    let project = project();
    let protocol = project.read("spec/protocol.yaml");
    let call = [
        "retire",
        "turn_fan",
        "--zh",
        "没人用",
        "--en",
        "\"Nobody\" uses it",
    ];
    let dry = project.fc(&[&call[..], &["--dry-run"]].concat()).expect(0);
    assert!(dry.stdout.contains("\n-  # with this.\n"), "{dry:#?}");
    let end = "would retire turn_fan and its code 0x0109, with Blade, Tilt\n";
    assert!(dry.stdout.ends_with(end), "{dry:#?}");
    assert_eq!(project.read(FAN), GROUP);

    let run = project.fc(&call).expect(0);
    assert!(
        run.stdout
            .contains("retired turn_fan and its code 0x0109, with Blade, Tilt\n")
    );
    let left = without("\n  # Goes,", "\nreports:");
    let left = left
        .split("\ntypes:")
        .next()
        .expect("what is before the types");
    assert_eq!(project.read(FAN), left);
    let known = "    - { code: 0x0103, zh: 曾用于 a|b, en: Once used for a|b }\n";
    let new = "    - { code: 0x0109, zh: \"没人用\", en: '\"Nobody\" uses it' }\n";
    let expected = protocol.replace(known, &format!("{known}{new}"));
    assert_eq!(project.read("spec/protocol.yaml"), expected);

    project.fc(&["check"]).expect(0);
    let code = project.fc(&["codes", "0x0109"]).expect(0);
    assert_eq!(code.stdout, "0x0109  retired: \"Nobody\" uses it\n");
    let again = ["new", "spin_fan", "--group", "fan", "--code", "0x0109"];
    let again = project.fc(&again).expect(2);
    assert!(again.stderr.contains("is retired"), "{again:#?}");
}

#[test]
fn the_last_of_a_section_takes_the_section_along() {
    let project = project();
    project
        .fc(&["retire", "fan_stuck", "--zh", "无", "--en", "None"])
        .expect(0);
    assert_eq!(project.read(FAN), without("\nreports:", "\ntypes:"));
    project.fc(&["check"]).expect(0);
}

#[test]
fn a_spec_without_retired_codes_gets_a_list_of_them() {
    let project = project();
    let protocol = project.read("spec/protocol.yaml");
    let (before, rest) = protocol.split_once("  retired:\n").expect("the list");
    let (item, after) = rest.split_once('\n').expect("its only item");
    assert!(item.starts_with("    - "), "{item}");
    project.write("spec/protocol.yaml", &format!("{before}{after}"));
    let call = ["retire", "turn_fan", "--zh", "无", "--en", "None"];
    project.fc(&call).expect(0);
    let list = "  retired:\n    - { code: 0x0109, zh: \"无\", en: \"None\" }\n";
    assert_eq!(
        project.read("spec/protocol.yaml"),
        format!("{before}{list}{after}")
    );
    project.fc(&["check"]).expect(0);
}

#[test]
fn retire_reports_uses_shared_and_missing_codes() {
    let project = project();
    let why = ["--zh", "无", "--en", "None"];
    let retire = |name| project.fc(&[&["retire", name][..], &why].concat());
    // A deprecated command names it as its replacement.
    let run = retire("level_changed").expect(2);
    assert!(
        run.stderr.contains("the spec would have errors"),
        "{run:#?}"
    );
    assert!(run.stderr.contains("level_changed"), "{run:#?}");
    let run = retire("turn_fans").expect(2);
    assert!(run.stderr.contains("did you mean `turn_fan`?"), "{run:#?}");
    // A stream shares the code of its command, which stays in use.
    let run = retire("glow").expect(0);
    assert!(run.stdout.contains("retired glow\n"), "{run:#?}");
    let code = project.fc(&["codes", "0x0101"]).expect(0);
    assert!(!code.stdout.contains("retired"), "{code:#?}");
}

#[test]
fn retire_refuses_flow_style() {
    let project = project();
    let flow = "group: { id: fan, zh: 风扇, en: Fan }\nreports: { fan_stuck: { code: 0x0208, zh: 卡住, en: Stuck, source: { sections: [] } } }\n";
    project.write(FAN, flow);
    project.fc(&["check"]).expect(0);
    let run = project.fc(&["retire", "fan_stuck", "--zh", "无", "--en", "None"]);
    let run = run.expect(2);
    assert!(
        run.stderr
            .contains("`fan_stuck` in spec/commands/fan.yaml is written in braces"),
        "{run:#?}"
    );
    assert_eq!(project.read(FAN), flow);
}
