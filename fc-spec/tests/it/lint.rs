//! Tests the lint rules with the changes in `lint/rules.txt`. Each change starts from the small spec in `lint/spec`, to
//! which no rule objects.
//!
//! A change has a title (`# …`), the text to replace in `commands/lamp.yaml` (`-…`) and its replacement (`+…`). The
//! lines with `>` are all findings of any level. `BLESS=1` writes them.

use crate::syntax_support;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::index::definitions;
use fc_spec::lint::{Finding, Rule, Settings, faults, lint, settings, waive};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::source::Sources;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const TODAY: &str = "2026-11-24";

fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lint")
}

fn file(path: &str) -> String {
    std::fs::read_to_string(directory().join(path)).expect("a file of the tests")
}

/// Returns the small spec with other commands, and with `more` at the end of `protocol.yaml`.
fn spec(commands: &str, more: &str) -> (Sources, Model) {
    let files = [
        ("spec/protocol.yaml", file("spec/protocol.yaml") + more),
        ("spec/commands/lamp.yaml", commands.to_owned()),
        ("spec/commands/siren.yaml", file("spec/commands/siren.yaml")),
    ];
    let sources = Sources::from_texts(files);
    let mut found = Faults::new();
    let model = load(&sources, &mut found).model();
    assert!(
        !found.has_errors(),
        "{}",
        render(&found, &sources, Format::Text, Lang::En)
    );
    (sources, model.expect("no errors"))
}

/// Reads settings from the text of `fc.yaml`. Returns them with the rendered errors.
fn set(yaml: &str) -> (Settings, String) {
    let root = tempfile::tempdir().expect("a directory for the test");
    std::fs::write(root.path().join("fc.yaml"), yaml).expect("a file of the project");
    let shared = file("shared.yaml");
    std::fs::write(root.path().join("shared.yaml"), shared).expect("a file of the project");
    let mut found = Faults::new();
    let (settings, sources) = settings(root.path(), "fc.yaml", &mut found);
    found.sort();
    (settings, render(&found, &sources, Format::Text, Lang::En))
}

/// Returns settings with every category switched on.
fn everything() -> Settings {
    let levels = ["MINIMAL", "STANDARD", "DOCS", "WIRE", "SUNSET"];
    let levels = levels.map(|category| format!("{category}: warning"));
    let (settings, wrong) = set(&format!(
        "lint: {{ levels: {{ {} }} }}\n",
        levels.join(", ")
    ));
    assert_eq!(wrong, "");
    settings
}

#[derive(Default)]
struct Change {
    title: String,
    old: Vec<String>,
    new: Vec<String>,
}

fn changes() -> Vec<Change> {
    let mut changes: Vec<Change> = Vec::new();
    for line in file("rules.txt").lines() {
        let (sign, rest) = line.split_at(line.len().min(1));
        match (sign, changes.last_mut()) {
            ("#", _) => changes.push(Change {
                title: rest.trim().to_owned(),
                ..Change::default()
            }),
            ("-", Some(change)) => change.old.push(rest.to_owned()),
            ("+", Some(change)) => change.new.push(rest.to_owned()),
            (">" | "", _) => {}
            _ => panic!("{line}"),
        }
    }
    changes
}

impl Change {
    fn made(&self) -> (Sources, Model) {
        let good = file("spec/commands/lamp.yaml");
        let mut old = self.old.join("\n");
        let mut new = self.new.join("\n");
        if new.is_empty() {
            old += "\n";
        }
        assert!(good.contains(&old), "{}: no such lines", self.title);
        if old.is_empty() {
            new += "\n";
        }
        spec(&good.replacen(&old, &new, 1), "")
    }
}

fn shown(findings: &[Finding], sources: &Sources, lang: Lang) -> Vec<String> {
    let found = faults(findings, &everything(), || definitions(sources));
    let shown = found.iter().map(|fault| {
        let at = sources.line_col(fault.primary.span);
        let path = sources.path(fault.primary.span).trim_start_matches("spec/");
        let (line, column) = (at.line, at.column);
        format!(
            "{} {path}:{line}:{column} {}",
            fault.code,
            lang.text(&fault.message)
        )
    });
    shown.collect()
}

