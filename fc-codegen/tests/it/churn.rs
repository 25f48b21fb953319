//! Lists the files that a small addition changes. The files of a group contain everything about its operations, so a
//! review reads few files per language. Two branches that add to different groups rarely touch the same file.

use crate::good_spec;
use fc_codegen::emit::{generate, kotlin};
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::source::Sources;
use std::collections::{BTreeMap, BTreeSet};

/// A second group next to the good spec, with an operation of each kind.
const LAMP: &str = "\
group: { id: lamp, zh: 灯, en: Lamp }
commands:
  get_lamp:
    code: 0x0111
    zh: 查灯
    en: Get the lamp
    effect: read
    source: { sections: [] }
    response: { lit: { type: bool, example: true, zh: 亮, en: Whether it is lit } }
  start_lamp: { code: 0x0112, zh: 开灯, en: Start the lamp, effect: motion, source: { sections: [] }, sets_off: [lamp_changed] }
reports:
  lamp_changed: { code: 0x0211, zh: 灯变了, en: The lamp has changed, source: { sections: [] } }
streams:
  lamp_picture: { code: 0x0511, zh: 灯的图片, en: Picture of the lamp, from: robot, content: image/png, source: { sections: [] } }
";

/// Returns the group with another operation at the top of a section.
fn with(section: &str, operation: &str) -> String {
    let head = format!("{section}:\n");
    assert!(LAMP.contains(&head), "{section}");
    LAMP.replace(&head, &format!("{head}{operation}\n"))
}

/// Returns the model of the good spec with this group.
fn model(lamp: &str) -> Model {
    let good = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    let lamp = ("spec/commands/lamp.yaml".to_owned(), lamp.to_owned());
    let sources = Sources::from_texts(good.into_iter().chain([lamp]));
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    model.unwrap_or_else(|| panic!("{}", render(&faults, &sources, Format::Text, Lang::En)))
}

/// Returns all generated files by their paths.
fn made(lamp: &str) -> BTreeMap<String, String> {
    let artifacts =
        generate(&model(lamp), &Targets::default()).expect("every target can be written");
    let artifacts = artifacts.into_iter();
    artifacts.map(|it| (it.path, it.contents)).collect()
}

/// Returns the files that an addition changes or creates, in all languages.
fn changed(before: &BTreeMap<String, String>, lamp: &str) -> BTreeSet<String> {
    let after = made(lamp);
    let paths = before.keys().chain(after.keys());
    let paths = paths.filter(|path| before.get(*path) != after.get(*path));
    paths.cloned().collect()
}

/// Files that every addition changes.
const ALWAYS: [&str; 18] = [
    "docs-site/en/reference/index.md",
    "docs-site/reference/index.md",
    "docs-site/reference/navigation.json",
    "fc-generated/src/descriptors.rs",
    "fc-generated/tests/samples.rs",
    "stubs/cpp/generated/include/demo/groups/lamp.hpp",
    "stubs/cpp/generated/src/groups/lamp.cpp",
    "stubs/cpp/tests/samples.cpp",
    "stubs/kotlin/generated/src/main/kotlin/demo/Lamp.kt",
    "stubs/kotlin/generated/src/test/kotlin/Samples.kt",
    "stubs/python/src/demo/groups/lamp.py",
    "stubs/python/tests/test_samples.py",
    "stubs/typescript/generated/groups/lamp/messages.ts",
    "stubs/typescript/generated/groups/lamp/schemas.ts",
    "stubs/typescript/generated/protocol.ts",
    "stubs/typescript/generated/samples.ts",
    "stubs/wireshark/demo.lua",
    "fc-generated/src/messages/lamp.rs",
];

#[test]
fn addition_changes_its_group_and_the_indexes() {
    let before = made(LAMP);
    for (section, operation, further) in [
        (
            "commands",
            "  dim_lamp: { code: 0x0113, zh: 调暗, en: Dim the lamp, effect: config, source: { sections: [] }, \
             request: { to: { type: u8, example: 3, zh: 亮度, en: Brightness } } }",
            [
                "docs-site/en/reference/commands/dim_lamp.md",
                "docs-site/reference/commands/dim_lamp.md",
                "fc-generated/src/robot.rs",
                "fc-generated/vectors/dim_lamp.json",
                "stubs/typescript/generated/groups/lamp/commands.ts",
            ]
            .as_slice(),
        ),
        (
            "reports",
            "  lamp_failed: { code: 0x0212, zh: 灯坏了, en: The lamp has failed, source: { sections: [] }, \
             body: { hours: { type: u32, example: 900, zh: 小时, en: For how long it was lit } } }",
            &[
                "docs-site/en/reference/reports/lamp_failed.md",
                "docs-site/reference/reports/lamp_failed.md",
                "fc-generated/src/client.rs",
                "fc-generated/vectors/lamp_failed.json",
                "stubs/typescript/generated/groups/lamp/reports.ts",
            ],
        ),
    ] {
        let changed = changed(&before, &with(section, operation));
        let expected = ALWAYS.iter().chain(further);
        let expected: BTreeSet<String> = expected.map(|&path| path.to_owned()).collect();
        assert_eq!(changed, expected, "{section}");
    }
}

/// A group's file has the name of the group, unless a file of the package has it already.
#[test]
fn group_may_have_the_name_of_a_kotlin_part() {
    for (id, file) in [
        ("client", "ClientGroup.kt"),
        ("protocol", "ProtocolGroup.kt"),
        ("shared_types", "SharedTypesGroup.kt"),
        ("lamp_2", "Lamp2.kt"),
    ] {
        let lamp = LAMP.replace("id: lamp,", &format!("id: {id},"));
        let files = kotlin::emit(&model(&lamp), &Targets::default()).into_iter();
        let name = |path: &str| path.rsplit('/').next().unwrap_or_default().to_owned();
        let files: BTreeMap<String, String> =
            files.map(|it| (name(&it.path), it.contents)).collect();
        let text = files.get(file).map_or("", String::as_str);
        assert!(
            text.contains("class GetLampRequest "),
            "{id}: {:?}",
            files.keys()
        );
        assert!(files.contains_key("Client.kt") && files.contains_key("Protocol.kt"));
    }
}
