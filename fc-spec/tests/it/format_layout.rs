//! Tests the layout of files with the examples in `format/layout.txt` and with all fixtures.

use fc_spec::diagnostic::Faults;
use fc_spec::format::{Refused, format};
use fc_spec::load::load;
use fc_spec::source::{FileId, SourceFile, Sources};
use fc_spec::syntax::parse;
use std::path::Path;

fn laid_out(text: &str) -> Result<String, Refused> {
    format(FileId(0), &SourceFile::new("spec/a.yaml", text))
}

/// Returns the text between a heading and the next one.
fn part<'t>(case: &'t str, heading: &str) -> &'t str {
    let (_, behind) = case.split_once(heading).expect(heading);
    let end = behind.find("\n=====").map_or(behind.len(), |end| end + 1);
    behind.get(..end).expect("a part")
}

#[test]
fn examples_are_laid_out_as_they_say() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/format/layout.txt");
    let cases = std::fs::read_to_string(path).expect("the examples");
    let mut count = 0;
    for case in cases.split("\n##### ").skip(1) {
        let title = case.lines().next().unwrap_or_default();
        let before = part(case, "===== before\n");
        let after = part(case, "===== after\n");
        let new = laid_out(before).unwrap_or_else(|refused| panic!("{title}: {refused:?}"));
        assert_eq!(new, after, "{title}");
        assert_eq!(
            laid_out(&new).expect(title),
            new,
            "{title}: not the same again"
        );
        count += 1;
    }
    assert!(count > 10, "the examples were not found");
}

#[test]
fn a_text_with_faults_is_refused_with_them() {
    for (text, codes) in [
        ("types: { A: [ }\n", "FC0008"),
        ("", "FC0005"),
        ("- a\n", "FC0103"),
        ("types:\n  A: { zh: a, en: b, colour: c }\n", "FC0101"),
        ("types: {}\ntypes: {}\n", "FC0012"),
        ("colours: {}\n", "FC0101"),
        ("types:\n  A: &a { zh: a, en: b }\n", "FC0014"),
    ] {
        match laid_out(text) {
            Err(Refused::Faults(faults)) => {
                let found: Vec<_> = faults.iter().map(|fault| fault.code.as_str()).collect();
                assert!(found.contains(&codes), "{text:?}: {found:?}");
            }
            other => panic!("{text:?}: {other:?}"),
        }
    }
}

/// The layout of any fixture keeps its comments, and a second pass changes nothing.
#[test]
fn every_fixture_is_laid_out_or_refused() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let mut laid = 0;
    for directory in ["adversarial", "bad", "good", "good/commands"] {
        for entry in std::fs::read_dir(tests.join(directory)).expect("a directory") {
            let path = entry.expect("an entry").path();
            let Some(text) = std::fs::read_to_string(&path)
                .ok()
                .filter(|_| path.extension().is_some_and(|found| found == "yaml"))
            else {
                continue;
            };
            let text = text.trim_start_matches('\u{feff}');
            let path = path.display();
            match laid_out(text) {
                Ok(new) => {
                    assert_eq!(comments(&new), comments(text), "{path}");
                    assert_eq!(laid_out(&new).expect("again"), new, "{path}");
                    laid += 1;
                }
                Err(Refused::Faults(faults)) => assert!(faults.has_errors(), "{path}"),
                Err(Refused::NotTheSame) => panic!("{path}"),
            }
        }
    }
    assert!(laid > 100, "only {laid}");
}

fn comments(text: &str) -> Vec<String> {
    let text = text.replace("\r\n", "\n");
    let tree = parse(FileId(0), &text, &mut Faults::new()).expect("a tree");
    let spans = tree.comments();
    let texts = spans.filter_map(|span| text.get(span.start..span.end));
    let mut texts: Vec<String> = texts.map(str::to_owned).collect();
    texts.sort();
    texts
}

/// A comment after an unquoted string is error FC0126. Writing brackets as a block must not cause it.
#[test]
fn no_fault_comes_of_opened_brackets() {
    let text = "entities: { lamp: { zh: 灯, # one\n en: Lamp # two\n } }\n";
    let new = laid_out(text).expect("a layout");
    let codes = |text: &str| {
        let mut faults = Faults::new();
        let _ = load(&Sources::from_texts([("spec/a.yaml", text)]), &mut faults);
        let codes = faults.iter().map(|fault| fault.code.as_str());
        codes.filter(|code| *code == "FC0126").count()
    };
    assert_eq!(codes(&new), 0, "{new}");
}
