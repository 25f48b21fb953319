//! `fc lsp`, driven by an editor: what it answers about a place, and what its edits come to.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::needless_pass_by_value,
    clippy::panic,
    clippy::single_match_else,
    clippy::too_many_lines,
    reason = "tests"
)]

mod editor;
mod support;

use editor::Editor;
use serde_json::{Value, json};
use support::Project;

const TYPES: &str = "spec/types.yaml";
const LAMP: &str = "spec/commands/lamp.yaml";
const PROTOCOL: &str = "spec/protocol.yaml";

/// An editor with the files of the spec open, and nothing wrong with them.
fn editor(project: &Project) -> Editor<'_> {
    editor_in(project, "en")
}

fn editor_in<'p>(project: &'p Project, locale: &str) -> Editor<'p> {
    let mut editor = Editor::with(project, json!({ "locale": locale }));
    for path in [TYPES, LAMP, PROTOCOL] {
        editor.open(path);
        assert_eq!(editor.codes(path), [""; 0]);
    }
    editor
}

fn hover(editor: &mut Editor<'_>, path: &str, marked: &str) -> String {
    let hover = editor.ask_at("textDocument/hover", path, marked);
    let text = hover["contents"]["value"].as_str();
    text.unwrap_or_else(|| panic!("nothing at {marked}"))
        .to_owned()
}

#[test]
fn keys_words_and_things_are_explained_in_both_languages() {
    let project = Project::new();
    let mut editor = editor(&project);
    for (path, marked, parts) in [
        // A key, a word of it, a unit, a built-in type.
        (
            LAMP,
            "    eff|ect: motion",
            [
                "`effect` (required)",
                "What it does to the robot",
                "对机器人的影响",
            ]
            .as_slice(),
        ),
        (LAMP, "effect: mot|ion", &["`motion`"]),
        (
            TYPES,
            "unit: m|m, example: 30",
            &["`mm`", "Millimetres.", "毫米。"],
        ),
        (TYPES, "type: u|16, unit", &["`u16`"]),
        // A type, declared or named: its texts, Rust and JSON.
        (
            TYPES,
            "  Sp|ot:\n",
            &[
                "**struct** `Spot`",
                "A spot",
                "光斑",
                "pub struct Spot {",
                "pub size: u16,",
                "\"size\": 30",
            ],
        ),
        (
            LAMP,
            "\"Spo|t?\"",
            &["**struct** `Spot`", "A spot", "\"size\": 30"],
        ),
        (
            LAMP,
            "mood: { type: \"M|ood?\"",
            &["**enum** `Mood`", "pub enum Mood"],
        ),
        // An operation, declared or named.
        (
            LAMP,
            "  set_|level:\n",
            &[
                "**command** `set_level` · `0x0101` · motion",
                "Set the level",
                "设置亮度",
                "pub struct SetLevelRequest",
                "\"level\": 40",
            ],
        ),
        (
            LAMP,
            "after: [get_l|evel, probe]",
            &["**command** `get_level`", "Get the level"],
        ),
        // A field, an enum value, an entity, a gap.
        (
            TYPES,
            "      si|ze:",
            &[
                "**field** `Spot.size` · `u16` · mm",
                "Diameter",
                "直径",
                "pub size: u16",
                "\"size\": 30",
            ],
        ),
        (
            TYPES,
            "then: [st|ate]",
            &["`Phase.state`", "Brightening", "渐亮"],
        ),
        (LAMP, "refers: per|son", &["`person`", "Operator", "操作者"]),
        (TYPES, "ids: [C0|07]", &["`C007`"]),
    ] {
        let text = hover(&mut editor, path, marked);
        for part in parts {
            assert!(text.contains(part), "{part:?} of {marked}: {text}");
        }
    }
    // The client's language is first.
    for (locale, first) in [("zh-CN", "光斑\n\nA spot"), ("en-GB", "A spot\n\n光斑")] {
        let mut editor = editor_in(&project, locale);
        assert!(
            hover(&mut editor, TYPES, "  Sp|ot:\n").contains(first),
            "{locale}"
        );
    }
}

