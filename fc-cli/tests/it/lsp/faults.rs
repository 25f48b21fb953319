//! Diagnostics, fixes and formatting of texts while they change.

use serde_json::{Value, json};

use crate::lsp::editor::Editor;
use crate::lsp::{LAMP, TYPES, project};

#[test]
fn faults_come_and_go_with_the_text() {
    let project = project();
    let mut editor = Editor::start(&project);
    editor.open(TYPES);
    assert_eq!(editor.codes(TYPES), [""; 0]);

    // The text is not on disk yet. Its diagnostic has the same code and place as on the command line.
    editor.replace(TYPES, "type: u16, unit: mm", "type: u61, unit: mm");
    let faults = editor.faults(TYPES);
    assert_eq!(faults.len(), 1, "{faults:#?}");
    assert_eq!(editor.slice(TYPES, &faults[0]["range"]), "u61");
    assert_eq!(faults[0]["severity"], 1);
    assert_eq!(faults[0]["source"], "fcproto");
    project.fc(&["check"]).expect(0);
    editor.save();
    let run = project.fc(&["check", "--format", "json"]).expect(1);
    let told: Value =
        serde_json::from_str(run.stdout.lines().next().expect("a fault")).expect("JSON");
    assert_eq!(told["code"], faults[0]["code"]);

    editor.replace(TYPES, "type: u61, unit: mm", "type: u16, unit: mm");
    assert_eq!(editor.codes(TYPES), [""; 0]);
    assert_eq!(editor.end(), 0);
}

#[test]
fn diagnostics_use_the_language_of_the_editor() {
    let project = project();
    let told = [
        ("zh-cn", "没有", "把 `unti` 改为 `unit`："),
        ("en", "is not a key", "replace `unti` with `unit`: "),
    ];
    for (locale, message, title) in told {
        let mut editor = Editor::with(&project, json!({ "locale": locale }));
        editor.open(TYPES);
        editor.replace(TYPES, "unit: mm", "unti: mm");
        let faults = editor.faults(TYPES);
        let said = faults[0]["message"].as_str().expect("a text");
        assert!(said.contains(message), "{said}");
        let params = json!({
            "textDocument": { "uri": editor.uri(TYPES) },
            "range": faults[0]["range"],
            "context": { "diagnostics": [] },
        });
        let actions = editor.ask("textDocument/codeAction", params);
        let said = actions[0]["title"].as_str().expect("a text");
        assert!(said.starts_with(title), "{said}");
    }
}

#[test]
fn a_change_in_one_file_shows_in_another() {
    let project = project();
    let mut editor = Editor::start(&project);
    editor.open(TYPES);
    assert_eq!(editor.codes(TYPES), [""; 0]);
    // `lamp.yaml` uses the type, but is not open.
    editor.replace(TYPES, "  Spot:\n", "  Sport:\n");
    let faults = editor.faults(LAMP);
    assert_eq!(faults.len(), 1, "{faults:#?}");
    assert_eq!(editor.slice(LAMP, &faults[0]["range"]), "\"Spot?\"");
    editor.replace(TYPES, "  Sport:\n", "  Spot:\n");
    assert_eq!(editor.codes(LAMP), [""; 0]);

    // The editor discards its changes, so the text on disk counts again.
    editor.replace(TYPES, "  Spot:\n", "  Sport:\n");
    assert_eq!(editor.codes(LAMP).len(), 1);
    editor.close(TYPES);
    assert_eq!(editor.codes(LAMP), [""; 0]);
}

#[test]
fn changed_file_on_disk_is_read_again() {
    let project = project();
    let asks = json!({ "workspace": { "didChangeWatchedFiles": { "dynamicRegistration": true } } });
    let mut editor = Editor::with(&project, json!({ "capabilities": asks }));
    let patterns = editor.wait(|message| match message {
        lsp_server::Message::Request(request) => Some(request.params["registrations"][0].clone()),
        _ => None,
    });
    assert_eq!(patterns["method"], "workspace/didChangeWatchedFiles");
    let types = project.read(TYPES);
    project.write(TYPES, &types.replace("  Spot:\n", "  Sport:\n"));
    let change = json!({ "changes": [{ "uri": editor.uri(TYPES), "type": 2 }] });
    editor.tell("workspace/didChangeWatchedFiles", change);
    assert_eq!(editor.codes(LAMP).len(), 1);

    // An open file keeps the text of the editor.
    editor.open_as(TYPES, &types);
    assert_eq!(editor.codes(LAMP), [""; 0]);
    let change = json!({ "changes": [{ "uri": editor.uri(TYPES), "type": 2 }] });
    editor.tell("workspace/didChangeWatchedFiles", change);
    let place = editor.ask_at("textDocument/definition", TYPES, "  Sp|ot:\n");
    assert_eq!(editor.slice(TYPES, &place["range"]), "Spot");
}

