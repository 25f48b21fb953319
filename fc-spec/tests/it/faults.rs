//! Every error code has a fixture: a file in `bad/` that is added to the small valid spec in `good/`.
//!
//! Comments at the top of a fixture list exactly the errors that it causes.
//!
//! - `# expect: FC0203 at 12:30`: this code at this line and column of the fixture. `FC0203 at good/protocol.yaml 1:1`
//!   is an error in another file.
//! - `# also: 5:3`: a secondary place of the error above.
//! - `# fix: "quoted"`: the replacement text of the first fix. Applying it must remove the error.
//! - `# without: limits`: a section to remove from the good spec.
//!
//! A fixture with a group or operations goes to `commands/`, unless it has `# outside`. A section that a spec has only
//! once replaces that of the good spec, unless the fixture has `# keep`.

use crate::both_languages;
use crate::declared_faults;
use fc_spec::diagnostic::{Diagnostic, FaultCode, Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::Lang;
use fc_spec::source::{Sources, Span};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Sections that a spec has only once. A fixture replaces them.
const ONCE: &[&str] = &[
    "protocol",
    "transport",
    "frame",
    "envelope",
    "results",
    "calls",
    "ack",
    "limits",
    "codes",
    "sections",
    "changes",
    "availability",
    "entities",
    "coordinates",
    "stores",
    "glossary",
];

/// Sections of files in `commands/`.
const GROUPED: &[&str] = &["group", "commands", "reports", "streams"];

struct Fixture {
    name: String,
    text: String,
}

/// An error in the notation of the fixtures.
#[derive(Debug, PartialEq, Eq)]
struct Found {
    fault: String,
    also: Vec<String>,
    fix: Option<String>,
}

fn read(path: impl AsRef<Path>) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests")
        .join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn fixtures() -> Vec<Fixture> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let mut fixtures: Vec<_> = fs::read_dir(folder)
        .expect("tests/bad can be read")
        .map(|entry| {
            let name = entry.expect("an entry").file_name();
            let name = name.to_str().expect("a UTF-8 name").to_owned();
            let text = read(Path::new("bad").join(&name));
            Fixture { name, text }
        })
        .collect();
    fixtures.sort_by(|a, b| a.name.cmp(&b.name));
    fixtures
}

impl Fixture {
    fn directives<'a>(&'a self, key: &'a str) -> impl Iterator<Item = &'a str> {
        let comments = self.text.lines().map_while(|line| line.strip_prefix("# "));
        comments.filter_map(move |line| line.strip_prefix(key))
    }

    fn expected(&self) -> Vec<Found> {
        let mut expected: Vec<Found> = Vec::new();
        for line in self.text.lines().map_while(|line| line.strip_prefix("# ")) {
            if let Some(fault) = line.strip_prefix("expect: ") {
                expected.push(Found {
                    fault: fault.to_owned(),
                    also: Vec::new(),
                    fix: None,
                });
            } else if let (Some(place), Some(last)) =
                (line.strip_prefix("also: "), expected.last_mut())
            {
                last.also.push(place.to_owned());
            } else if let (Some(fix), Some(last)) =
                (line.strip_prefix("fix: "), expected.last_mut())
            {
                last.fix = Some(fix.to_owned());
            }
        }
        expected
    }

    fn path(&self) -> String {
        let outside = self.text.lines().any(|line| line == "# outside");
        let grouped = GROUPED
            .iter()
            .any(|section| has_section(&self.text, section));
        let folder = if grouped && !outside { "commands/" } else { "" };
        // The name sorts after the good spec, so a duplicate is reported in the fixture.
        format!("spec/{folder}z_{}", self.name)
    }

    /// Returns the good spec with `text` as an additional file, which replaces sections of it.
    fn sources(&self, text: &str) -> Sources {
        let keep = self.text.lines().any(|line| line == "# keep");
        let without: BTreeSet<&str> = self.directives("without: ").collect();
        let dropped = |section: &str| {
            without.contains(section)
                || (!keep && ONCE.contains(&section) && has_section(text, section))
        };
        let good = ["protocol.yaml", "commands/demo.yaml"];
        let good = good.map(|path| {
            let text = drop_sections(&read(Path::new("good").join(path)), dropped);
            (format!("spec/{path}"), text)
        });
        Sources::from_texts(good.into_iter().chain([(self.path(), text.to_owned())]))
    }

    fn faults(&self, text: &str) -> (Sources, Faults) {
        let sources = self.sources(text);
        let mut faults = Faults::new();
        let model = load(&sources, &mut faults).model();
        assert_eq!(model.is_none(), faults.has_errors(), "{}", self.name);
        faults.sort();
        (sources, faults)
    }

    fn place(&self, sources: &Sources, span: Span) -> String {
        let at = sources.line_col(span);
        match sources.path(span) {
            path if path == self.path() => format!("{}:{}", at.line, at.column),
            path => {
                let path = path.strip_prefix("spec/").unwrap_or(path);
                format!("good/{path} {}:{}", at.line, at.column)
            }
        }
    }

    fn found(&self, sources: &Sources, fault: &Diagnostic) -> Found {
        let place = self.place(sources, fault.primary.span);
        let also = fault.secondary.iter();
        Found {
            fault: format!("{} at {place}", fault.code),
            also: also.map(|label| self.place(sources, label.span)).collect(),
            fix: fault.fixes.first().map(|fix| fix.replacement.clone()),
        }
    }
}