#[test]
fn a_name_leads_to_what_it_names() {
    let project = Project::new();
    let mut editor = editor(&project);
    for (path, marked, target) in [
        (LAMP, "\"Spo|t?\"", "spec/types.yaml:13 Spot"),
        (LAMP, "type: [Colo|ur]", "spec/types.yaml:2 Colour"),
        (
            LAMP,
            "sets_off: [ala|rm,",
            "spec/commands/lamp.yaml:149 alarm",
        ),
        (LAMP, "in: { Pha|se: [0", "spec/types.yaml:34 Phase"),
        (LAMP, "refers: per|son", "spec/protocol.yaml:119 person"),
        (
            LAMP,
            "hardware: [cei|ling]",
            "spec/protocol.yaml:136 ceiling",
        ),
        (
            LAMP,
            "from: { lam|p_os: \"1.2\" }",
            "spec/protocol.yaml:138 lamp_os",
        ),
        (
            LAMP,
            "kept: fl|ash
    available",
            "spec/protocol.yaml:127 flash",
        ),
        (LAMP, "coordinates: be|am", "spec/protocol.yaml:123 beam"),
        (TYPES, "then: [burn|ing, dark]", "spec/types.yaml:41 3"),
        (
            LAMP,
            "replaced_by: level_ch|anged",
            "spec/commands/lamp.yaml:127 level_changed",
        ),
        (LAMP, "      - |3\n", "spec/protocol.yaml:75 3"),
    ] {
        let place = editor.ask_at("textDocument/definition", path, marked);
        let found = editor.slices(&json!([place]));
        let (_, name) = target.split_once(' ').expect("a name");
        assert!(
            found[0].ends_with(&format!(" {name}")),
            "{marked}: {found:?}"
        );
        let (file, _) = target.split_once(':').expect("a line");
        assert!(found[0].starts_with(file), "{marked}: {found:?}");
        // And it is the place that `fc where` names.
        let run = project.fc(&["where", name]);
        let (at, _) = found[0].split_once(' ').expect("a place");
        assert!(
            name == "3" || run.stdout.contains(&format!("{at}:")),
            "{found:?} {run:?}"
        );
    }
    assert_eq!(
        editor.ask_at("textDocument/definition", LAMP, "zh: |灯\n"),
        Value::Null
    );
}

#[test]
fn what_names_a_thing_is_found_in_all_files() {
    let project = Project::new();
    let mut editor = editor(&project);
    let ask = |editor: &mut Editor<'_>, path: &str, marked: &str, with_own: bool| {
        let mut params = editor.at(path, marked);
        params["context"] = json!({ "includeDeclaration": with_own });
        let found = editor.ask("textDocument/references", params);
        let mut texts: Vec<_> = editor
            .slices(&found)
            .into_iter()
            .map(|text| text.split_once(' ').expect("a text").1.to_owned())
            .collect();
        texts.sort();
        texts
    };
    assert_eq!(
        ask(&mut editor, TYPES, "  Col|our:\n", false),
        ["Colour"; 3]
    );
    assert_eq!(
        ask(&mut editor, LAMP, "type: [Colo|ur]", true),
        ["Colour"; 4]
    );
    assert_eq!(
        ask(&mut editor, PROTOCOL, "  sce|ne: {", false),
        ["scene"; 3]
    );
    // As a type of fields, and as the key of a condition.
    assert_eq!(ask(&mut editor, TYPES, "  Pha|se:\n", false), ["Phase"; 4]);
    assert_eq!(ask(&mut editor, LAMP, "  ala|rm:\n", true), ["alarm"; 2]);
}

