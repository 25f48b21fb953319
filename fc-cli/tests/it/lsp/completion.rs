//! Completion in incomplete text.

use serde_json::{Value, json};

use crate::lsp::editor::{Editor, editor};
use crate::lsp::{LAMP, TYPES, project};

/// Replaces `old` with `new` and returns the items at the mark in `new`.
fn offered(editor: &mut Editor<'_>, path: &str, old: &str, new: &str) -> Vec<Value> {
    let before = editor.text(path).to_owned();
    editor.replace(path, old, &new.replacen('|', "", 1));
    // The text may have errors. The server must respond before and after it has found them.
    editor.ask_at("textDocument/completion", path, new);
    editor.faults(path);
    let items = editor.ask_at("textDocument/completion", path, new);
    editor.write(path, &before);
    assert_eq!(editor.codes(path), [""; 0]);
    items.as_array().expect("items").clone()
}

#[test]
fn completion_offers_valid_words() {
    let project = project();
    let mut editor = editor(&project);
    for (path, old, new, wanted, unwanted) in [
        // Keys: in braces, on their own line, in a form that is not known yet, and at the top.
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
        // Words, types and units.
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
        // Names that the spec declares.
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
        // The next free code.
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
fn chosen_completion_repairs_the_spec() {
    let project = project();
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
