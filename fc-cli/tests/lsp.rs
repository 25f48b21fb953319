//! `fc lsp`, driven by an editor: what it says of texts while they change.

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

#[test]
fn faults_come_and_go_with_the_text() {
    let project = Project::new();
    let mut editor = Editor::start(&project);
    editor.open(TYPES);
    assert_eq!(editor.codes(TYPES), [""; 0]);

    // Of a text that is on no disk, with the same codes at the same places as on the command line.
    editor.replace(TYPES, "type: u16, unit: mm", "type: u61, unit: mm");
    let faults = editor.faults(TYPES);
    assert_eq!(faults.len(), 1, "{faults:#?}");
    assert_eq!(editor.slice(TYPES, &faults[0]["range"]), "u61");
    assert_eq!(faults[0]["severity"], 1);
    assert_eq!(faults[0]["source"], "fc");
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
fn faults_and_their_fixes_speak_the_language_of_the_editor() {
    let project = Project::new();
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
    let project = Project::new();
    let mut editor = Editor::start(&project);
    editor.open(TYPES);
    assert_eq!(editor.codes(TYPES), [""; 0]);
    // `lamp.yaml` is not open, and names the type.
    editor.replace(TYPES, "  Spot:\n", "  Sport:\n");
    let faults = editor.faults(LAMP);
    assert_eq!(faults.len(), 1, "{faults:#?}");
    assert_eq!(editor.slice(LAMP, &faults[0]["range"]), "\"Spot?\"");
    editor.replace(TYPES, "  Sport:\n", "  Spot:\n");
    assert_eq!(editor.codes(LAMP), [""; 0]);

    // What the editor throws away is as it was on the disk.
    editor.replace(TYPES, "  Spot:\n", "  Sport:\n");
    assert_eq!(editor.codes(LAMP).len(), 1);
    editor.close(TYPES);
    assert_eq!(editor.codes(LAMP), [""; 0]);
}

#[test]
fn what_changes_on_the_disk_is_read_again() {
    let project = Project::new();
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

    // One that is open stays as the editor has it.
    editor.open_as(TYPES, &types);
    assert_eq!(editor.codes(LAMP), [""; 0]);
    let change = json!({ "changes": [{ "uri": editor.uri(TYPES), "type": 2 }] });
    editor.tell("workspace/didChangeWatchedFiles", change);
    let place = editor.ask_at("textDocument/definition", TYPES, "  Sp|ot:\n");
    assert_eq!(editor.slice(TYPES, &place["range"]), "Spot");
}

#[test]
fn columns_are_counted_as_the_client_counts_them() {
    // Behind characters of three and of four bytes.
    let old = "zh: 直径, en: Diameter }";
    let new = "zh: 直径😀, en: Diameter, unti: 1 }";
    for counts in ["utf-16", "utf-8"] {
        let project = Project::new();
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
        // Further changes arrive where they are meant.
        editor.replace(TYPES, ", unti: 1 }", " }");
        assert_eq!(editor.codes(TYPES), [""; 0]);
    }
}

#[test]
fn a_text_that_is_laid_out_is_what_fc_fmt_makes_of_it() {
    let project = Project::new();
    let mut editor = Editor::start(&project);
    for path in [TYPES, LAMP] {
        editor.open(path);
        // Keys in another order, blanks, a comment: nothing that means anything else.
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
    // What is no YAML stays as it is.
    editor.write(TYPES, "types: [\n");
    let params = json!({
        "textDocument": { "uri": editor.uri(TYPES) },
        "options": { "tabSize": 2, "insertSpaces": true },
    });
    assert_eq!(editor.ask("textDocument/formatting", params), Value::Null);
}

#[test]
fn every_fix_mends_its_fault() {
    // A slip of a key, of a type, of a word, of a unit, and a value to be quoted.
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
        let project = Project::new();
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
fn what_no_client_should_say_ends_nothing() {
    let project = Project::new();
    let mut editor = Editor::start(&project);
    editor.open(TYPES);
    let uri = editor.uri(TYPES);
    let document = json!({ "uri": uri });
    let far = json!({ "line": 4_000_000_000_u32, "character": 4_000_000_000_u32 });
    for method in [
        "textDocument/completion",
        "textDocument/hover",
        "textDocument/definition",
        "textDocument/references",
        "textDocument/documentSymbol",
        "textDocument/codeAction",
        "textDocument/codeLens",
        "textDocument/formatting",
        "textDocument/prepareRename",
        "textDocument/rename",
        "workspace/symbol",
    ] {
        for params in [
            Value::Null,
            json!([1]),
            json!({}),
            json!({ "textDocument": 7, "position": "here" }),
            json!({ "textDocument": { "uri": "nothing" }, "position": far, "newName": "", "query": "x",
                "range": { "start": far, "end": far }, "context": { "diagnostics": [], "includeDeclaration": true },
                "options": { "tabSize": 2, "insertSpaces": true } }),
            json!({ "textDocument": document, "position": far, "newName": ": [\n", "query": "",
                "range": { "start": far, "end": { "line": 0, "character": 0 } },
                "context": { "diagnostics": [], "includeDeclaration": true },
                "options": { "tabSize": 2, "insertSpaces": true } }),
        ] {
            // Answered or refused: either will do.
            let _ = editor.try_ask(method, params);
        }
    }
    let error = editor
        .try_ask("textDocument/nonsense", json!({}))
        .expect_err("not known");
    assert!(error.starts_with("-32601"), "{error}");
    for (method, params) in [
        ("textDocument/didOpen", json!({})),
        (
            "textDocument/didChange",
            json!({ "textDocument": { "uri": uri }, "contentChanges": 7 }),
        ),
        (
            "textDocument/didChange",
            json!({ "textDocument": { "uri": "x", "version": 1 }, "contentChanges": [] }),
        ),
        ("textDocument/didClose", Value::Null),
        ("$/cancelRequest", json!({ "id": [] })),
        ("$/unheard", json!(1)),
    ] {
        editor.tell(method, params);
    }
    // Ends before starts, and beyond the end.
    let backwards = json!({ "range": { "start": far, "end": { "line": 0, "character": 3 } }, "text": "# 末尾\n" });
    let version = 2;
    let params = json!({ "textDocument": { "uri": uri, "version": version }, "contentChanges": [backwards] });
    editor.tell("textDocument/didChange", params);
    let place = editor.ask_at("textDocument/definition", TYPES, "  Sp|ot:\n");
    assert_eq!(editor.slice(TYPES, &place["range"]), "Spot");
    assert_eq!(editor.end(), 0);
}

#[test]
fn many_changes_at_once_end_in_what_is_wrong_with_the_last() {
    let project = Project::new();
    let mut editor = Editor::start(&project);
    editor.open(TYPES);
    let text = editor.text(TYPES).to_owned();
    for n in 0..200 {
        editor.write(
            TYPES,
            &text.replace("type: u16, unit", &format!("type: u{n}, unit")),
        );
    }
    editor.write(TYPES, &text);
    assert_eq!(editor.codes(TYPES), [""; 0]);
    assert_eq!(editor.end(), 0);
}

#[test]
fn without_a_project_there_is_nothing_to_say() {
    let project = Project::empty();
    project.write("notes.yaml", "a: 1\n");
    let mut editor = Editor::start(&project);
    editor.open("notes.yaml");
    assert_eq!(
        editor.ask_at("textDocument/hover", "notes.yaml", "|a: 1"),
        Value::Null
    );
    // A project below the directory that is open is found by the first file in it.
    let inner = Project::new();
    support::copy(&inner.path("spec"), &project.path("robot/spec"));
    let path = "robot/spec/types.yaml";
    editor.open(path);
    assert_eq!(editor.codes(path), [""; 0]);
    editor.replace(path, "unit: mm", "unti: mm");
    assert_eq!(editor.codes(path).len(), 1);
    assert_eq!(editor.end(), 0);
}