#[test]
fn a_file_has_an_outline() {
    let project = Project::new();
    let mut editor = editor(&project);
    let document = json!({ "textDocument": { "uri": editor.uri(TYPES) } });
    let symbols = editor.ask("textDocument/documentSymbol", document);
    let names = |symbols: &Value| -> Vec<String> {
        let symbols = symbols.as_array().into_iter().flatten();
        let names = symbols.map(|symbol| symbol["name"].as_str());
        names.map(|name| name.expect("a name").to_owned()).collect()
    };
    assert_eq!(
        names(&symbols),
        ["Colour", "Spot", "Stand", "Goal", "Mood", "Phase"]
    );
    assert!(names(&symbols[0]["children"]).starts_with(&[
        "red".into(),
        "green".into(),
        "gamma".into()
    ]));
    assert_eq!(
        names(&symbols[5]["children"]),
        ["dark", "burning", "state", "broken"]
    );
    let document = json!({ "textDocument": { "uri": editor.uri(LAMP) } });
    let symbols = editor.ask("textDocument/documentSymbol", document);
    assert!(
        names(&symbols).contains(&"set_level".to_owned()),
        "{:?}",
        names(&symbols)
    );
    assert!(
        !symbols.to_string().contains("SetLevelRequestData"),
        "{symbols:#}"
    );

    let found = editor.ask("workspace/symbol", json!({ "query": "SPO" }));
    assert!(names(&found).contains(&"Spot".to_owned()), "{found:#}");
}

/// What is offered at a mark, after `old` has become `new`, which has the mark.
fn offered(editor: &mut Editor<'_>, path: &str, old: &str, new: &str) -> Vec<Value> {
    let before = editor.text(path).to_owned();
    editor.replace(path, old, &new.replacen('|', "", 1));
    // Whatever is wrong with the text, before and after that has been found out.
    editor.ask_at("textDocument/completion", path, new);
    editor.faults(path);
    let items = editor.ask_at("textDocument/completion", path, new);
    editor.write(path, &before);
    assert_eq!(editor.codes(path), [""; 0]);
    items.as_array().expect("items").clone()
}

#[test]
fn what_may_be_written_is_offered() {
    let project = Project::new();
    let mut editor = editor(&project);
    for (path, old, new, wanted, unwanted) in [
        // Keys: in braces, on a line of their own, where the form is not known yet, at the top.
        (
            TYPES,
            "{ type: u16, unit: mm",
            "{ type: u16, un|",
            "unit",
            "type",
        ),
        (
            TYPES,
            "{ type: u16, unit: mm, example",
            "{ |, example",
            "type",
            "example",
        ),
        (
            TYPES,
            "    coordinates: room\n",
            "    co|\n",
            "coordinates",
            "zh",
        ),
        (LAMP, "    effect: motion\n", "    |\n", "effect", "code"),
        (
            LAMP,
            "
reports:
",
            "
|
reports:
",
            "types",
            "commands",
        ),
        (
            LAMP,
            "{ timeout_ms: 500, retries: 0 }",
            "{ timeout_ms: 500, |",
            "retries",
            "timeout_ms",
        ),
        // Words, types, units.
        (LAMP, "effect: motion\n", "effect: |\n", "config", "Spot"),
        (
            LAMP,
            "wire: string, example: \"0.25\"",
            "wire: |, example: \"0.25\"",
            "number",
            "bool",
        ),
        (
            TYPES,
            "type: u16, unit: mm",
            "type: Sp|, unit: mm",
            "Spot",
            "mm",
        ),
        (
            TYPES,
            "type: u16, unit: mm",
            "type: |, unit: mm",
            "timestamp_ms",
            "mm",
        ),
        (LAMP, "type: [Colour]", "type: [Col|]", "Colour", "commands"),
        (
            TYPES,
            "unit: mm, example",
            "unit: |, example",
            "m/s",
            "Spot",
        ),
        // Names of what the spec has.
        (
            LAMP,
            "refers: person, example",
            "refers: |, example",
            "person",
            "flash",
        ),
        (
            LAMP,
            "kept: flash\n    available",
            "kept: |\n    available",
            "flash",
            "person",
        ),
        (
            LAMP,
            "after: [get_level, probe]",
            "after: [get_level, |]",
            "probe",
            "alarm",
        ),
        (
            LAMP,
            "sets_off: [alarm, level_changed]",
            "sets_off: [|",
            "level_changed",
            "probe",
        ),
        (TYPES, "then: [state]", "then: [|]", "burning", "split"),
        (TYPES, "ids: [C007]", "ids: [C|]", "C008", "C007x"),
        (
            LAMP,
            "hardware: [ceiling]",
            "hardware: [|]",
            "ceiling",
            "lamp_os",
        ),
        (
            LAMP,
            "in: { Phase: [0, 3, 4]",
            "in: { |: [0, 3, 4]",
            "Phase",
            "Spot",
        ),
        // The next code.
        (LAMP, "code: unassigned\n", "code: |\n", "0x0105", "0x0101"),
        (LAMP, "code: 0x0202\n", "code: 0x|\n", "0x0202", "0x0105"),
    ] {
        let items = offered(&mut editor, path, old, new);
        let labels: Vec<&str> = items.iter().filter_map(|it| it["label"].as_str()).collect();
        assert!(labels.contains(&wanted), "{wanted} at {new:?}: {labels:?}");
        assert!(
            !labels.contains(&unwanted),
            "{unwanted} at {new:?}: {labels:?}"
        );
    }
    assert_eq!(
        offered(&mut editor, TYPES, "zh: 光斑", "zh: 光|"),
        [Value::Null; 0]
    );
}

