//! How many files a small addition changes: all about a command is in the files of its group, so that a review reads
//! one file a language, and two branches that add to different groups do not meet.

#![allow(clippy::expect_used, clippy::panic, reason = "tests")]

#[path = "../../fc-spec/tests/good_spec/mod.rs"]
mod good_spec;

use fc_codegen::emit::generate;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::Lang;
use fc_spec::syntax::Sources;
use std::collections::BTreeMap;

const GROUP: &str = "\
group: { id: fan, zh: 风扇, en: Fan }
commands:
  get_speed:
    code: 0x0102
    zh: 获取转速
    en: Get the speed
    effect: read
    source: { sections: [] }
    response: { speed: { type: u16, example: 900, zh: 转速, en: Speed } }
";

const COMMAND: &str = r"  get_fan_model:
    code: 0x0103
    zh: 获取风扇型号
    en: Get the model of the fan
    effect: read
    source: { sections: [] }
    response: { model: { type: string, example: F-12, zh: 型号, en: Model } }
";

/// Everything that is made of the good spec and one group more, by path.
fn made(group: &str) -> BTreeMap<String, String> {
    let good = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    let more = ("spec/commands/fan.yaml".to_owned(), group.to_owned());
    let sources = Sources::from_texts(good.into_iter().chain([more]));
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    let model =
        model.unwrap_or_else(|| panic!("{}", render(&faults, &sources, Format::Text, Lang::En)));
    let artifacts = generate(&model, &Targets::default()).expect("the spec can be written");
    let artifacts = artifacts.into_iter();
    artifacts.map(|it| (it.path, it.contents)).collect()
}

/// The files that differ, and those that are new.
fn changed(before: &BTreeMap<String, String>, after: &BTreeMap<String, String>) -> Vec<String> {
    assert!(before.keys().all(|path| after.contains_key(path)));
    let differ = after
        .iter()
        .filter(|(path, text)| before.get(*path) != Some(text));
    differ.map(|(path, _)| path.clone()).collect()
}

#[test]
fn a_command_changes_the_files_of_its_group_and_those_that_list_all() {
    let before = made(GROUP);
    let after = made(&[GROUP, COMMAND].concat());
    let mut changed = changed(&before, &after);
    changed.retain(|path| !path.starts_with("stubs/"));
    let expected = [
        "docs-site/en/reference/commands/get_fan_model.md",
        "docs-site/en/reference/index.md",
        "docs-site/reference/commands/get_fan_model.md",
        "docs-site/reference/index.md",
        "docs-site/reference/navigation.json",
        "fc-generated/src/descriptors.rs",
        "fc-generated/src/messages/fan.rs",
        "fc-generated/src/robot.rs",
        "fc-generated/tests/samples.rs",
        "fc-generated/vectors/get_fan_model.json",
    ];
    assert_eq!(changed, expected, "{changed:#?}");
}