#[test]
fn columns_are_counted_as_the_client_counts_them() {
    // The columns follow characters of three and of four bytes.
    let old = "zh: 直径, en: Diameter }";
    let new = "zh: 直径😀, en: Diameter, unti: 1 }";
    for counts in ["utf-16", "utf-8"] {
        let project = project();
        let general = json!({ "positionEncodings": ["utf-32", counts] });
        let mut editor = Editor::with(&project, json!({ "capabilities": { "general": general } }));
        assert_eq!(editor.capabilities["positionEncoding"], counts);
        editor.open(TYPES);
        editor.replace(TYPES, old, new);
        let faults = editor.faults(TYPES);
        assert_eq!(faults.len(), 1, "{faults:#?}");
        assert_eq!(editor.slice(TYPES, &faults[0]["range"]), "unti");
        let column = &faults[0]["range"]["start"]["character"];
        let line = "      size: { type: u16, unit: mm, example: 30, zh: 直径😀, en: Diameter, unti";
        let before = line.strip_suffix("unti").expect("its end");
        let counted = match counts {
            "utf-8" => before.len(),
            _ => before.encode_utf16().count(),
        };
        assert_eq!(*column, counted, "{counts}");
        // Further changes apply at the right place.
        editor.replace(TYPES, ", unti: 1 }", " }");
        assert_eq!(editor.codes(TYPES), [""; 0]);
    }
}

#[test]
fn formatting_in_the_editor_equals_fmt() {
    let project = project();
    let mut editor = Editor::start(&project);
    for path in [TYPES, LAMP] {
        editor.open(path);
        // The changes move keys and add blanks and a comment. The meaning stays the same.
        let text = editor
            .text(path)
            .replacen("    zh:", "    # 中文 😀\n    zh:  ", 1);
        editor.write(path, &(text + "\n\n"));
        let params = json!({
            "textDocument": { "uri": editor.uri(path) },
            "options": { "tabSize": 2, "insertSpaces": true },
        });
        let edits = editor.ask("textDocument/formatting", params.clone());
        editor.save();
        editor.edit(path, &edits);
        project.fc(&["fmt", path]).expect(0);
        assert_eq!(editor.text(path), project.read(path), "{path}");
        assert_eq!(editor.ask("textDocument/formatting", params), json!([]));
    }
    // The server does not format text that is not YAML.
    editor.write(TYPES, "types: [\n");
    let params = json!({
        "textDocument": { "uri": editor.uri(TYPES) },
        "options": { "tabSize": 2, "insertSpaces": true },
    });
    assert_eq!(editor.ask("textDocument/formatting", params), Value::Null);
}

#[test]
fn every_fix_mends_its_fault() {
    // Typos in a key, a built-in type, a word, an entity, a type and an operation.
    for (path, old, new) in [
        (TYPES, "unit: mm", "unti: mm"),
        (TYPES, "type: u16, unit", "type: uint16, unit"),
        (LAMP, "effect: motion", "effect: moton"),
        (LAMP, "refers: person", "refers: persn"),
        (LAMP, "spot: { type: \"Spot?\"", "spot: { type: \"Spto?\""),
        (
            LAMP,
            "after: [get_level, probe]",
            "after: [get_levl, probe]",
        ),
    ] {
        let project = project();
        let mut editor = Editor::start(&project);
        editor.open(path);
        assert_eq!(editor.codes(path), [""; 0]);
        editor.replace(path, old, new);
        let faults = editor.faults(path);
        assert!(!faults.is_empty(), "{new}");
        let params = json!({
            "textDocument": { "uri": editor.uri(path) },
            "range": faults[0]["range"],
            "context": { "diagnostics": [faults[0]] },
        });
        let actions = editor.ask("textDocument/codeAction", params);
        let actions = actions.as_array().expect("actions");
        assert!(!actions.is_empty(), "{new}: {faults:#?}");
        for action in actions {
            assert_eq!(action["kind"], "quickfix");
            assert_eq!(action["diagnostics"][0]["code"], faults[0]["code"]);
            let before = editor.text(path).to_owned();
            editor.apply(&action["edit"]);
            let left = editor.codes(path);
            let code = faults[0]["code"].as_str().expect("a code");
            assert!(!left.iter().any(|it| it == code), "{action:#}");
            editor.write(path, &before);
            assert!(!editor.codes(path).is_empty());
        }
    }
}