#[test]
fn what_is_chosen_makes_the_spec_right_again() {
    let project = Project::new();
    let mut editor = editor(&project);
    for (path, old, new, chosen, then) in [
        (
            TYPES,
            "{ type: u16, unit: mm, example",
            "{ type: u16, |mm, example",
            "unit",
            "",
        ),
        (
            LAMP,
            "after: [get_level, probe]",
            "after: [get_level, pro|]",
            "probe",
            "",
        ),
        (
            TYPES,
            "type: u16, unit: mm",
            "type: u|, unit: mm",
            "u16",
            "",
        ),
        (LAMP, "code: unassigned\n", "code: |\n", "0x0105", ""),
        (
            LAMP,
            "    effect: motion\n",
            "    eff|\n",
            "effect",
            "motion",
        ),
    ] {
        let before = editor.text(path).to_owned();
        if chosen == "unit" {
            editor.replace(path, old, "{ type: u16, , example");
        } else {
            editor.replace(path, old, &new.replacen('|', "", 1));
        }
        let marked = if chosen == "unit" {
            "{ type: u16, |, example"
        } else {
            new
        };
        let items = editor.ask_at("textDocument/completion", path, marked);
        let mut items = items.as_array().expect("items").iter();
        let item = items
            .find(|it| it["label"] == chosen)
            .expect("it is offered");
        let mut edit = item["textEdit"].clone();
        let text = edit["newText"].as_str().expect("a text").to_owned();
        let value = if chosen == "unit" { "mm" } else { then };
        edit["newText"] = json!(text + value);
        editor.edit(path, &json!([edit]));
        assert_eq!(editor.codes(path), [""; 0], "{}", editor.text(path));
        editor.write(path, &before);
    }
}

/// The parts of the dump that say what is sent: every wire key, code and enum value.
fn sent(project: &Project) -> Vec<String> {
    let run = project.fc(&["inspect"]).expect(0);
    let dump: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let mut sent = Vec::new();
    wire(&dump, &mut sent);
    sent.sort();
    sent
}

fn wire(value: &Value, sent: &mut Vec<String>) {
    match value {
        Value::Object(entries) => {
            for (key, value) in entries {
                if ["path", "wire", "value", "code_spelling"].contains(&key.as_str()) {
                    sent.push(format!("{key} {value}"));
                }
                wire(value, sent);
            }
        }
        Value::Array(items) => items.iter().for_each(|item| wire(item, sent)),
        _ => {}
    }
}

