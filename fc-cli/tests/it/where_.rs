//! `fcproto where`.

use crate::support::Project;

/// A separate group, so that the tests do not depend on the content of the spec.
const GROUP: &str = "\
group: { id: lamp, zh: 灯, en: Lamp }
commands:
  # For tests.
  get_lamp_colour: # once
    code: 0x7F01
    zh: 获取颜色
    en: Get the colour
    effect: read
    source: { sections: [] }
    response:
      lampHue: { type: u8, example: 1, zh: 色相, en: Hue }
";

#[test]
fn a_name_or_code_leads_to_its_place() {
    let project = Project::new();
    project.write("spec/commands/lamp.yaml", GROUP);
    let operation =
        "spec/commands/lamp.yaml:4:3: command get_lamp_colour\n    # For tests.\n    # once\n";
    for name in ["get_lamp_colour", "0x7F01"] {
        let run = project.fc(&["where", name]).expect(0);
        assert_eq!(run.stdout, operation, "{name}");
        // The code may be outside of all ranges. Only `fcproto check` reports that.
        assert_eq!(run.stderr, "", "{name}");
    }
    for name in ["lampHue", "GetLampColourResponse.lampHue"] {
        let run = project.fc(&["where", name]).expect(0);
        let place = "spec/commands/lamp.yaml:11:7: field GetLampColourResponse.lampHue\n";
        assert_eq!(run.stdout, place, "{name}");
    }
}

#[test]
fn unknown_name_has_a_suggestion() {
    let project = Project::new();
    project.write("spec/commands/lamp.yaml", GROUP);
    let run = project.fc(&["where", "get_lamp_color"]).expect(2);
    assert_eq!(run.stdout, "");
    assert!(
        run.stderr.contains("did you mean `get_lamp_colour`?"),
        "{run:#?}"
    );
}

#[test]
fn kinds_follow_the_language() {
    let project = Project::new();
    project.write("spec/commands/lamp.yaml", GROUP);
    for (name, line) in [
        ("get_lamp_colour", ":4:3: 指令 get_lamp_colour\n"),
        ("lampHue", ":11:7: 字段 GetLampColourResponse.lampHue\n"),
        ("lamp", ": 分组 lamp\n"),
    ] {
        let run = project.fc(&["where", name, "--lang", "zh"]).expect(0);
        assert!(run.stdout.contains(line), "{run:#?}");
    }
}
