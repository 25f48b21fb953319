//! An added operation touches the files of its group and the samples, and no other file of the C++ package.

#![allow(clippy::expect_used, clippy::panic, reason = "tests")]

#[path = "../../fc-spec/tests/good_spec/mod.rs"]
mod good_spec;

use fc_codegen::emit::cpp;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::Lang;
use fc_spec::syntax::Sources;
use std::collections::{BTreeMap, BTreeSet};

/// A group with a command and a report.
const LAMPS: &str = "
group: { id: lamps, zh: 灯, en: Lamps }
commands:
  get_lamp:
    code: 0x0151
    zh: 查灯
    en: Get a lamp
    effect: read
    source: { sections: [] }
    response:
      lit: { type: bool, example: true, zh: 亮, en: Whether it is lit }
reports:
  lamp_changed:
    code: 0x0251
    zh: 灯变了
    en: A lamp has changed
    source: { sections: [] }
    body:
      lit: { type: bool, example: true, zh: 亮, en: Whether it is lit }
";

/// Another.
const DOORS: &str = "
group: { id: doors, zh: 门, en: Doors }
commands:
  get_door:
    code: 0x0152
    zh: 查门
    en: Get a door
    effect: read
    source: { sections: [] }
    response:
      open: { type: bool, example: true, zh: 开, en: Whether it is open }
";

const COMMAND: &str = "
  dim_lamp:
    code: 0x0153
    zh: 调暗
    en: Dim a lamp
    effect: motion
    source: { sections: [] }
    request:
      level: { type: u8, example: 3, zh: 亮度, en: How bright it is to be }
reports:";

const REPORT: &str = "
  lamp_failed:
    code: 0x0252
    zh: 灯坏了
    en: A lamp has failed
    source: { sections: [] }
    body:
      hours: { type: u32, example: 900, zh: 小时, en: For how long it was lit }
";

/// The package of the good spec with both groups.
fn package(lamps: &str) -> BTreeMap<String, String> {
    let good = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    let groups = [("lamps", lamps), ("doors", DOORS)]
        .map(|(id, text)| (format!("spec/commands/{id}.yaml"), text.to_owned()));
    let sources = Sources::from_texts(good.into_iter().chain(groups));
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    let model =
        model.unwrap_or_else(|| panic!("{}", render(&faults, &sources, Format::Text, Lang::En)));
    let files = cpp::emit(&model, &Targets::default()).into_iter();
    files.map(|it| (it.path, it.contents)).collect()
}

/// The files that are not the same in both, by the ends of their paths.
fn changed(
    before: &BTreeMap<String, String>,
    after: &BTreeMap<String, String>,
) -> BTreeSet<String> {
    let paths = before.keys().chain(after.keys());
    let paths = paths.filter(|path| before.get(*path) != after.get(*path));
    let within = |path: &String| path.trim_start_matches("stubs/cpp/").to_owned();
    paths.map(within).collect()
}

#[test]
fn an_added_operation_touches_its_group_alone() {
    let before = package(LAMPS);
    let command = LAMPS.replace("\nreports:", COMMAND);
    let report = format!("{LAMPS}{REPORT}");
    for (what, lamps, name) in [
        ("command", command, "dim_lamp"),
        ("report", report, "lamp_failed"),
    ] {
        assert_ne!(lamps, LAMPS, "{what}");
        let after = package(&lamps);
        let mut files = changed(&before, &after);
        let group = files
            .iter()
            .filter(|path| path.contains("/groups/lamps."))
            .count();
        assert_eq!(group, 2, "{what}: {files:?}");
        files.retain(|path| !path.contains("/groups/lamps."));
        assert_eq!(
            files,
            BTreeSet::from(["tests/samples.cpp".to_owned()]),
            "{what}"
        );
        let header = after
            .iter()
            .find(|(path, _)| path.ends_with("/groups/lamps.hpp"));
        assert!(
            header.is_some_and(|(_, text)| text.contains(name)),
            "{what}"
        );
    }
}
