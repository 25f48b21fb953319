//! What changes in the TypeScript package when a group of the spec gets one operation more: the files of the group, and
//! the samples. So branches that each add something to different groups do not meet.

#![allow(clippy::expect_used, clippy::panic, reason = "tests")]

use fc_codegen::emit::typescript;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::Lang;
use fc_spec::syntax::Sources;
use std::collections::{BTreeMap, BTreeSet};

#[path = "../../fc-spec/tests/good_spec/mod.rs"]
mod good_spec;

/// A group that has one of everything.
const LAMP: &str = "\
group: { id: lamp, zh: 灯, en: Lamp }
commands:
  get_lamp:
    code: 0x0103
    zh: 读灯
    en: Get the lamp
    effect: read
    source: { sections: [] }
    response: { lit: { type: bool, example: true, zh: 亮, en: Lit } }
reports:
  lamp_changed:
    code: 0x0202
    zh: 灯变化
    en: Lamp changed
    source: { sections: [] }
    body: { lit: { type: bool, example: true, zh: 亮, en: Lit } }
streams:
  lamp_frames: { code: 0x0204, zh: 画面, en: Frames, from: robot, content: image/png, source: { sections: [] } }
";

/// The same with the keys of one more operation at the end of a section.
fn with(section: &str, operation: &str) -> String {
    let head = format!("{section}:\n");
    assert!(LAMP.contains(&head), "{section}");
    LAMP.replace(&head, &format!("{head}{operation}\n"))
}

/// The files of the package of the good spec and this group, by their paths below `generated`.
fn emitted(lamp: &str) -> BTreeMap<String, String> {
    let good = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    let lamp = ("spec/commands/lamp.yaml".to_owned(), lamp.to_owned());
    let sources = Sources::from_texts(good.into_iter().chain([lamp]));
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    let model =
        model.unwrap_or_else(|| panic!("{}", render(&faults, &sources, Format::Text, Lang::En)));
    let artifacts = typescript::emit(&model, &Targets::default()).into_iter();
    let artifacts = artifacts.map(|it| {
        let path = it.path.strip_prefix("stubs/typescript/generated/");
        (path.expect("its place").to_owned(), it.contents)
    });
    artifacts.collect()
}

#[test]
fn one_operation_more_changes_the_files_of_its_group() {
    let before = emitted(LAMP);
    for (section, operation, files) in [
        (
            "commands",
            "  dim_lamp: { code: 0x0106, zh: 调暗, en: Dim the lamp, effect: config, source: { sections: [] }, \
             request: { to: { type: u8, example: 1, zh: 亮度, en: Brightness } } }",
            ["commands", "messages", "protocol", "schemas"].as_slice(),
        ),
        (
            "reports",
            "  lamp_failed: { code: 0x0203, zh: 灯坏, en: Lamp failed, source: { sections: [] }, \
             body: { lamp: { type: u8, example: 1, zh: 编号, en: Number } } }",
            &["messages", "protocol", "reports", "schemas"],
        ),
        (
            "streams",
            "  lamp_colours: { code: 0x0205, zh: 颜色, en: Colours, from: robot, content: image/png, source: { sections: [] } }",
            &["messages", "protocol", "streams"],
        ),
    ] {
        let after = emitted(&with(section, operation));
        let paths: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
        let changed: Vec<&String> = paths
            .into_iter()
            .filter(|path| before.get(*path) != after.get(*path))
            .collect();
        let expected = files.iter().map(|file| format!("groups/lamp/{file}.ts"));
        let expected: Vec<String> = expected.chain(["samples.ts".to_owned()]).collect();
        assert_eq!(changed, expected.iter().collect::<Vec<_>>(), "{section}");
    }
}
