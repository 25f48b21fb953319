//! Every question about texts that end anywhere, or have anything in them: answered or not, nothing panics.

#![allow(clippy::expect_used, reason = "tests")]

use fc_codegen::target::Targets;
use fc_lsp::{
    Project, Settings, Workspace, actions, completion, definition, document_symbols, formatting,
    hover, lenses, prepare_rename, references,
};
use gen_lsp_types::{Position, Range, Uri};
use serde_json::json;
use std::path::Path;
use std::sync::Arc;

/// A file of the spec that uses every corner of the language, with its text.
fn workspace(path: &str) -> (Workspace, Uri, String) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fc-codegen/tests/docs");
    let root = root.canonicalize().expect("it is there");
    let text = std::fs::read_to_string(root.join(path)).expect("a file of the spec");
    let uri = Uri(format!("file://{}/{path}", root.display()));
    let project = Project::new(root, "spec".into(), Targets::default());
    let settings = Arc::new(Settings::read(&json!({})));
    let mut workspace = Workspace::new(project, settings, "2026-01-01".to_owned());
    // The state that is known while the text is half written.
    let _ = workspace.snapshot().analysis();
    (workspace, uri, text)
}

fn ask(workspace: &mut Workspace, uri: &Uri, text: &str, offset: usize) {
    assert!(workspace.open(uri.clone(), 1, text.to_owned()));
    let snapshot = workspace.snapshot();
    let file = snapshot.file(uri).expect("it is open");
    let at = (file, offset);
    let _ = completion(&snapshot, at);
    let _ = formatting(&snapshot, uri);
    let _ = hover(&snapshot, at);
    let _ = definition(&snapshot, at);
    let _ = references(&snapshot, at, true);
    let _ = prepare_rename(&snapshot, at);
}

#[test]
fn texts_that_end_anywhere() {
    for path in ["spec/types.yaml", "spec/protocol.yaml"] {
        let (mut workspace, uri, text) = workspace(path);
        for (offset, _) in text.char_indices().step_by(41) {
            ask(
                &mut workspace,
                &uri,
                text.get(..offset).expect("a boundary"),
                offset,
            );
        }
    }
}

#[test]
fn texts_with_anything_in_them() {
    let (mut workspace, uri, text) = workspace("spec/types.yaml");
    let odd = [
        "{", "[", "]}", ": ", "- ", "\t", "\r\n", "\"", "'", "#", "|", "&a ", "*a", "😀",
        "\u{feff}", "\0",
    ];
    let places: Vec<usize> = text.char_indices().map(|(at, _)| at).step_by(97).collect();
    for (n, at) in places.into_iter().enumerate() {
        let odd = odd.get(n % odd.len()).expect("one of them");
        let mut text = text.clone();
        text.insert_str(at, odd);
        ask(&mut workspace, &uri, &text, at + odd.len());
        if n % 8 == 0 {
            // With all that has to be found out first.
            let snapshot = workspace.snapshot();
            let file = snapshot.file(&uri).expect("it is open");
            let _ = (lenses(&snapshot, file), document_symbols(&snapshot, file));
            let far = Position {
                line: u32::MAX,
                character: u32::MAX,
            };
            let all = Range {
                start: Position::default(),
                end: far,
            };
            let faults = actions(&snapshot, &uri, all);
            assert!(faults.iter().all(|action| action.edit.is_some()));
        }
    }
}
