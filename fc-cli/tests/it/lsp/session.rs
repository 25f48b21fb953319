//! Messages in an unusual order, in large numbers, or with invalid content.

use lsp_server::Message;
use serde_json::{Value, json};

use crate::lsp::editor::Editor;
use crate::lsp::{TYPES, project};
use crate::support::{self, Project};

#[test]
fn invalid_messages_do_not_end_the_server() {
    let project = project();
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
            // The server may respond with a result or an error.
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
    // A range that ends before it starts and lies beyond the end.
    let backwards = json!({ "range": { "start": far, "end": { "line": 0, "character": 3 } }, "text": "# 末尾\n" });
    let version = 2;
    let params = json!({ "textDocument": { "uri": uri, "version": version }, "contentChanges": [backwards] });
    editor.tell("textDocument/didChange", params);
    let place = editor.ask_at("textDocument/definition", TYPES, "  Sp|ot:\n");
    assert_eq!(editor.slice(TYPES, &place["range"]), "Spot");
    assert_eq!(editor.end(), 0);
}

#[test]
fn last_of_many_changes_is_published() {
    let project = project();
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
fn invalid_settings_have_the_language_of_the_editor() {
    let project = project();
    project.write("fc.yaml", "targetz: {}\n");
    for (locale, expected) in [
        ("zh-CN", "fc.yaml:1:1: “项目”没有键 `targetz`"),
        ("en", "fc.yaml:1:1: `targetz` is not a key of the project"),
    ] {
        let mut editor = Editor::with(&project, json!({ "locale": locale }));
        let told = editor.wait(|message| match message {
            Message::Notification(it) if it.method == "window/logMessage" => {
                Some(it.params["message"].clone())
            }
            _ => None,
        });
        assert_eq!(told, expected);
    }
}

#[test]
fn without_a_project_there_are_no_answers() {
    let project = Project::empty();
    project.write("notes.yaml", "a: 1\n");
    let mut editor = Editor::start(&project);
    editor.open("notes.yaml");
    assert_eq!(
        editor.ask_at("textDocument/hover", "notes.yaml", "|a: 1"),
        Value::Null
    );
    // The server finds a project in a subdirectory when a file of it opens.
    let inner = crate::lsp::project();
    support::copy(&inner.path("spec"), &project.path("robot/spec"));
    let path = "robot/spec/types.yaml";
    editor.open(path);
    assert_eq!(editor.codes(path), [""; 0]);
    editor.replace(path, "unit: mm", "unti: mm");
    assert_eq!(editor.codes(path).len(), 1);
    assert_eq!(editor.end(), 0);
}

/// A request gets one response, even if it is cancelled, a change overtakes it, or the server shuts down first.
#[test]
fn each_request_gets_one_answer() {
    let project = project();
    let mut editor = Editor::start(&project);
    editor.open(TYPES);
    let (there, gone) = ("unit: mm", "unti: mm");
    let mut asked = Vec::new();
    for at in 0..40 {
        let (old, new) = if at % 2 == 0 {
            (there, gone)
        } else {
            (gone, there)
        };
        editor.replace(TYPES, old, new);
        let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } });
        let document = json!({ "uri": editor.uri(TYPES) });
        let params =
            json!({ "textDocument": document, "range": range, "context": { "diagnostics": [] } });
        let actions = editor.request("textDocument/codeAction", params);
        let lenses = editor.request("textDocument/codeLens", json!({ "textDocument": document }));
        let renaming = editor.at(TYPES, "  Sp|ot:\n");
        let mut params = renaming.clone();
        params["newName"] = json!("Sport");
        let renamed = editor.request("textDocument/rename", params);
        if at % 3 == 0 {
            editor.tell("$/cancelRequest", json!({ "id": actions }));
            editor.tell("$/cancelRequest", json!({ "id": renamed }));
        }
        asked.extend([actions, lenses, renamed]);
    }
    editor.request("shutdown", Value::Null);
    for id in asked {
        if let Err(error) = editor.answer(id) {
            // The request was cancelled, overtaken by a change, or refused because too many waited.
            let known = ["-32800", "-32801", "-32802"];
            assert!(known.iter().any(|code| error.starts_with(code)), "{error}");
        }
    }
    let error = editor.try_ask("workspace/symbol", json!({ "query": "" }));
    assert!(error.expect_err("it is shut down").starts_with("-32600"));
}