#[test]
fn a_thing_is_renamed_wherever_it_is_named_and_what_is_sent_stays() {
    for (path, marked, new, parts) in [
        // A type, from its own place and from another file's.
        (
            TYPES,
            "  Sp|ot:\n",
            "Patch",
            [(TYPES, "  Patch:\n"), (LAMP, "\"Patch?\"")].as_slice(),
        ),
        (
            LAMP,
            "type: [Colo|ur]",
            "Hue",
            &[
                (TYPES, "  Hue:\n"),
                (LAMP, "type: [Hue]"),
                (LAMP, "type: Hue\n"),
            ],
        ),
        (
            TYPES,
            "  Pha|se:\n",
            "Stage",
            &[
                (LAMP, "in: { Stage: [0"),
                (LAMP, "phase: { type: Stage, also: [Phase, stage]"),
            ],
        ),
        // An operation.
        (
            LAMP,
            "  ala|rm:\n",
            "alert",
            &[
                (LAMP, "  alert:\n"),
                (LAMP, "sets_off: [alert, level_changed]"),
            ],
        ),
        (
            LAMP,
            "after: [get_l|evel, probe]",
            "ask_level",
            &[
                (LAMP, "  ask_level:\n"),
                (LAMP, "after: [ask_level, probe]"),
            ],
        ),
        // A field: beside its key; over lines; one that has a name already, from its key and from its name.
        (
            TYPES,
            "      si|ze:",
            "diameter",
            &[(TYPES, "size: { type: u16, name: diameter, unit: mm")],
        ),
        (
            LAMP,
            "        le|vel:\n          type",
            "brightness",
            &[(
                LAMP,
                "        level:\n          type: i32\n          name: brightness\n          min: 0",
            )],
        ),
        (
            LAMP,
            "        lab|el:",
            "caption",
            &[(LAMP, "label: {"), (LAMP, "name: caption")],
        ),
        (
            LAMP,
            "name: tit|le",
            "caption",
            &[(LAMP, "label: {"), (LAMP, "name: caption")],
        ),
        // An inline object, whose key has a default text.
        (
            LAMP,
            "          cho|ice:\n",
            "outcome",
            &[(LAMP, "            name: outcome\n")],
        ),
        // An enum value, with what follows it.
        (
            TYPES,
            "then: [burn|ing, dark]",
            "glowing",
            &[
                (TYPES, "3: { name: glowing,"),
                (TYPES, "then: [glowing, dark]"),
            ],
        ),
        // What is declared beside.
        (
            LAMP,
            "refers: per|son",
            "human",
            &[(PROTOCOL, "  human: {"), (LAMP, "refers: human")],
        ),
        (PROTOCOL, "  fla|sh: {", "rom", &[(LAMP, "kept: rom\n")]),
        (
            LAMP,
            "hardware: [cei|ling]",
            "hanging",
            &[(PROTOCOL, "    hanging: {")],
        ),
    ] {
        let project = Project::new();
        project.fc(&["fmt"]).expect(0);
        let before = sent(&project);
        let mut editor = editor(&project);
        let at = editor.at(path, marked);
        let prepared = editor.ask("textDocument/prepareRename", at.clone());
        assert!(prepared["placeholder"].is_string(), "{marked}: {prepared}");
        let mut params = at;
        params["newName"] = json!(new);
        let edit = editor.ask("textDocument/rename", params);
        editor.apply(&edit);
        for path in [TYPES, LAMP, PROTOCOL] {
            if edit.to_string().contains(&editor.uri(path)) {
                assert_eq!(
                    editor.codes(path),
                    [""; 0],
                    "{marked}: {}",
                    editor.text(path)
                );
            }
        }
        for (path, part) in parts {
            assert!(editor.text(path).contains(part), "{part:?}: {edit:#}");
        }
        editor.save();
        project.fc(&["check"]).expect(0);
        project.fc(&["fmt", "--check"]).expect(0);
        assert_eq!(sent(&project), before, "{marked}");
    }
}

#[test]
fn a_field_in_short_form_gets_room_for_its_name() {
    let project = Project::new();
    let text = project.read(LAMP);
    let long =
        "spot: { type: \"Spot?\", coordinates: beam, kept: memory, zh: 光斑, en: Spot of light }";
    let text = text.replace(long, "spot: Spot?");
    project.write(LAMP, &text);
    let protocol = project.read(PROTOCOL);
    let unused = |line: &&str| !line.starts_with("  beam:") && !line.starts_with("  memory:");
    let kept: Vec<_> = protocol.lines().filter(unused).collect();
    project.write(PROTOCOL, &(kept.join("\n") + "\n"));
    let before = sent(&project);
    let mut editor = Editor::start(&project);
    editor.open(LAMP);
    let mut params = editor.at(LAMP, "        sp|ot: Spot?");
    params["newName"] = json!("patch");
    let edit = editor.ask("textDocument/rename", params);
    editor.apply(&edit);
    let new = "spot: { type: \"Spot?\", name: patch, zh: 光斑, en: A spot }";
    assert!(editor.text(LAMP).contains(new), "{edit:#}");
    editor.save();
    project.fc(&["check"]).expect(0);
    assert_eq!(sent(&project), before);
}

