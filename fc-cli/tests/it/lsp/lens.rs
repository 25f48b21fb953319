//! Code lenses.

use lsp_server::Message;
use serde_json::json;

use crate::lsp::editor::{Editor, editor};
use crate::lsp::{LAMP, TYPES, project};

#[test]
fn lenses_tell_of_codes_users_and_breaks() {
    let project = project();
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

    // A client that can show references gets their places.
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

#[test]
fn changed_check_refreshes_the_lenses() {
    let project = project();
    project
        .fc(&["release", "7", "--today", "2026-09-01"])
        .expect(0);
    let workspace = json!({ "codeLens": { "refreshSupport": true } });
    let capabilities = json!({ "capabilities": { "workspace": workspace } });
    let mut editor = Editor::with(&project, capabilities);
    editor.open(LAMP);
    let again = |editor: &mut Editor<'_>| {
        editor.wait(|message| match message {
            Message::Request(request) => Some(request.method.clone()),
            _ => None,
        })
    };
    assert_eq!(again(&mut editor), "workspace/codeLens/refresh");
    editor.replace(LAMP, "code: 0x0104", "code: 0x0109");
    assert_eq!(again(&mut editor), "workspace/codeLens/refresh");
    let document = json!({ "textDocument": { "uri": editor.uri(LAMP) } });
    let lenses = editor.ask("textDocument/codeLens", document);
    let mut titles = lenses
        .as_array()
        .expect("lenses")
        .iter()
        .map(|lens| &lens["command"]["title"]);
    assert!(titles.any(|title| title == "breaks 7"), "{lenses:#}");
}
