//! Reading scenarios.

use crate::json_schema::Validator;
use crate::support::{root, small};
use crate::yaml_as_json;
use fc_reflect::Reflector;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::model::{Dump, Lang, Model, Operation, Value};
use fc_spec::source::Sources;
use fc_workshop::app::{self, App};
use fc_workshop::mock::{Mock, Settings};
use fc_workshop::run::block_on;
use fc_workshop::scenario::{Expected, Scenario, Verdict};
use std::collections::BTreeSet;
use std::future::pending;
use std::time::Duration;

/// The time that a command waits for its response.
const WAIT: Duration = Duration::from_secs(1);

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
        "on: [{ request: set_light, omit: [right] }]",
        &["1:35", "has no key `right`"],
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

/// The errors of a scenario of the small spec.
fn errors(text: &str) -> String {
    let model = small();
    let sources = Sources::from_texts([("s.yaml", text)]);
    let mut faults = Faults::new();
    let scenario = Scenario::read(&Reflector::new(&model), &sources, &mut faults);
    assert_eq!(scenario, None, "{text}");
    render(&faults, &sources, Format::Text, Lang::En)
}

#[test]
fn errors_of_a_scenario_have_their_place() {
    for (text, expected) in FAULTY {
        let shown = errors(text);
        for part in *expected {
            assert!(shown.contains(part), "{text} lacks {part:?}:\n{shown}");
        }
    }
}

/// A misspelled key, and the part of the schema that lists the known ones.
const UNKNOWN: &[(&str, &str)] = &[
    ("zzzzzzzz: 1", ""),
    ("on: [{ request: set_light, zzzzzzzz: 1 }]", "/$defs/rule"),
    (
        "on: [{ request: set_light, reports: [{ report: dimmed, zzzzzzzz: 1 }] }]",
        "/$defs/report",
    ),
    (
        "expect: [{ request: set_light, zzzzzzzz: 1 }]",
        "/$defs/expected_request",
    ),
    (
        "expect: [{ acknowledged: dimmed, zzzzzzzz: 1 }]",
        "/$defs/acknowledged",
    ),
];

#[test]
fn the_schema_has_the_keys_of_the_reader() {
    let text = std::fs::read_to_string(root().join("conformance/scenario.schema.json")).unwrap();
    let schema: serde_json::Value = serde_json::from_str(&text).unwrap();
    let validator = Validator { root: &schema };
    let fits = |text: &str| validator.accepts(&schema, &yaml_as_json::parse(text));
    for (text, part) in UNKNOWN {
        let errors = errors(text);
        let (_, known) = errors.split_once("the keys are ").expect(&errors);
        let known = known.lines().next().unwrap().split(", ");
        let known: BTreeSet<&str> = known.map(str::trim).collect();
        let properties = &schema.pointer(part).unwrap()["properties"];
        let keys = properties.as_object().unwrap().keys();
        assert_eq!(known, keys.map(String::as_str).collect(), "{text}");
        assert!(!fits(text), "{text}");
    }
    for entry in std::fs::read_dir(root().join("conformance/scenarios")).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(fits(&text), "{}", path.display());
        // Titles of both languages are for people, so the reader does not demand them.
        assert!(
            text.starts_with("zh: ") && text.contains("\nen: "),
            "{text}"
        );
    }
    for text in [
        "on: [{ refuse: timeout }]",
        "on: [{ request: set_light, silent: 1 }]",
        "on: [{ request: set_light, times: -1 }]",
        "expect: set_light",
        "never: [1]",
    ] {
        assert!(!fits(text) && !errors(text).is_empty(), "{text}");
    }
}

/// The scenarios of the repository, with their names.
fn scenarios(model: &Model) -> Vec<(String, Scenario)> {
    let reflector = Reflector::new(model);
    let mut scenarios = Vec::new();
    for entry in std::fs::read_dir(root().join("conformance/scenarios")).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let sources = Sources::from_texts([(path.display().to_string(), text)]);
        let mut faults = Faults::new();
        let scenario = Scenario::read(&reflector, &sources, &mut faults);
        let shown = render(&faults, &sources, Format::Text, Lang::En);
        let name = path.file_stem().unwrap().display().to_string();
        scenarios.push((name, scenario.unwrap_or_else(|| panic!("{shown}"))));
    }
    scenarios
}

/// Plays a scenario with an app that causes these events. Returns the verdict, and the number of deviations of the mock.
fn play(model: &Model, scenario: &Scenario, events: &[Expected]) -> (Option<Verdict>, usize) {
    let settings = Settings {
        scenario: Some(scenario.clone()),
        expect: true,
        ignores_preconditions: true,
        ..Settings::default()
    };
    let mock = Mock::start(model.clone(), settings).unwrap();
    let settings = app::Settings {
        commands: mock.commands().to_string(),
        data: mock.data().to_string(),
        pace: Duration::ZERO,
        timeout: WAIT,
        expect: true,
    };
    let part = Scenario {
        expect: events.to_vec(),
        ..scenario.clone()
    };
    let reflector = Reflector::new(model);
    let deviations = block_on(async {
        let app = App::connect(&reflector, &settings).await.unwrap();
        app.run(&part, None, &mut |_| Ok(()), pending())
            .await
            .unwrap()
    });
    (mock.verdict(), deviations.unwrap())
}

fn release() -> Model {
    let release = root().join("spec/releases/2024.09.json");
    Dump::read(&std::fs::read_to_string(release).unwrap()).unwrap()
}

#[test]
fn scenarios_are_met_and_broken() {
    let model = &release();
    let scenarios = scenarios(model);
    assert!(scenarios.len() >= 20, "{} scenarios", scenarios.len());
    std::thread::scope(|scope| {
        for (name, scenario) in scenarios {
            scope.spawn(move || {
                let events = &scenario.expect;
                let played = play(model, &scenario, events);
                assert_eq!(played, (Some(Verdict::Met), 0), "{name}");

                let (_, before) = events.split_last().unwrap();
                let short = Scenario {
                    within: Duration::from_secs(3),
                    ..scenario.clone()
                };
                let (verdict, _) = play(model, &short, before);
                assert!(matches!(verdict, Some(Verdict::Missing(_))), "{name}");

                if let Some(never) = scenario.never.first() {
                    let forbidden = [Expected::Request(never.clone(), Value::Null)];
                    let (verdict, _) = play(model, &scenario, &forbidden);
                    assert_eq!(verdict, Some(Verdict::Forbidden(never.clone())), "{name}");
                }
            });
        }
    });
}

#[test]
fn each_process_of_the_release_has_a_scenario() {
    let model = release();
    let scenarios = scenarios(&model);
    let starts = |command: &Operation| {
        scenarios.iter().any(|(_, scenario)| {
            let mut rules = scenario.rules.iter();
            rules.any(|rule| rule.request == command.name && rule.action.reports.is_some())
        })
    };
    for command in &model.operations {
        let is_process = !command.sets_off().is_empty() && command.code.value.is_some();
        assert!(!is_process || starts(command), "{}", command.name);
    }
}
