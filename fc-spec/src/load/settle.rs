//! Writes the owner's answer to a question into the files.

use super::answer_edit::AnswerEditor;
use super::answer_scope::{CoveredFact, Found, covered_facts};
use super::draft::{Draft, Sourced};
use crate::diagnostic::{Faults, nearest};
use crate::format::{Edited, edited};
use crate::model::{
    AnswerKind, BodyState, Confirmation, Fact, Languages, Location, Operation, Question, Subject,
    Text,
};
use crate::source::Sources;
use crate::syntax::quoted;
use crate::text;
use crate::vocabulary::Word as _;
use std::fmt;

/// The owner's answer to one question.
#[derive(Clone, Debug)]
pub struct Said {
    /// The id of a question, or of a conflict that has one.
    pub id: String,
    /// Pairs of a path and a value as YAML, such as `code` and `0x0350`, `unit` and `s`. The path is a path in `about:`
    /// or its end.
    pub values: Vec<(String, String)>,
    /// The owner's name and the date.
    pub confirmation: Confirmation,
}

/// A settled question and the changed file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settled {
    /// The question's id.
    pub id: String,
    /// Path of the file from the project's root.
    pub path: String,
    /// The file's new text.
    pub text: String,
    /// The changed lines, as a diff without line numbers.
    pub diff: String,
}

/// The reason why an owner's answer cannot be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SettleError {
    /// There is no such question.
    Unknown {
        /// The id that was passed.
        id: String,
        /// The most similar id, if any.
        nearest: Option<String>,
    },
    /// The conflict has several questions.
    Several {
        /// The conflict.
        id: String,
        /// The ids of its questions.
        questions: Vec<String>,
    },
    /// The question is already settled.
    Settled {
        /// The question.
        id: String,
        /// The owner who settled it.
        by: String,
        /// The date of the answer.
        date: String,
    },
    /// The question is not about this path.
    NotAbout {
        /// The question.
        id: String,
        /// The path that was passed.
        path: String,
        /// The paths of the question.
        about: Vec<String>,
    },
    /// The entry is in braces on one line, so that its lines cannot be edited.
    Layout {
        /// The question.
        id: String,
        /// Path of the file from the project's root.
        path: String,
        /// Line on which the entry begins, counted from 1.
        line: usize,
    },
    /// The question needs values that were not passed.
    Missing {
        /// The question.
        id: String,
        /// The paths that need a value.
        paths: Vec<String>,
    },
}

impl SettleError {
    /// Returns the message for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Unknown {
                id,
                nearest: Some(nearest),
            } => text!(
                "没有问题 {id}；是否想写 {nearest}？",
                "there is no question {id}; did you mean {nearest}?"
            ),
            Self::Unknown { id, nearest: None } => text!(
                "没有问题 {id}；`fcproto questions --state all --decisions` 列出全部问题",
                "there is no question {id}; `fcproto questions --state all --decisions` lists them"
            ),
            Self::Several { id, questions } => text!(
                "{id} 有几个问题，应指定其中一个：{questions}",
                "{id} has several questions: {questions}",
                questions = Text::listed(questions)
            ),
            Self::Settled { id, by, date } => text!(
                "{id} 已由 {by} 于 {date} 确认",
                "{id} is already settled: by {by} on {date}"
            ),
            Self::NotAbout { id, path, about } if about.is_empty() => text!(
                "{id} 没有 `about`，无法写入 `{path}`：用 `--confirm` 确认，再手工修改规范",
                "{id} has no `about`, so `{path}` cannot be written: confirm it with `--confirm` and edit the spec by hand"
            ),
            Self::NotAbout { id, path, about } => text!(
                "{id} 应写 {about}，实际为 `{path}`",
                "{id} is about {about}, not about `{path}`",
                about = Text::listed(about)
            ),
            Self::Layout { id, path, line } => text!(
                "{id} 涉及的内容在 {path}:{line} 写在大括号或方括号中：改成每个键一行，再试一次",
                "{id} is about a value in braces or brackets at {path}:{line}: write one key per line and try again"
            ),
            Self::Missing { id, paths } => text!(
                "{id} 缺少 {paths} 的值：用 `--set {first}=VALUE` 写明",
                "{id} needs a value for {paths}: pass `--set {first}=VALUE`",
                paths = Text::listed(paths),
                first = paths.first().map_or("", String::as_str)
            ),
        }
    }
}

impl fmt::Display for SettleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text().en)
    }
}

impl std::error::Error for SettleError {}

/// Writes the owner's answer to a question of a spec, and changes no other text. New texts are in the languages
/// `texts`.
///
/// Does not read the files again: call [`load`](super::load) to check the result.
///
/// # Errors
///
/// Returns [`SettleError`] if there is no such question, or if the values do not answer it.
pub fn settle(sources: &Sources, texts: Languages, said: &Said) -> Result<Settled, SettleError> {
    super::read(
        &super::Trees::new(sources),
        texts,
        &mut Faults::new(),
        |draft, _, _| settle_in(&draft, sources, said),
    )
}