#[test]
fn a_name_that_cannot_be_is_refused_with_the_reason() {
    let project = Project::new();
    let mut editor = editor(&project);
    for (path, marked, new) in [
        (TYPES, "  Sp|ot:\n", "spot"),
        (TYPES, "  Sp|ot:\n", "Colour"),
        (TYPES, "  Sp|ot:\n", "a: [ b"),
        (TYPES, "  Sp|ot:\n", ""),
        (LAMP, "  ala|rm:\n", "probe"),
        (TYPES, "      si|ze:", "Size"),
    ] {
        let mut params = editor.at(path, marked);
        params["newName"] = json!(new);
        let error = editor.try_ask("textDocument/rename", params);
        let error = error.expect_err("refused");
        assert!(
            error.contains("the spec would have errors: "),
            "{new}: {error}"
        );
    }
    // A wire value, a text, a word of the language.
    for (path, marked) in [
        (LAMP, "zh: |灯\n"),
        (LAMP, "effect: mot|ion"),
        (TYPES, "    coord|inates: room"),
    ] {
        let params = editor.at(path, marked);
        assert_eq!(
            editor.ask("textDocument/prepareRename", params.clone()),
            Value::Null,
            "{marked}"
        );
        let mut params = params;
        params["newName"] = json!("other");
        editor
            .try_ask("textDocument/rename", params)
            .expect_err("refused");
    }
}

#[test]
fn lenses_tell_of_codes_users_and_breaks() {
    let project = Project::new();
    project
        .fc(&["release", "7", "--today", "2026-09-01"])
        .expect(0);
    let mut editor = editor(&project);
    let lenses = |editor: &mut Editor<'_>, path: &str| -> Vec<String> {
        let document = json!({ "textDocument": { "uri": editor.uri(path) } });
        let lenses = editor.ask("textDocument/codeLens", document);
        let lenses = lenses.as_array().expect("lenses").iter().map(|lens| {
            let words = editor.slice(path, &lens["range"]);
            format!(
                "{words}: {}",
                lens["command"]["title"].as_str().expect("a title")
            )
        });
        lenses.collect()
    };
    let of_lamp = lenses(&mut editor, LAMP);
    for lens in [
        "commands: free code 0x0105",
        "reports: free code 0x0203",
        "alarm: 1 user",
    ] {
        assert!(of_lamp.iter().any(|it| it == lens), "{lens}: {of_lamp:?}");
    }
    let of_types = lenses(&mut editor, TYPES);
    for lens in ["Colour: 3 users", "Phase: 4 users", "Spot: 1 user"] {
        assert!(of_types.iter().any(|it| it == lens), "{lens}: {of_types:?}");
    }

    // The released robot does not know the new code.
    assert!(
        !of_lamp.iter().any(|it| it.contains("breaks")),
        "{of_lamp:?}"
    );
    editor.replace(LAMP, "code: 0x0104", "code: 0x0109");
    let of_lamp = lenses(&mut editor, LAMP);
    assert!(
        of_lamp.iter().any(|it| it == "probe: breaks 7"),
        "{of_lamp:?}"
    );

    // Who can show references is told which.
    let options = json!({ "showReferences": true, "lang": "zh" });
    let mut editor = Editor::with(&project, json!({ "initializationOptions": options }));
    editor.open(TYPES);
    let document = json!({ "textDocument": { "uri": editor.uri(TYPES) } });
    let lenses = editor.ask("textDocument/codeLens", document);
    let command = &lenses[0]["command"];
    assert_eq!(command["title"], "3 处使用");
    assert_eq!(command["command"], "fc.showReferences");
    assert_eq!(editor.slices(&command["arguments"][2]).len(), 3);
}