#[test]
fn no_rule_objects_to_the_small_spec() {
    let (sources, model) = spec(&file("spec/commands/lamp.yaml"), "");
    let findings = lint(&model, &Settings::default(), TODAY);
    assert_eq!(shown(&findings, &sources, Lang::En), Vec::<String>::new());
}

#[test]
fn every_rule_finds_its_case() {
    let mut actual = String::new();
    let mut seen = BTreeSet::new();
    for change in changes() {
        let (sources, model) = change.made();
        let findings = lint(&model, &Settings::default(), TODAY);
        seen.extend(findings.iter().map(|finding| finding.rule.code.number));
        if !actual.is_empty() {
            actual.push('\n');
        }
        let _ = writeln!(actual, "# {}", change.title);
        for (sign, lines) in [('-', &change.old), ('+', &change.new)] {
            for line in lines {
                let _ = writeln!(actual, "{sign}{line}");
            }
        }
        let [en, zh] = [Lang::En, Lang::Zh].map(|lang| shown(&findings, &sources, lang));
        for (en, zh) in en.iter().zip(&zh) {
            let zh = zh.splitn(3, ' ').last().unwrap_or_default();
            let _ = writeln!(actual, "> {en}\n>   {zh}");
        }
        if en.is_empty() {
            actual += "> nothing\n";
        }
    }
    syntax_support::golden(&directory().join("rules.txt"), &actual);
    let rules = Rule::all().map(|rule| rule.code.number);
    // The codes from FC0890 on are about project rules and waivers, which have separate tests.
    let unseen: Vec<_> = rules
        .filter(|code| *code < "FC0890" && !seen.contains(code))
        .collect();
    assert!(unseen.is_empty(), "no change is found by {unseen:?}");
}

#[test]
fn codes_and_names_are_told_apart() {
    let codes: Vec<_> = Rule::all().map(|rule| rule.code.number).collect();
    assert!(codes.is_sorted_by(|a, b| a < b), "{codes:?}");
    let names: BTreeSet<_> = Rule::all().map(|rule| rule.name).collect();
    assert_eq!(names.len(), codes.len());
    for rule in Rule::all() {
        assert_eq!(Rule::parse(rule.name), Some(rule));
        assert_eq!(
            Rule::parse(rule.code.number.trim_start_matches("FC0")),
            Some(rule)
        );
    }
}

fn house(yaml: &str) -> Vec<String> {
    let (settings, wrong) = set(yaml);
    assert_eq!(wrong, "");
    let (sources, model) = spec(&file("spec/commands/lamp.yaml"), "");
    let findings = lint(&model, &settings, TODAY);
    let found = faults(&findings, &settings, || definitions(&sources));
    let shown = found.iter().map(|fault| {
        let name = sources.slice(fault.primary.span);
        format!("{} {name} {:?}", fault.message.en, fault.severity)
    });
    shown.collect()
}

/// Each rule in `house.yaml` and `shared.yaml` lists in its English text the names that it finds.
#[test]
fn rules_of_the_project_find_their_case() {
    let yaml = file("house.yaml");
    let found = house(&yaml);
    let mut expected = Vec::new();
    let all = yaml.clone() + &file("shared.yaml");
    for line in all
        .lines()
        .filter_map(|line| line.trim().strip_prefix("en: \""))
    {
        let id = line.split(':').next().unwrap_or_default();
        let names = line
            .split(": ")
            .nth(1)
            .unwrap_or_default()
            .trim_matches('"');
        let names = names
            .split(' ')
            .filter(|name| !name.is_empty() && *name != "nothing");
        expected.extend(names.map(|name| format!("{id} {name}")));
    }
    let mut actual: Vec<_> = found
        .iter()
        .map(|line| {
            let id = line.split(':').next().unwrap_or_default();
            let words: Vec<_> = line.split(' ').collect();
            let name = words.iter().rev().nth(1).copied().unwrap_or_default();
            format!("{id} {name}")
        })
        .collect();
    actual.sort();
    expected.sort();
    assert_eq!(actual, expected);
}

