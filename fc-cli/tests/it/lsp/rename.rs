//! Renaming.

use serde_json::{Value, json};

use crate::lsp::editor::{Editor, editor};
use crate::lsp::{LAMP, PROTOCOL, TYPES, project};
use crate::support::Project;

/// Returns the parts of the dump that define the wire format: every wire key, code and enum value.
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
fn rename_changes_names_but_not_wire_keys() {
    for (path, marked, new, parts) in [
        // A type, from its declaration and from another file.
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
        // A field on one line, a field over several lines, and a field with a name, from its key and from its name.
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
        // An inline object whose key has a default name.
        (
            LAMP,
            "          cho|ice:\n",
            "outcome",
            &[(LAMP, "            name: outcome\n")],
        ),
        // An enum value that another value names.
        (
            TYPES,
            "then: [burn|ing, dark]",
            "glowing",
            &[
                (TYPES, "3: { name: glowing,"),
                (TYPES, "then: [glowing, dark]"),
            ],
        ),
        // An entity, a store and a hardware name.
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
        let project = project();
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
                editor.becomes_clean(path);
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
    let project = project();
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
    let project = project();
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
    // A text, a word of the language, and a key of the language.
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

/// A type with an error can be renamed. The error then uses the new name.
#[test]
fn a_thing_with_a_fault_can_be_renamed() {
    let project = project();
    let mut editor = editor(&project);
    editor.open(TYPES);
    editor.replace(TYPES, "unit: mm", "unti: mm");
    let mut params = editor.at(TYPES, "  Sp|ot:\n");
    params["newName"] = json!("Sport");
    editor
        .try_ask("textDocument/rename", params)
        .expect("the edit");
}
