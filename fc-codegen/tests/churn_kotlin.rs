//! What is added to a group changes the group's own file of the Kotlin package and the samples, which list all there is; and no
//! other file, where reviews would drown and branches meet.

#![allow(clippy::expect_used, reason = "tests")]

#[path = "../../fc-spec/tests/good_spec/mod.rs"]
mod good_spec;

use fc_codegen::emit::kotlin;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::Lang;
use fc_spec::syntax::Sources;
use std::collections::BTreeMap;

/// A group beside that of the good spec.
const LAMP: &str = "\
group: { id: lamp, zh: 灯, en: Lamp }
commands:
  get_lamp: { code: 0x0111, zh: 读灯, en: Get the lamp, effect: read, source: { sections: [] } }
reports:
  lamp_changed: { code: 0x0211, zh: 灯变了, en: The lamp has changed, source: { sections: [] } }
streams:
  lamp_picture: { code: 0x0511, zh: 灯的图片, en: Picture of the lamp, from: robot, source: { sections: [] } }
";

/// The package of the good spec with one more group, by the names of the files.
fn package(more: &str) -> BTreeMap<String, String> {
    let good = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    let more = ("spec/commands/lamp.yaml".to_owned(), more.to_owned());
    let sources = Sources::from_texts(good.into_iter().chain([more]));
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    assert!(
        !faults.has_errors(),
        "{}",
        render(&faults, &sources, Format::Text, Lang::En)
    );
    let model = model.expect("it has no errors");
    let files = kotlin::emit(&model, &Targets::default()).into_iter();
    let name = |path: &str| path.rsplit('/').next().unwrap_or_default().to_owned();
    files.map(|it| (name(&it.path), it.contents)).collect()
}

/// The files that are not the same in both, or are in one alone.
fn changed(before: &BTreeMap<String, String>, after: &BTreeMap<String, String>) -> Vec<String> {
    let names = before.keys().chain(after.keys());
    let names = names.filter(|name| before.get(*name) != after.get(*name));
    let mut names: Vec<String> = names.cloned().collect();
    names.sort();
    names.dedup();
    names
}

#[test]
fn what_is_added_to_a_group_is_in_the_file_of_the_group() {
    let before = package(LAMP);
    for (kind, added) in [
        (
            "commands",
            // The first of the group that moves something, and one with types of its own.
            "  turn_lamp:
    code: 0x0112
    zh: 转灯
    en: Turn the lamp
    effect: motion
    source: { sections: [] }
    request:
      angle: { type: LampAngle, zh: 角度, en: Angle }
    response:
      data:
        reached: { type: i32, example: 3, zh: 角度, en: Angle }
",
        ),
        (
            "reports",
            "  lamp_turned: { code: 0x0212, zh: 灯转了, en: The lamp has turned, source: { sections: [] } }\n",
        ),
        (
            "streams",
            "  lamp_glow: { code: 0x0512, zh: 灯光, en: Glow of the lamp, from: robot, source: { sections: [] } }\n",
        ),
    ] {
        let head = format!("{kind}:\n");
        let mut more = LAMP.replace(&head, &[&head, added].concat());
        if added.contains("LampAngle") {
            more.push_str("types:\n  LampAngle: { enum: u8, zh: 角度, en: Angle, values: { 0: { name: up, zh: 上, en: Up } } }\n");
        }
        let after = package(&more);
        assert_eq!(
            changed(&before, &after),
            ["Lamp.kt", "Samples.kt"],
            "{kind}"
        );
    }
}

/// The file of a group is called like the group, unless a file of the package is.
#[test]
fn a_group_may_be_called_like_a_part_of_the_package() {
    for (id, file) in [
        ("client", "ClientGroup.kt"),
        ("protocol", "ProtocolGroup.kt"),
        ("shared_types", "SharedTypesGroup.kt"),
        ("lamp_2", "Lamp2.kt"),
    ] {
        let files = package(&LAMP.replace("id: lamp,", &format!("id: {id},")));
        let text = files.get(file).map_or("", String::as_str);
        assert!(
            text.contains("class GetLampRequest "),
            "{id}: {:?}",
            files.keys()
        );
        assert!(files.contains_key("Client.kt") && files.contains_key("Protocol.kt"));
    }
}
