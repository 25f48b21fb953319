//! The gaps of the source and what the spec answers to them.

use super::build::{described, list, place, string, text};
use fc_spec::model::{Answer, AnswerKind, Conflict, Model, Severity, Subject, Value};
use std::collections::HashMap;

/// `open_questions`.
pub(super) fn open_questions(model: &Model) -> Value {
    let mut answers: HashMap<&str, Vec<&Answer>> = HashMap::new();
    for answer in &model.answers {
        for id in &answer.ids {
            answers.entry(id).or_default().push(answer);
        }
    }
    model
        .conflicts
        .iter()
        .filter_map(|conflict| question(conflict, answers.get(conflict.id.as_str())?))
        .collect()
}

/// A checked model has an answer to every conflict.
fn question(conflict: &Conflict, answers: &[&Answer]) -> Option<Value> {
    let first = answers.first()?;
    let severity = match conflict.severity {
        Severity::High => "high",
        Severity::Medium => "medium",
        Severity::Low => "low",
    };
    let all = if answers.len() > 1 { answers } else { &[] };
    Some(described(
        [
            ("id", string(&conflict.id)),
            ("severity", string(severity)),
            ("category", string(&conflict.category)),
            ("kind", string(kind_name(first.kind))),
            ("subject", Value::String(subject(&first.subject))),
        ],
        &first.text,
        [
            ("gap", text(&conflict.text)),
            ("place", place(&first.location)),
            ("answers", list(all, |answer| self::answer(answer))),
        ],
    ))
}

fn answer(answer: &Answer) -> Value {
    described(
        [
            ("kind", string(kind_name(answer.kind))),
            ("subject", Value::String(subject(&answer.subject))),
        ],
        &answer.text,
        [("place", place(&answer.location))],
    )
}

fn kind_name(kind: AnswerKind) -> &'static str {
    match kind {
        AnswerKind::Decision => "decision",
        AnswerKind::Quirk => "quirk",
        AnswerKind::Note => "note",
        AnswerKind::Question => "question",
    }
}

fn subject(subject: &Subject) -> String {
    let within = |whole: &str, part: Option<String>| match part {
        Some(part) => format!("{whole}.{part}"),
        None => whole.to_owned(),
    };
    match subject {
        Subject::Protocol => "protocol".to_owned(),
        Subject::Transport => "transport".to_owned(),
        Subject::Frame(field) => within("frame", field.clone()),
        Subject::Envelope(key) => within("envelope", key.clone()),
        Subject::Results(code) => within("results", code.map(|code| code.to_string())),
        Subject::Codes => "codes".to_owned(),
        Subject::Operation(name) => format!("operation.{name}"),
        Subject::Field { owner, key } => format!("field.{owner}.{key}"),
        Subject::Type(name) => format!("type.{name}"),
        Subject::Table(id) => format!("table.{id}"),
        Subject::Section(number) => format!("section.{number}"),
    }
}
