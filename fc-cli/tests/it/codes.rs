//! `fcproto codes`.

use crate::support::Project;
use serde_json::{Value, json};

const MAP: &str = "\
next command  0x0105
next report   0x0203

0x0100–0x010F · Commands · new commands, 12 free
  0x0101  set_level  Set the level <T> · command · spec/commands/lamp.yaml:8
  0x0101  glow       Glow · stream · spec/commands/lamp.yaml:167
  0x0102  get_level  Get the level · command · spec/commands/lamp.yaml:93
  0x0103  retired: Once used for a|b
  0x0104  probe      Command of unknown purpose · command · spec/commands/lamp.yaml:120

0x0200–0x020F · Reports · new reports, 14 free
  0x0201  level_changed  The level has changed · report · spec/commands/lamp.yaml:129
  0x0202  alarm          Alarm · report · spec/commands/lamp.yaml:146

0x0300–0x0303 · Handed on · passed through to the upper body, 4 free

0x0400–0x04FF · Kept · reserved

0x0500–0x0503 · Old streams · historic, closed
  0x0500  firmware  Firmware · stream · spec/commands/lamp.yaml:158

Without a code
  dim
";

#[test]
fn codes_list_owners_and_the_next_free_code() {
    assert_eq!(Project::new().fc(&["codes"]).expect(0).stdout, MAP);
    let chinese = Project::new().fc(&["codes", "--lang", "zh"]).expect(0);
    for line in [
        "下一个指令  0x0105",
        "0x0100–0x010F · 指令 · 新增指令，剩余 12 个",
        "  0x0103  已退役：曾用于 a|b",
        "还没有功能码",
    ] {
        assert!(chinese.stdout.lines().any(|it| it == line), "{line}");
    }
}

#[test]
fn codes_show_the_state_of_single_codes() {
    let codes = "codes 0x0101 259 0x0105 0x0203 0x0300 0x0400 0x0501 0x9999";
    let codes: Vec<&str> = codes.split(' ').collect();
    let run = Project::new().fc(&codes).expect(0);
    let expected = "\
0x0101  set_level  Set the level <T> · command · spec/commands/lamp.yaml:8
0x0101  glow  Glow · stream · spec/commands/lamp.yaml:167
0x0103  retired: Once used for a|b
0x0105  free, for a command
0x0203  free, for a report
0x0300  free, passed through to the upper body
0x0400  not to be given out
0x0501  closed, not to be given out
0x9999  in none of the ranges
";
    assert_eq!(run.stdout, expected);
    let wrong = Project::new().fc(&["codes", "0x10000"]).expect(2);
    assert!(wrong.stderr.contains("from 0x0000 to 0xFFFF"), "{wrong:#?}");
}

#[test]
fn the_next_code_is_the_one_that_new_gives_out() {
    let project = Project::new();
    let next = |key: &str| {
        let run = project.fc(&["codes", "--format", "json"]).expect(0);
        let map: Value = serde_json::from_str(&run.stdout).expect("JSON");
        map[key].as_str().map(str::to_owned).expect("a code")
    };
    for (key, options) in [("next_command", ""), ("next_report", "--report")] {
        let code = next(key);
        let name = format!("added_{key}");
        let call = format!("new {name} --group lamp {options}");
        let run = project
            .fc(&call.split_whitespace().collect::<Vec<_>>())
            .expect(0);
        assert!(run.stdout.contains(&format!("as {code} ")), "{run:#?}");
        assert_ne!(next(key), code);
    }
}

#[test]
fn json_has_both_languages() {
    let run = Project::new().fc(&["codes", "--format", "json"]).expect(0);
    let map: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(map["without"], json!(["dim"]));
    let first = &map["ranges"][0];
    assert_eq!(
        (&first["free"], &first["use"]),
        (&json!(12), &json!("commands"))
    );
    assert_eq!(
        first["taken"][3],
        json!({ "code": "0x0103", "state": "retired", "zh": "曾用于 a|b", "en": "Once used for a|b" })
    );
    assert_eq!(first["taken"][1]["name"], json!("glow"));
}
