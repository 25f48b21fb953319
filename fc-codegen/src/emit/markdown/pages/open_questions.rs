//! Every gap of the source document and what the spec answers.

use super::shared::{AnswerView, Desk};
use crate::emit::markdown::lang::Lang;
use crate::emit::markdown::links::{Anchor, Link};
use crate::emit::markdown::words::Word as _;
use fc_spec::model::{
    Answer, AnswerKind, BodyState, Conflict, Direction, Operation, Severity, Subject,
};
use serde::Serialize;

/// All that its template shows.
#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct OpenQuestionsView {
    counts: Vec<Count>,
    total: usize,
    questions: Vec<AnswerView>,
    operations: Vec<UncertainOperation>,
    sections: Vec<SectionView>,
    categories: Vec<Category>,
    /// Answers to nothing that has an id.
    others: Vec<AnswerView>,
}

/// Conflicts of one severity, by how they are answered.
#[derive(Debug, Serialize)]
struct Count {
    severity: &'static str,
    total: usize,
    decisions: usize,
    quirks: usize,
    notes: usize,
    questions: usize,
}

/// An operation of which something is inferred or open.
#[derive(Debug, Serialize)]
struct UncertainOperation {
    link: Link,
    kind: &'static str,
    /// `None` for what is no command.
    effect: Option<&'static str>,
    code: &'static str,
    code_spelling: String,
    request: &'static str,
    response: &'static str,
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
    /// How it is answered: `decision`, `quirk`, `note`, `question`, with spaces between.
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
    let of_kind = |answer: &&Answer| answer.kind == AnswerKind::Question;
    let all = model.answers.iter();
    OpenQuestionsView {
        counts: [Severity::High, Severity::Medium, Severity::Low]
            .map(|severity| count(desk, severity))
            .into(),
        total: model.conflicts.len(),
        questions: desk.answers(all.clone().filter(of_kind)),
        operations: model
            .operations
            .iter()
            .filter_map(|operation| uncertain(desk, operation))
            .collect(),
        sections: sections(desk),
        categories,
        others: desk.answers(all.filter(|answer| answer.ids.is_empty())),
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

fn uncertain(desk: Desk<'_, '_>, operation: &Operation) -> Option<UncertainOperation> {
    (operation.state() != BodyState::Stated).then(|| UncertainOperation {
        link: desk.operation(operation),
        kind: operation.kind_state.word(desk.lang),
        effect: operation.effect_state().map(|state| state.word(desk.lang)),
        code: operation.code.state.word(desk.lang),
        code_spelling: operation.code.spelling.clone(),
        request: operation.body_state(Direction::Request).word(desk.lang),
        response: operation.body_state(Direction::Response).word(desk.lang),
    })
}

fn sections(desk: Desk<'_, '_>) -> Vec<SectionView> {
    let sections = desk.book.model.retained_sections.iter();
    let view = |section: &fc_spec::model::RetainedSection| SectionView {
        anchor: Anchor::of("section", &section.section.to_string()).id(),
        number: section.section,
        text: desk.sentence(&section.text),
        answers: desk.answers_to(&Subject::Section(section.section)),
    };
    sections.map(view).collect()
}