fn has_section(text: &str, section: &str) -> bool {
    text.lines().any(|line| {
        line.strip_prefix(section)
            .is_some_and(|rest| rest.starts_with(':'))
    })
}

/// Blanks top-level sections. The lines of the other sections keep their numbers.
fn drop_sections(text: &str, dropped: impl Fn(&str) -> bool) -> String {
    let mut out = String::new();
    let mut dropping = false;
    for line in text.lines() {
        if line.starts_with(|c: char| c.is_ascii_lowercase()) {
            dropping = line.split(':').next().is_some_and(&dropped);
        }
        out.push_str(if dropping { "" } else { line });
        out.push('\n');
    }
    out
}

#[test]
fn the_good_spec_has_no_faults() {
    let fixture = Fixture {
        name: "empty.yaml".to_owned(),
        text: "types: {}\n".to_owned(),
    };
    let (sources, faults) = fixture.faults(&fixture.text);
    assert!(
        faults.is_empty(),
        "{}",
        render(&faults, &sources, Format::Text, Lang::En)
    );
}

#[test]
fn every_fixture_has_exactly_the_faults_it_expects() {
    let mut failed = Vec::new();
    for fixture in fixtures() {
        let (sources, faults) = fixture.faults(&fixture.text);
        let found: Vec<_> = faults
            .iter()
            .map(|fault| fixture.found(&sources, fault))
            .collect();
        let expected = fixture.expected();
        if found != expected || expected.is_empty() {
            let shown = render(&faults, &sources, Format::Text, Lang::En);
            failed.push(format!(
                "{}\nexpected {expected:#?}\nfound {found:#?}\n{shown}",
                fixture.name
            ));
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn each_error_is_in_both_languages() {
    let objections: Vec<_> = fixtures()
        .iter()
        .flat_map(|fixture| {
            let (_, faults) = fixture.faults(&fixture.text);
            both_languages::objections(&fixture.name, &faults)
        })
        .collect();
    assert!(objections.is_empty(), "{}", objections.join("\n"));
}

/// The first of several fixes is the likeliest. A fix at a declaration may leave errors at its uses.
#[test]
fn the_first_fix_mends_its_fault() {
    for fixture in fixtures() {
        let (sources, faults) = fixture.faults(&fixture.text);
        for fault in &faults {
            if let Some(fix) = fault.fixes.first() {
                let mut text = fixture.text.clone();
                assert_eq!(sources.path(fix.span), fixture.path(), "{}", fixture.name);
                text.replace_range(fix.span.start..fix.span.end, &fix.replacement);
                let (mended_sources, mended) = fixture.faults(&text);
                let is_there = |other: &Diagnostic| {
                    other.code == fault.code && other.primary.span.start == fault.primary.span.start
                };
                assert!(
                    !mended.iter().any(is_there),
                    "{}: {} does not help:\n{}",
                    fixture.name,
                    fix.replacement,
                    render(&mended, &mended_sources, Format::Text, Lang::En)
                );
            }
        }
    }
}

/// Syntax codes need no fixture: `syntax_explain` parses the examples of their explanations.
#[test]
fn every_code_has_a_fixture() {
    let expected: BTreeSet<String> = fixtures()
        .iter()
        .flat_map(Fixture::expected)
        .map(|found| found.fault.chars().take("FC0000".len()).collect())
        .collect();
    let missing: Vec<_> = FaultCode::ALL
        .iter()
        .map(|code| code.as_str())
        .filter(|code| !code.starts_with("FC00") && !expected.contains(*code))
        .collect();
    assert!(missing.is_empty(), "no fixture expects {missing:?}");
}

/// A fixture is named after a code that it expects, so that it is easy to find.
#[test]
fn fixtures_are_named_after_their_code() {
    for fixture in fixtures() {
        let code = fixture.name.get(.."FC0000".len()).unwrap_or_default();
        let expected = fixture.expected();
        assert!(
            expected.iter().any(|found| found.fault.starts_with(code)),
            "{} expects {expected:?}",
            fixture.name
        );
    }
}

/// Keys that declare an error but have no fixture for it. The same check covers another key, which has one.
const SAID_ALONE: [(&str, &str); 16] = [
    // A slip covers it.
    ("errors", "FC0218"),
    // The value of a wire key is a type, as under `type`.
    ("body", "FC0205"),
    // Covered at `max`.
    ("min", "FC0408"),
    // Covered in `sets_off`, with the name alone.
    ("report", "FC0211"),
    ("report", "FC0221"),
    // Operations of all kinds share one set of names.
    ("reports", "FC0202"),
    ("reports", "FC0209"),
    ("streams", "FC0201"),
    ("streams", "FC0202"),
    ("streams", "FC0209"),
    // Covered in `when`.
    ("unless", "FC0433"),
    ("unless", "FC0436"),
    // Covered by codes that are written without `value`.
    ("value", "FC0302"),
    ("value", "FC0303"),
    ("value", "FC0304"),
    // Covered at the other keys of a cadence.
    ("within_ms", "FC0448"),
];

/// Each error lies at a key that declares it in the language reference, and each declared error occurs.
#[test]
fn errors_lie_at_the_keys_that_declare_them() {
    let mut raised = declared_faults::Raised::new();
    let mut wrong = Vec::new();
    for fixture in fixtures() {
        let (sources, faults) = fixture.faults(&fixture.text);
        wrong.extend(declared_faults::undeclared(
            &fixture.name,
            &sources,
            &faults,
            &mut raised,
        ));
    }
    wrong.extend(declared_faults::unraised(&raised, &SAID_ALONE));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
