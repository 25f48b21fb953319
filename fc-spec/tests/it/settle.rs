//! Tests how an owner's answer changes a spec. `settle/asked.yaml` has the questions. `settle/answers.txt` has the
//! answers and the lines that each may change.
//!
//! A case has a title (`# …`), the question (`? …`) and the values of its facts (`= path value`, with `\n` as line
//! break). The lines with `>` are the change, or the reason for none. `BLESS=1` writes them.

use crate::good_spec;
use crate::syntax_support;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::{Said, SettleError, Settled, load, settle};
use fc_spec::model::{Confirmation, Lang, Languages, Model};
use fc_spec::source::Sources;
use std::path::Path;

const ASKED: &str = "spec/commands/asked.yaml";

fn sources(asked: &str) -> Sources {
    let good = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    Sources::from_texts(
        good.into_iter()
            .chain([(ASKED.to_owned(), asked.to_owned())]),
    )
}

fn model(sources: &Sources) -> Model {
    let mut faults = Faults::new();
    let model = load(sources, &mut faults).model();
    assert!(
        faults.is_empty(),
        "{}",
        render(&faults, sources, Format::Text, Lang::En)
    );
    model.expect("a spec without faults has a model")
}

fn say(id: &str, values: Vec<(String, String)>) -> Said {
    Said {
        id: id.to_owned(),
        values,
        confirmation: Confirmation {
            by: "张伟".to_owned(),
            date: "2026-11-23".to_owned(),
            reference: None,
            reply: None,
        },
    }
}

/// An owner's answer to a question, and the lines of `answers.txt` that describe it.
struct Case {
    head: String,
    said: Said,
}

fn cases(text: &str) -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    let mut title = String::new();
    for line in text.lines() {
        if line.starts_with('#') {
            title = format!("{line}\n");
        } else if let Some(id) = line.strip_prefix("? ") {
            cases.push(Case {
                head: format!("{title}{line}\n"),
                said: say(id, Vec::new()),
            });
        } else if let Some(fact) = line.strip_prefix("= ") {
            let (path, value) = fact.split_once(' ').expect("a path and a value");
            let case = cases.last_mut().expect("a question before it");
            case.head += &format!("{line}\n");
            let value = value.replace("\\n", "\n");
            case.said.values.push((path.to_owned(), value));
        }
    }
    cases
}

/// Returns the file with a diff applied. Lines outside of the diff stay the same.
fn patched(before: &str, diff: &str) -> String {
    let mut lines = before.lines();
    let mut after = Vec::new();
    for change in diff.lines() {
        let (sign, line) = change.split_at(1);
        match sign {
            "+" => after.push(line),
            "@" => {}
            _ => {
                let skipped = lines.by_ref().take_while(|other| *other != line);
                after.extend(skipped);
                if sign == " " {
                    after.push(line);
                }
            }
        }
    }
    after.extend(lines);
    after.join("\n") + "\n"
}

#[test]
fn answer_changes_only_its_lines() {
    let asked = good_spec::read("settle/asked.yaml");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/settle/answers.txt");
    let before = sources(&asked);
    let mut text = String::new();
    for Case { head, said } in cases(&good_spec::read("settle/answers.txt")) {
        let found = match settle(&before, Languages::All, &said) {
            Err(error) => error.to_string(),
            Ok(Settled {
                id,
                path,
                text,
                diff,
            }) => {
                assert_eq!(path, ASKED);
                assert_eq!(text, patched(&asked, &diff), "{id}");
                let model = model(&sources(&text));
                let mut questions = model.questions.iter();
                let question = questions.find(|question| question.id == id);
                let question = question.unwrap_or_else(|| panic!("{id} is no question any more"));
                assert_eq!(question.confirmed.as_ref(), Some(&said.confirmation));
                diff
            }
        };
        let found: String = found.lines().map(|line| format!(">{line}\n")).collect();
        text += &format!("{head}{found}\n");
    }
    syntax_support::golden(&path, &text);
}

#[test]
fn the_lines_to_edit_are_those_that_an_answer_changes() {
    let asked = good_spec::read("settle/asked.yaml");
    let before = sources(&asked);
    let model = model(&before);
    let mut open = 0;
    for question in model.questions.iter().filter(|question| question.is_open()) {
        // A value that occurs nowhere else, and a body on one line.
        let value = |path: &str| match path {
            "request" | "response" => "{zq1}",
            _ => "zq1",
        };
        let about = question.about.iter();
        let about = about.filter(|fact| fact.meanwhile != "inferred");
        let values = about.map(|fact| (fact.path.clone(), value(&fact.path).to_owned()));
        let said = say(&question.id, values.collect());
        let settled = match settle(&before, Languages::All, &said) {
            // An answer that cannot be written has no lines to show.
            Err(SettleError::Layout { .. }) if question.edit.is_empty() => continue,
            settled => settled.unwrap_or_else(|error| panic!("{error}")),
        };
        let mut said = settled.diff;
        for spoken in ["{zq1}", "zq1", "张伟", "2026-11-23"] {
            said = said.replace(spoken, "…");
        }
        assert_eq!(said, question.edit, "{}", question.id);
        open += 1;
    }
    assert!(open > 10, "{open} questions");
}

#[test]
fn settled_question_stays_settled() {
    let before = sources(&good_spec::read("settle/asked.yaml"));
    let said = say("C013", vec![("code".to_owned(), "0x0109".to_owned())]);
    let settled = settle(&before, Languages::All, &said).expect("it can be settled");
    let again = settle(&sources(&settled.text), Languages::All, &said);
    assert!(
        matches!(again, Err(SettleError::Settled { .. })),
        "{again:?}"
    );
}

#[test]
fn answer_keeps_windows_line_ends() {
    let asked = good_spec::read("settle/asked.yaml").replace('\n', "\r\n");
    let said = say("C013", vec![("code".to_owned(), "0x0109".to_owned())]);
    let settled = settle(&sources(&asked), Languages::All, &said).expect("it can be settled");
    assert_eq!(
        settled.text.matches('\n').count(),
        settled.text.matches("\r\n").count()
    );
    assert!(
        model(&sources(&settled.text))
            .operation("open_door")
            .is_some()
    );
}