fn settle_in(draft: &Draft<'_>, sources: &Sources, said: &Said) -> Result<Settled, SettleError> {
    let question = find(&draft.plain.questions, &said.id)?;
    if let Some(Confirmation { by, date, .. }) = &question.confirmed {
        return Err(SettleError::Settled {
            id: question.id.clone(),
            by: by.clone(),
            date: date.clone(),
        });
    }
    let about: Vec<&str> = question.about.iter().map(|it| it.path.as_str()).collect();
    for (path, _) in &said.values {
        if !about.iter().any(|covered| is_end_of(path, covered)) {
            return Err(SettleError::NotAbout {
                id: question.id.clone(),
                path: path.clone(),
                about: about.iter().map(|&path| path.to_owned()).collect(),
            });
        }
    }
    let mut editor = AnswerEditor::new(sources, draft.texts, Some(said));
    let mut missing = Vec::new();
    let mut ask_for = |path: &str| {
        if said.value(path).is_none() {
            missing.push(path.to_owned());
        }
    };
    let layout = |place: &Location| SettleError::Layout {
        id: question.id.clone(),
        path: place.file.clone(),
        line: place.line,
    };
    // An answer and an operation never have the same place.
    let mut answers = draft.answers.iter();
    if let Some(answer) = answers.find(|answer| answer.item.location == question.location) {
        let covered: Vec<_> = covered_facts(draft, answer).collect();
        for covered in covered.iter().filter(|covered| covered.has_to_be_said()) {
            ask_for(covered.path.as_str().unwrap_or_default());
        }
        let is_fact = |covered: &CoveredFact<'_>| matches!(covered.found, Found::Fact(..));
        if covered.iter().any(is_fact) && !editor.has_lines(answer.holder) {
            return Err(layout(&question.location));
        }
        editor.settle_answer(answer, &covered);
    } else if let Some((operation, fact, state)) = lost(draft, question) {
        if state == BodyState::Open {
            ask_for(fact.name());
        }
        if !editor.has_lines(operation.origin.node) {
            return Err(layout(&question.location));
        }
        editor.settle_loss(operation, fact, state, &question.text);
    }
    if !missing.is_empty() {
        return Err(SettleError::Missing {
            id: question.id.clone(),
            paths: missing,
        });
    }
    let file = editor.edits.place();
    let file = file.and_then(|span| sources.get(span.file));
    let (path, text, diff) = file.map_or_else(Default::default, |file| {
        let Edited { text, diff } = edited(file, &editor.edits);
        (file.path.clone(), text, diff)
    });
    Ok(Settled {
        id: question.id.clone(),
        path,
        text,
        diff,
    })
}

/// Returns the question with this id, or the one about this conflict.
fn find<'q>(questions: &'q [Question], id: &str) -> Result<&'q Question, SettleError> {
    if let Some(question) = questions.iter().find(|question| question.id == id) {
        return Ok(question);
    }
    let about = |question: &&Question| question.ids.iter().any(|other| other == id);
    let asked: Vec<_> = questions
        .iter()
        .filter(about)
        .filter(|question| question.kind == AnswerKind::Question)
        .collect();
    let all: Vec<_> = questions.iter().filter(about).collect();
    match (asked.as_slice(), all.as_slice()) {
        ([one], _) | ([], [one]) => Ok(one),
        ([], []) => Err(SettleError::Unknown {
            id: id.to_owned(),
            nearest: nearest(id, questions.iter().map(|question| question.id.as_str()))
                .map(str::to_owned),
        }),
        ([], several) | (several, _) => Err(SettleError::Several {
            id: id.to_owned(),
            questions: several.iter().map(|question| question.id.clone()).collect(),
        }),
    }
}

/// Returns the fact of a question that no answer of the spec asks.
fn lost<'d, 'a>(
    draft: &'d Draft<'a>,
    question: &Question,
) -> Option<(&'d Sourced<'a, Operation>, Fact, BodyState)> {
    let Subject::Operation(name) = &question.subject else {
        return None;
    };
    let fact = Fact::named(&question.about.first()?.path)?;
    let mut operations = draft.operations.iter();
    let operation = operations.find(|operation| operation.item.name == *name)?;
    Some((operation, fact, operation.item.fact_state(fact)?))
}

impl Said {
    /// Returns the new value of the fact at `path`, as YAML; `None` keeps the current value. If several values match,
    /// the one with the longest path wins.
    pub(super) fn value(&self, path: &str) -> Option<String> {
        let fitting = self.values.iter().filter(|(end, _)| is_end_of(end, path));
        let (_, value) = fitting.max_by_key(|(end, _)| end.len())?;
        Some(as_yaml(value))
    }
}

/// Returns a value as YAML, quoted if a reader could take it for something else. Mappings, and values in braces or
/// quotes, are already YAML.
fn as_yaml(value: &str) -> String {
    let is_yaml = value.contains(": ") || value.starts_with(['{', '[', '"', '\'']);
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_.-/".contains(c);
    if is_yaml || value.chars().all(is_plain) {
        value.to_owned()
    } else {
        quoted(value)
    }
}

/// Returns `true` if a path ends with these keys.
fn is_end_of(end: &str, path: &str) -> bool {
    let rest = path.strip_suffix(end);
    rest.is_some_and(|rest| rest.is_empty() || rest.ends_with('.'))
}