#[test]
fn invalid_settings_are_reported_with_their_place() {
    let path = directory().join("settings.txt");
    let mut actual = String::new();
    let text = std::fs::read_to_string(&path).expect("settings");
    for case in text.split("== ").skip(1) {
        let yaml: String = case
            .lines()
            .skip(1)
            .filter(|line| !line.starts_with('>'))
            .flat_map(|line| [line, "\n"])
            .collect();
        let yaml = yaml.trim_end();
        let (_, wrong) = set(yaml);
        assert_ne!(wrong, "", "{yaml}");
        let title = case.lines().next().unwrap_or_default();
        let _ = writeln!(actual, "== {title}\n{yaml}");
        for line in wrong.trim_end().lines() {
            let _ = writeln!(actual, "{}", format!("> {line}").trim_end());
        }
        actual.push('\n');
    }
    syntax_support::golden(&path, &actual);
}

#[test]
fn levels_apply_from_rule_to_category() {
    let rule = |name: &str| Rule::parse(name).expect("a rule");
    let level = |yaml: &str, name: &str| {
        let (settings, wrong) = set(yaml);
        assert_eq!(wrong, "");
        settings.level(rule(name), None).name()
    };
    for (yaml, name, expected) in [
        ("{}", "FC0802", "error"),
        ("{}", "FC0814", "warning"),
        ("{}", "FC0851", "off"),
        (
            "lint: { levels: { STANDARD: warning } }",
            "FC0802",
            "warning",
        ),
        (
            "lint: { levels: { STANDARD: warning } }",
            "FC0812",
            "warning",
        ),
        (
            "lint: { levels: { STANDARD: warning, MINIMAL: error } }",
            "FC0802",
            "error",
        ),
        (
            "lint: { levels: { STANDARD: \"off\", similar-keys: error } }",
            "FC0802",
            "error",
        ),
        ("lint: { levels: { fc0802: 'off' } }", "FC0802", "off"),
        ("lint: { levels: { DOCS: error } }", "FC0802", "error"),
    ] {
        assert_eq!(level(yaml, name), expected, "{yaml}");
    }
}

/// Returns a waiver of this finding that ends at this date.
fn waiver(id: &str, until: &str) -> String {
    format!("waivers:\n  {id}: {{ zh: 已知, en: Known, by: Owner, until: {until} }}\n")
}

#[test]
fn waivers_accept_a_finding_for_a_time() {
    let commands =
        file("spec/commands/lamp.yaml").replace("    cadence: { on_change: angle }\n", "");
    let find = |more: &str, today: &str| {
        let (sources, model) = spec(&commands, more);
        let mut findings = lint(&model, &Settings::default(), today);
        waive(&mut findings, &model.waivers, today);
        let shown = shown(&findings, &sources, Lang::En);
        let codes = shown
            .iter()
            .filter_map(|line| line.get(..6).map(str::to_owned));
        (findings, codes.collect::<Vec<_>>())
    };
    let (findings, codes) = find("", TODAY);
    assert_eq!(codes, ["FC0817"]);
    let id = findings.first().expect("a finding").waiver_id();

    assert_eq!(find(&waiver(&id, "2026-11"), TODAY).1, Vec::<String>::new());
    assert_eq!(
        find(&waiver(&id, "2026-11"), "2026-12-01").1,
        ["FC0817", "FC0891"]
    );
    // A waiver of another finding, and one that only `fcproto diff` can judge.
    let other = "FC0817-000000000000";
    assert_eq!(
        find(&waiver(other, "2026-11"), TODAY).1,
        ["FC0817", "FC0892"]
    );
    let of_diff = "FC0725-000000000000";
    assert_eq!(find(&waiver(of_diff, "2026-11"), TODAY).1, ["FC0817"]);
}

/// A waiver stays valid when lines move or wording changes.
#[test]
fn a_fingerprint_does_not_depend_on_lines() {
    let commands =
        file("spec/commands/lamp.yaml").replace("    cadence: { on_change: angle }\n", "");
    let id = |commands: &str| {
        let (_, model) = spec(commands, "");
        let findings = lint(&model, &Settings::default(), TODAY);
        findings.first().expect("a finding").waiver_id()
    };
    let moved = format!("# A comment above.\n\n{commands}");
    let reworded = moved.replace("A lamp has turned", "The lamp has been turned");
    assert_eq!(id(&commands), id(&reworded));
    assert_ne!(
        id(&commands),
        id(&commands.replace("lamp_turned", "lamp_moved"))
    );
}
