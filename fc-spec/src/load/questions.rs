//! Collects the questions for the owner, from the answers of the spec and from lost facts without an answer.

use super::answer_edit::AnswerEditor;
use super::answer_scope::{CoveredFact, Found, covered_facts, is_doubt};
use super::draft::{AnswerDraft, Draft, Sourced};
use crate::language::grammar::FILE;
use crate::model::{
    self, AnswerKind, BodyState, Direction, Fact, Impact, Operation, Question, Severity, Subject,
    Text,
};
use crate::source::Sources;
use crate::vocabulary::Word as _;
use std::collections::{HashMap, HashSet};

/// Returns all questions, the most urgent first.
pub(super) fn questions(draft: &Draft<'_>, sources: &Sources) -> Vec<Question> {
    let editor = || AnswerEditor::new(sources, draft.texts, None);
    let mut asked: HashSet<(&str, Fact)> = HashSet::new();
    let mut questions = Vec::new();
    let severities: HashMap<&str, Severity> = draft
        .conflicts
        .iter()
        .map(|conflict| (conflict.item.id.as_str(), conflict.item.severity))
        .collect();
    for answer in &draft.answers {
        let covered: Vec<_> = covered_facts(draft, answer).collect();
        if let Subject::Operation(name) = &answer.item.subject {
            asked.extend(covered.iter().filter_map(|covered| match covered.found {
                Found::Fact(fact, ..) => Some((name.as_str(), fact)),
                _ => None,
            }));
        }
        if matches!(
            answer.item.kind,
            AnswerKind::Question | AnswerKind::Decision
        ) {
            let mut question = of_answer(answer, &covered, &severities, editor());
            if question.ids.is_empty() {
                question.id = format!("{}.{}", place(draft, &question.subject), question.id);
            }
            questions.push(question);
        }
    }
    name(draft, &mut questions);
    for operation in &draft.operations {
        for &fact in Fact::ALL {
            if let Some(state) = operation.item.fact_state(fact)
                && is_doubt(state)
                && !asked.contains(&(operation.item.name.as_str(), fact))
            {
                let text = draft.texts.limit(ask(&operation.item, fact, state));
                questions.push(of_loss(operation, fact, state, text, editor()));
            }
        }
    }
    for question in &mut questions {
        let file = &question.location.file;
        let mut groups = draft.groups.iter();
        let group = groups.find(|group| group.item.location.file == *file);
        question.group = group.map(|group| group.item.id.clone());
    }
    // Settled questions come last.
    questions.sort_by_key(|it| (!it.is_open(), it.impact, it.severity.is_none(), it.severity));
    questions
}

