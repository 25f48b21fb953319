//! All gaps of the source document, and the answers of the spec.

use super::shared::{AnswerView, Desk};
use crate::emit::markdown::links::{Anchor, Link};
use crate::emit::markdown::words::{self, Word as _};
use fc_spec::model::Lang;
use fc_spec::model::{
    Answer, AnswerKind, BodyState, Conflict, Impact, Question, Severity, Subject,
};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct OpenQuestionsView {
    counts: Vec<Count>,
    total: usize,
    /// The number of open questions.
    open: usize,
    held: Vec<Held>,
    settled: Vec<QuestionView>,
    sections: Vec<SectionView>,
    categories: Vec<Category>,
    /// Answers to subjects without an id.
    others: Vec<AnswerView>,
}

/// Conflicts of one severity, by the kinds of their answers.
#[derive(Debug, Serialize)]
struct Count {
    severity: &'static str,
    total: usize,
    decisions: usize,
    quirks: usize,
    notes: usize,
    questions: usize,
}

/// Open questions with the same impact.
#[derive(Debug, Serialize)]
struct Held {
    /// `no_code`, `no_body`, …
    key: &'static str,
    impact: &'static str,
    /// The behaviour of the tools until the questions are settled.
    meanwhile: &'static str,
    questions: Vec<QuestionView>,
}

#[derive(Debug, Serialize)]
struct QuestionView {
    anchor: String,
    id: String,
    /// The related conflicts, except that of its name.
    ids: Vec<Link>,
    about: Option<Link>,
    text: String,
    /// The lines to edit.
    edit: String,
    /// The command that writes the answer, with a placeholder for the answer.
    command: String,
    confirmed: Option<String>,
    spec: Link,
}

#[derive(Debug, Serialize)]
struct SectionView {
    anchor: String,
    number: u16,
    text: String,
    answers: Vec<AnswerView>,
}

#[derive(Debug, Serialize)]
struct Category {
    id: String,
    conflicts: Vec<ConflictView>,
}

#[derive(Debug, Serialize)]
struct ConflictView {
    id: String,
    severity: &'static str,
    /// `high`, `medium`, `low`.
    severity_key: &'static str,
    /// The kinds of its answers, with spaces between: `decision`, `quirk`, `note`, `question`.
    kinds: String,
    text: String,
    answers: Vec<AnswerView>,
}

pub(in crate::emit::markdown) fn open_questions(desk: Desk<'_, '_>) -> OpenQuestionsView {
    let model = desk.book.model;
    let mut categories: Vec<Category> = Vec::new();
    for conflict in &model.conflicts {
        let view = ConflictView {
            id: conflict.id.clone(),
            severity: conflict.severity.word(desk.lang),
            severity_key: conflict.severity.word(Lang::En),
            kinds: kinds(model.answers_to(conflict)),
            text: desk.sentence(&conflict.text),
            answers: model
                .answers_to(conflict)
                .map(|answer| desk.answer(answer).without(&conflict.id))
                .collect(),
        };
        match categories
            .iter_mut()
            .find(|category| category.id == conflict.category)
        {
            Some(category) => category.conflicts.push(view),
            None => categories.push(Category {
                id: conflict.category.clone(),
                conflicts: vec![view],
            }),
        }
    }
    let others = model.answers.iter();
    let others = others.filter(|answer| answer.ids.is_empty() && answer.about.is_empty());
    let asked = model.questions.iter();
    let asked = asked.filter(|question| question.kind == AnswerKind::Question);
    let open = asked.clone().filter(|question| question.is_open());
    let held = Impact::ALL.iter().filter_map(|impact| {
        let questions = open.clone().filter(|question| question.impact == *impact);
        let (key, en, zh) = impact.entry();
        let held = Held {
            key,
            impact: impact.word(desk.lang),
            meanwhile: desk.lang.pick(zh, en),
            questions: questions.map(|it| question(desk, it)).collect(),
        };
        (!held.questions.is_empty()).then_some(held)
    });
    OpenQuestionsView {
        counts: [Severity::High, Severity::Medium, Severity::Low]
            .map(|severity| count(desk, severity))
            .into(),
        total: model.conflicts.len(),
        open: open.clone().count(),
        held: held.collect(),
        settled: asked
            .filter(|question| !question.is_open())
            .map(|it| question(desk, it))
            .collect(),
        sections: sections(desk),
        categories,
        others: desk.answers(others),
    }
}

fn kinds<'a>(answers: impl Iterator<Item = &'a Answer>) -> String {
    let mut kinds: Vec<String> = answers
        .map(|answer| answer.kind.word(Lang::En).to_lowercase())
        .collect();
    kinds.sort();
    kinds.dedup();
    kinds.join(" ")
}

fn count(desk: Desk<'_, '_>, severity: Severity) -> Count {
    let model = desk.book.model;
    let conflicts = model.conflicts.iter();
    let conflicts = conflicts.filter(|conflict| conflict.severity == severity);
    let answered = |kind| {
        let has = |conflict: &&Conflict| {
            let mut answers = model.answers_to(conflict);
            answers.any(|answer| answer.kind == kind)
        };
        conflicts.clone().filter(has).count()
    };
    Count {
        severity: severity.word(desk.lang),
        total: conflicts.clone().count(),
        decisions: answered(AnswerKind::Decision),
        quirks: answered(AnswerKind::Quirk),
        notes: answered(AnswerKind::Note),
        questions: answered(AnswerKind::Question),
    }
}

fn question<'m>(desk: Desk<'_, 'm>, question: &'m Question) -> QuestionView {
    let rows = desk.rows();
    QuestionView {
        anchor: Anchor::of("question", &question.id).id(),
        id: question.id.clone(),
        ids: question
            .ids
            .iter()
            .filter(|id| **id != question.id)
            .map(|id| rows.conflict(id))
            .collect(),
        about: desk.about(&question.subject),
        text: desk.sentence(&question.text),
        edit: question.edit.clone(),
        command: command(question),
        confirmed: question
            .confirmed
            .as_ref()
            .map(|it| words::confirmed(it, desk.lang)),
        spec: desk.spec(&question.location),
    }
}

/// Returns the command that writes the answer. Only the owner knows the parts that are left out.
fn command(question: &Question) -> String {
    let asked = question.about.iter();
    let asked = asked.filter(|fact| fact.meanwhile != BodyState::Inferred.name());
    let mut said: Vec<_> = asked.map(|fact| format!("--set {}=…", fact.path)).collect();
    if said.is_empty() {
        said.push("--confirm".to_owned());
    }
    format!("fcproto settle {} {} --by …", question.id, said.join(" "))
}

fn sections(desk: Desk<'_, '_>) -> Vec<SectionView> {
    let sections = desk.book.model.missing_sections.iter();
    let view = |section: &fc_spec::model::MissingSection| SectionView {
        anchor: Anchor::of("section", &section.section.to_string()).id(),
        number: section.section,
        text: desk.sentence(&section.text),
        answers: desk.answers_to(&Subject::Section(section.section)),
    };
    sections.map(view).collect()
}