#[test]
fn error_in_many_places_has_fixes_for_one_and_all() {
    let project = project();
    let mut editor = Editor::start(&project);
    editor.open(LAMP);
    let before = editor.text(LAMP).to_owned();
    let misspelt = before.replace("type: Phase", "type: Phas");
    let places: Vec<usize> = misspelt.match_indices("Phas,").map(|(at, _)| at).collect();
    assert_eq!(places.len(), 3);
    editor.write(LAMP, &misspelt);
    let codes = editor.codes(LAMP);
    let unknown = codes.iter().filter(|code| *code == "FC0203");
    assert_eq!(unknown.count(), 1, "{codes:?}");
    let mut whole = Value::Null;
    for at in places {
        let position = editor.position_of(LAMP, at);
        let params = json!({
            "textDocument": { "uri": editor.uri(LAMP) },
            "range": { "start": position, "end": position },
            "context": { "diagnostics": [] },
        });
        let actions = editor.ask("textDocument/codeAction", params);
        let [here, all] = actions.as_array().expect("actions").as_slice() else {
            panic!("{actions:#}");
        };
        let edits = &here["edit"]["documentChanges"][0]["edits"];
        assert_eq!(edits.as_array().map(Vec::len), Some(1), "{edits:#}");
        assert_eq!(edits[0]["range"]["start"], position);
        let title = all["title"].as_str().expect("a text");
        assert!(title.starts_with("at all 3 places: "), "{title}");
        whole = all["edit"].clone();
    }
    editor.apply(&whole);
    assert_eq!(editor.text(LAMP), before);
    assert_eq!(editor.codes(LAMP), [""; 0]);
}

#[test]
fn fix_all_applies_certain_fixes() {
    let project = project();
    let mut editor = Editor::start(&project);
    editor.open(LAMP);
    let before = editor.text(LAMP).to_owned();
    editor.replace(LAMP, "effect: motion", "efect: moton");
    assert_eq!(editor.codes(LAMP).len(), 1);
    let asked = |editor: &Editor<'_>, only: Value| {
        let end = json!({ "line": 0, "character": 0 });
        json!({
            "textDocument": { "uri": editor.uri(LAMP) },
            "range": { "start": end, "end": end },
            "context": { "diagnostics": [], "only": only },
        })
    };
    // The first fix corrects the key, the second its value.
    for _ in 0..2 {
        let params = asked(&editor, json!(["source.fixAll"]));
        let actions = editor.ask("textDocument/codeAction", params);
        assert_eq!(actions[0]["kind"], "source.fixAll", "{actions:#}");
        editor.apply(&actions[0]["edit"]);
        editor.faults(LAMP);
    }
    assert_eq!(editor.text(LAMP), before);
    for only in [json!(["source"]), json!(["refactor"]), json!(["quickfix"])] {
        let params = asked(&editor, only);
        assert_eq!(editor.ask("textDocument/codeAction", params), json!([]));
    }
}

/// A house rule that reports the command `set_level`.
const NO_COMMANDS: &str = "\
- id: no-commands
  zh: 不要指令
  en: There is a command
  for: command
  where: { name: set_level }
  require: { name: absent }
";

#[test]
fn lint_findings_are_shown_without_errors() {
    let project = project();
    project.write(
        "fc.yaml",
        "lint: { levels: { STANDARD: \"off\", DOCS: \"off\", SUNSET: \"off\" }, house: [rules.yaml] }\n",
    );
    project.write("rules.yaml", NO_COMMANDS);
    let mut editor = Editor::start(&project);
    editor.open(LAMP);
    let found = editor.faults(LAMP);
    let [found] = found.as_slice() else {
        panic!("{found:#?}");
    };
    assert_eq!(found["code"], "FC0890");
    assert_eq!(found["severity"], 2);
    assert_eq!(editor.slice(LAMP, &found["range"]), "set_level");
    let told = project.fc(&["lint", "--format", "json"]).expect(0);
    let told: Value = serde_json::from_str(told.stdout.trim()).expect("one finding");
    assert_eq!(told["code"], found["code"]);

    editor.replace(LAMP, "effect: motion", "effect: moton");
    assert_eq!(editor.codes(LAMP), ["FC0109"]);
    editor.replace(LAMP, "effect: moton", "effect: motion");
    assert_eq!(editor.codes(LAMP), ["FC0890"]);

    // The rules on disk become invalid. The error is reported in their file, and they find nothing.
    let changed = json!({ "changes": [{ "uri": editor.uri("rules.yaml"), "type": 2 }] });
    project.write("rules.yaml", &NO_COMMANDS.replace("for:", "fro:"));
    editor.tell("workspace/didChangeWatchedFiles", changed.clone());
    assert_eq!(editor.codes(LAMP), [""; 0]);
    assert_eq!(editor.codes("rules.yaml"), ["FC0101"]);
    // If two rules have one ID, the error links to the other one.
    project.write("rules.yaml", &NO_COMMANDS.repeat(2));
    editor.tell("workspace/didChangeWatchedFiles", changed.clone());
    let wrong = editor.faults("rules.yaml");
    let first = &wrong[0]["relatedInformation"][0]["location"];
    assert_eq!(first["uri"], editor.uri("rules.yaml"), "{wrong:#?}");
    project.write("rules.yaml", NO_COMMANDS);
    editor.tell("workspace/didChangeWatchedFiles", changed);
    assert_eq!(editor.codes(LAMP), ["FC0890"]);
    assert_eq!(editor.end(), 0);
}