fn of_answer(
    answer: &AnswerDraft<'_>,
    covered: &[CoveredFact<'_>],
    severities: &HashMap<&str, Severity>,
    mut edit: AnswerEditor<'_>,
) -> Question {
    let item = &answer.item;
    let facts = covered.iter().map(|covered| match covered.found {
        Found::Fact(fact, ..) => match BodyState::named(covered.meanwhile()) {
            Some(before) => impact(fact, before),
            None => Impact::Doubtful,
        },
        _ => Impact::Doubtful,
    });
    let impact = match item.kind {
        AnswerKind::Decision => Impact::Decided,
        _ => facts.min().unwrap_or(Impact::Behaviour),
    };
    if item.confirmed.is_none() {
        edit.settle_answer(answer, covered);
    }
    let severities = item.ids.iter().filter_map(|id| severities.get(id.as_str()));
    Question {
        id: match (item.ids.first(), item.about.first()) {
            (Some(id), _) => id.clone(),
            (None, Some(covered)) => covered.path.clone(),
            (None, None) => String::new(),
        },
        ids: item.ids.clone(),
        kind: item.kind,
        impact,
        severity: severities.min().copied(),
        group: None,
        subject: item.subject.clone(),
        text: item.text.clone(),
        about: item.about.clone(),
        confirmed: item.confirmed.clone(),
        edit: edit.diff(),
        location: item.location.clone(),
    }
}

/// Returns the question about a doubtful fact that no answer covers.
fn of_loss(
    operation: &Sourced<'_, Operation>,
    fact: Fact,
    state: BodyState,
    text: Text,
    mut edit: AnswerEditor<'_>,
) -> Question {
    let item = &operation.item;
    edit.settle_loss(operation, fact, state, &text);
    Question {
        id: format!("{}.{}", item.name, fact.name()),
        ids: Vec::new(),
        kind: AnswerKind::Question,
        impact: impact(fact, state),
        severity: None,
        group: None,
        subject: Subject::Operation(item.name.clone()),
        text,
        about: vec![model::Governed {
            path: fact.name().to_owned(),
            meanwhile: state.name().to_owned(),
        }],
        confirmed: None,
        edit: edit.diff(),
        location: item.location.clone(),
    }
}

/// Returns the impact of a doubtful fact.
fn impact(fact: Fact, state: BodyState) -> Impact {
    match (fact, state) {
        (Fact::Code, BodyState::Open) => Impact::NoCode,
        (Fact::Request | Fact::Response, BodyState::Open) => Impact::NoBody,
        (Fact::Effect, BodyState::Open) => Impact::NoEffect,
        _ => Impact::Inferred,
    }
}

/// Returns the question in both languages. Prefers the note of a lost body.
fn ask(operation: &Operation, fact: Fact, state: BodyState) -> Text {
    let direction = match fact {
        Fact::Request => Some(Direction::Request),
        Fact::Response => Some(Direction::Response),
        _ => None,
    };
    let body = direction.and_then(|direction| operation.body(direction));
    if let Some(note) = body.and_then(|body| body.note.clone()) {
        return note;
    }
    let spelling = &operation.code.spelling;
    let Text { zh, en } = &operation.title;
    let effect = operation.effect().map_or("", |effect| effect.name());
    let (zh, en) = match (fact, state) {
        (Fact::Code, BodyState::Open) => (
            "源文档中没有功能码，是多少？".to_owned(),
            "The source gives no code. Which is it?".to_owned(),
        ),
        (Fact::Code, _) => (
            format!("功能码 `{spelling}` 是推断的，对吗？"),
            format!("The code `{spelling}` is inferred. Is it right?"),
        ),
        (Fact::Title, _) => (
            format!("标题已丢失，“{zh}”是本规范拟的，对吗？"),
            format!("The heading is lost and this spec calls it \"{en}\". Is that right?"),
        ),
        (Fact::Type, _) => (
            "数据类型已丢失，由同类的其他接口推断，对吗？".to_owned(),
            "The type is lost and inferred from the other operations of its kind. Is it right?"
                .to_owned(),
        ),
        (Fact::Effect, BodyState::Open) => (
            "源文档没有说明它对机器人有什么作用，是哪一种？".to_owned(),
            "The source does not say what it does to the robot. Which effect is it?".to_owned(),
        ),
        (Fact::Effect, _) => (
            format!("作用 `{effect}` 是推断的，对吗？"),
            format!("The effect `{effect}` is inferred. Is it right?"),
        ),
        (Fact::Request, BodyState::Open) => (
            "请求正文已丢失，有哪些字段？".to_owned(),
            "The request is lost. Which keys does it have?".to_owned(),
        ),
        (Fact::Response, BodyState::Open) => (
            "响应正文已丢失，有哪些字段？".to_owned(),
            "The response is lost. Which keys does it have?".to_owned(),
        ),
        (Fact::Request, _) => (
            "请求正文是推断的，对吗？".to_owned(),
            "The request is inferred. Is it right?".to_owned(),
        ),
        (Fact::Response, _) => (
            "响应正文是推断的，对吗？".to_owned(),
            "The response is inferred. Is it right?".to_owned(),
        ),
    };
    Text { zh, en }
}

/// Adds the place to the id if several questions are about one conflict. The only question of a conflict has the
/// conflict's id. If there is no question, the only decision has it.
fn name(draft: &Draft<'_>, questions: &mut [Question]) {
    let mut all: HashMap<String, usize> = HashMap::new();
    let mut asking: HashMap<String, usize> = HashMap::new();
    for question in &*questions {
        *all.entry(question.id.clone()).or_default() += 1;
        if question.kind == AnswerKind::Question {
            *asking.entry(question.id.clone()).or_default() += 1;
        }
    }
    let mut taken = HashSet::new();
    for question in questions {
        let is_alone = match asking.get(&question.id) {
            Some(count) => *count == 1 && question.kind == AnswerKind::Question,
            None => all.get(&question.id) == Some(&1),
        };
        if !is_alone {
            question.id = format!("{}.{}", question.id, place(draft, &question.subject));
        }
        let id = question.id.clone();
        let mut count = 1;
        while !taken.insert(question.id.clone()) {
            count += 1;
            question.id = format!("{id}.{count}");
        }
    }
}

/// Returns the place as one word. A part of a body yields its operation.
fn place(draft: &Draft<'_>, subject: &Subject) -> String {
    match subject {
        Subject::Protocol => FILE.protocol.name.to_owned(),
        Subject::Transport => FILE.transport.name.to_owned(),
        Subject::Frame(None) => FILE.frame.name.to_owned(),
        Subject::Envelope(None) => FILE.envelope.name.to_owned(),
        Subject::Results(None) => FILE.results.name.to_owned(),
        Subject::Codes => FILE.codes.name.to_owned(),
        Subject::Frame(Some(name))
        | Subject::Envelope(Some(name))
        | Subject::Operation(name)
        | Subject::Type(name)
        | Subject::Table(name) => name.clone(),
        Subject::Results(Some(code)) => code.to_string(),
        Subject::Field { owner, key } => {
            let body = draft
                .type_named(owner)
                .and_then(|ty| ty.def.body_of.as_ref());
            let owner = body.map_or(owner, |body| &body.operation);
            format!("{owner}.{key}")
        }
        Subject::Section(number) => number.to_string(),
    }
}
