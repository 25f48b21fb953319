//! Responses about a position: hover, definition, references and symbols.

use serde_json::{Value, json};

use crate::lsp::editor::{Editor, editor, editor_in};
use crate::lsp::{LAMP, PROTOCOL, TYPES, project};

fn hover(editor: &mut Editor<'_>, path: &str, marked: &str) -> String {
    let hover = editor.ask_at("textDocument/hover", path, marked);
    let text = hover["contents"]["value"].as_str();
    text.unwrap_or_else(|| panic!("nothing at {marked}"))
        .to_owned()
}

#[test]
fn hover_explains_in_both_languages() {
    let project = project();
    let mut editor = editor(&project);
    for (path, marked, parts) in [
        // A key, its value, a unit and a built-in type.
        (
            LAMP,
            "    eff|ect: motion",
            [
                "`effect` (required)",
                "Its effect on the robot",
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
        // A type at its declaration or its use: texts, Rust and JSON.
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
        // An operation at its declaration or its use.
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
        // A field, an enum value, an entity and a gap.
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
    // The language of the client comes first.
    for (locale, first) in [("zh-CN", "光斑\n\nA spot"), ("en-GB", "A spot\n\n光斑")] {
        let mut editor = editor_in(&project, locale);
        assert!(
            hover(&mut editor, TYPES, "  Sp|ot:\n").contains(first),
            "{locale}"
        );
    }
}

#[test]
fn a_name_leads_to_its_definition() {
    let project = project();
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
        // `fcproto where` names the same place.
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
fn references_are_found_in_all_files() {
    let project = project();
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
    // `Phase` is the type of fields and the key of a condition.
    assert_eq!(ask(&mut editor, TYPES, "  Pha|se:\n", false), ["Phase"; 4]);
    assert_eq!(ask(&mut editor, LAMP, "  ala|rm:\n", true), ["alarm"; 2]);
}

#[test]
fn a_file_has_an_outline() {
    let project = project();
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
