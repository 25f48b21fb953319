//! All gaps of the source document, and the answers of the spec.

use super::shared::{Desk, list};
use crate::emit::markdown::links::Anchor;
use crate::emit::markdown::words::{self, Word as _};
use fc_spec::model::Lang;
use fc_spec::model::{
    Answer, AnswerKind, BodyState, Conflict, Impact, Question, Severity, Subject,
};
use minijinja::{Value, context};

pub(in crate::emit::markdown) fn open_questions(desk: Desk<'_, '_>) -> Value {
    let model = desk.book.model;
    let mut categories: Vec<(&str, Vec<Value>)> = Vec::new();
    for conflict in &model.conflicts {
        let answers = model.answers_to(conflict);
        let answers = answers.map(|answer| desk.answer(answer, Some(&conflict.id)));
        let view = context! {
            id => &conflict.id,
            severity => conflict.severity.word(desk.lang),
            severity_key => conflict.severity.word(Lang::En),
            kinds => kinds(model.answers_to(conflict)),
            text => desk.sentence(&conflict.text),
            answers => list(answers),
        };
        let mut known = categories.iter_mut();
        match known.find(|(id, _)| *id == conflict.category) {
            Some((_, conflicts)) => conflicts.push(view),
            None => categories.push((&conflict.category, vec![view])),
        }
    }
    let categories = categories.into_iter();
    let categories = categories.map(|(id, conflicts)| context! { id, conflicts });
    let others = model.answers.iter();
    let others = others.filter(|answer| answer.ids.is_empty() && answer.about.is_empty());
    let asked = model.questions.iter();
    let asked = asked.filter(|question| question.kind == AnswerKind::Question);
    let open = asked.clone().filter(|question| question.is_open());
    let held = Impact::ALL.iter().filter_map(|impact| {
        let questions = open.clone().filter(|question| question.impact == *impact);
        let (key, en, zh) = impact.entry();
        let questions: Vec<Value> = questions.map(|it| question(desk, it)).collect();
        let held = !questions.is_empty();
        held.then(|| {
            context! {
                key,
                impact => impact.word(desk.lang),
                meanwhile => desk.lang.pick(zh, en),
                questions,
            }
        })
    });
    let settled = asked.filter(|question| !question.is_open());
    let settled = settled.map(|it| question(desk, it));
    let counts = [Severity::High, Severity::Medium, Severity::Low];
    let counts = counts.map(|severity| count(desk, severity));
    context! {
        counts => list(counts),
        total => model.conflicts.len(),
        open => open.clone().count(),
        held => list(held),
        settled => list(settled),
        sections => sections(desk),
        categories => list(categories),
        others => desk.answers(others),
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

fn count(desk: Desk<'_, '_>, severity: Severity) -> Value {
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
    context! {
        severity => severity.word(desk.lang),
        total => conflicts.clone().count(),
        decisions => answered(AnswerKind::Decision),
        quirks => answered(AnswerKind::Quirk),
        notes => answered(AnswerKind::Note),
        questions => answered(AnswerKind::Question),
    }
}

fn question<'m>(desk: Desk<'_, 'm>, question: &'m Question) -> Value {
    let ids = question.ids.iter().filter(|id| **id != question.id);
    let ids = ids.map(|id| desk.conflict(id));
    context! {
        anchor => Anchor::of("question", &question.id).id(),
        id => &question.id,
        ids => list(ids),
        about => desk.about(&question.subject),
        text => desk.sentence(&question.text),
        edit => &question.edit,
        command => command(question),
        confirmed => question
            .confirmed
            .as_ref()
            .map(|it| words::confirmed(it, desk.lang)),
        spec => desk.spec(&question.location),
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

fn sections(desk: Desk<'_, '_>) -> Vec<Value> {
    let sections = desk.book.model.missing_sections.iter();
    let view = |section: &fc_spec::model::MissingSection| {
        context! {
            anchor => Anchor::of("section", &section.section.to_string()).id(),
            number => section.section,
            text => desk.sentence(&section.text),
            answers => desk.answers_to(&Subject::Section(section.section)),
        }
    };
    sections.map(view).collect()
}
