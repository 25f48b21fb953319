//! Reading scenarios.

use crate::support::small;
use fc_reflect::Reflector;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::model::{Dump, Lang};
use fc_spec::source::Sources;
use fc_workshop::scenario::Scenario;
use std::path::Path;

/// A scenario of the small spec, and its errors: place and message.
const FAULTY: &[(&str, &[&str])] = &[
    (
        "on: [{ request: set_lihgt }]",
        &["1:17", "did you mean `set_light`?"],
    ),
    (
        "on: [{ request: dimmed }]",
        &["1:17", "`dimmed` is not a command"],
    ),
    (
        "on:\n  - { request: set_light, refused: 3 }",
        &["2:27", "did you mean `refuse`?"],
    ),
    (
        "on: [{ request: set_light, refuse: 9 }]",
        &["1:36", "there is no result `9`", "invalid"],
    ),
    (
        "on: [{ request: set_light, answer: { left: -1 } }]",
        &["1:36", "out_of_range", "left"],
    ),
    (
        "on: [{ request: set_light, silent: 1 }]",
        &["expected true or false"],
    ),
    (
        "on: [{ request: set_light, times: -1 }]",
        &["expected an integer"],
    ),
    ("on: [{ answer: {} }]", &["a rule needs `request`"]),
    (
        "expect: [{ acknowledged: set_light }]",
        &["`set_light` is not a report"],
    ),
    (
        "expect: set_light",
        &["expected a list, found a plain value"],
    ),
    ("on: [", &["1:"]),
];

#[test]
fn errors_of_a_scenario_have_their_place() {
    let model = small();
    let reflector = Reflector::new(&model);
    for (text, expected) in FAULTY {
        let sources = Sources::from_texts([("s.yaml", *text)]);
        let mut faults = Faults::new();
        assert_eq!(
            Scenario::read(&reflector, &sources, &mut faults),
            None,
            "{text}"
        );
        let shown = render(&faults, &sources, Format::Text, Lang::En);
        for part in *expected {
            assert!(shown.contains(part), "{text} lacks {part:?}:\n{shown}");
        }
    }
}

#[test]
fn the_scenarios_of_the_repository_fit_the_release() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let release = std::fs::read_to_string(root.join("spec/releases/2024.09.json")).unwrap();
    let model = Dump::read(&release).unwrap();
    let reflector = Reflector::new(&model);
    let mut count = 0;
    for entry in std::fs::read_dir(root.join("conformance/scenarios")).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let sources = Sources::from_texts([(path.display().to_string(), text)]);
        let mut faults = Faults::new();
        let scenario = Scenario::read(&reflector, &sources, &mut faults);
        let shown = render(&faults, &sources, Format::Text, Lang::En);
        assert!(scenario.is_some_and(|it| !it.expect.is_empty()), "{shown}");
        count += 1;
    }
    assert!(count >= 3, "{count} scenarios");
}
