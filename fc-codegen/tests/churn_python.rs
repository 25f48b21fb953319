//! Who adds to a group of a spec changes the file of that group and the samples, and no other file of the Python package:
//! two branches that add to different groups never meet.

#![allow(clippy::expect_used, clippy::panic, reason = "tests")]

#[path = "../../fc-spec/tests/good_spec/mod.rs"]
mod good_spec;

use fc_codegen::emit::python;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::Lang;
use fc_spec::syntax::Sources;
use std::collections::BTreeMap;

/// A second group, with one of each kind.
const GROUP: &str = "\
group: { id: second, zh: 第二组, en: The second group }
commands:
  start: { code: 0x0102, zh: 开始, en: Start, effect: motion, source: { sections: [] }, sets_off: [started] }
reports:
  started: { code: 0x0202, zh: 已开始, en: Started, source: { sections: [] } }
streams:
  beam: { code: 0x0502, from: robot, zh: 光束, en: Beam, source: { sections: [] } }
";

/// What is made of the good spec with this group.
fn files(group: &str) -> BTreeMap<String, String> {
    let good = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    let second = ("spec/commands/second.yaml".to_owned(), group.to_owned());
    let sources = Sources::from_texts(good.into_iter().chain([second]));
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    let model =
        model.unwrap_or_else(|| panic!("{}", render(&faults, &sources, Format::Text, Lang::En)));
    let files = python::emit(&model, &Targets::default()).into_iter();
    files.map(|it| (it.path, it.contents)).collect()
}

#[test]
fn an_addition_changes_the_file_of_its_group_and_the_samples() {
    let before = files(GROUP);
    for (section, added) in [
        (
            "commands:\n",
            "  measure: { code: 0x0103, zh: 测量, en: Measure, effect: read, source: { sections: [] }, \
             errors: [{ code: 3, zh: 坏, en: Broken }], response: { level: { type: u8, example: 1, zh: 值, en: Level } } }\n",
        ),
        (
            "commands:\n",
            "  turn: { code: 0x0104, zh: 转, en: Turn, effect: motion, source: { sections: [] }, sets_off: [started] }\n",
        ),
        (
            "reports:\n",
            "  turned: { code: 0x0203, zh: 已转, en: Turned, source: { sections: [] } }\n",
        ),
        (
            "streams:\n",
            "  firmware: { code: 0x0503, from: app, zh: 固件, en: Firmware, source: { sections: [] } }\n",
        ),
    ] {
        let after = files(&GROUP.replace(section, &[section, added].concat()));
        assert_eq!(
            before.keys().collect::<Vec<_>>(),
            after.keys().collect::<Vec<_>>()
        );
        let changed = after
            .iter()
            .filter(|(path, text)| before.get(*path) != Some(text));
        let changed: Vec<&str> = changed.map(|(path, _)| path.as_str()).collect();
        assert_eq!(
            changed,
            [
                "stubs/python/src/demo/groups/second.py",
                "stubs/python/tests/test_samples.py"
            ],
            "{added}"
        );
    }
}
