//! The codes of operations.

use super::shared::{AnswerView, Desk, OperationEntry};
use crate::emit::markdown::links::{Anchor, Page};
use crate::emit::markdown::purpose;
use fc_spec::model::{CodeRange, Declared, Subject};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct CodesView {
    ranges: Vec<RangeView>,
    operations: String,
    unassigned: Vec<OperationEntry>,
    retired: Vec<RetiredView>,
    answers: Vec<AnswerView>,
    audiences: Vec<WordView>,
    hardware: Vec<WordView>,
    releases: Vec<WordView>,
}

#[derive(Debug, Serialize)]
struct RangeView {
    first: String,
    last: String,
    usage: String,
    text: String,
}

#[derive(Debug, Serialize)]
struct WordView {
    name: String,
    title: String,
}

#[derive(Debug, Serialize)]
struct RetiredView {
    code: String,
    decimal: u16,
    text: String,
}

pub(in crate::emit::markdown) fn codes(desk: Desk<'_, '_>) -> CodesView {
    let model = desk.book.model;
    // The page lists neither the codes in use nor the next free code. Every new operation would move a line for them,
    // and branches could not be merged. The overview lists the codes in use, and the site shows both here at run time.
    let operations = model.operations.iter();
    let unassigned = operations.filter(|operation| operation.code.value.is_none());
    let retired = model.retired.iter().map(|retired| RetiredView {
        code: retired.spelling.clone(),
        decimal: retired.code,
        text: desk.lang.text(&retired.text).to_owned(),
    });
    let words = |declared: &[Declared]| {
        let word = |word: &Declared| WordView {
            name: word.name.clone(),
            title: desk.lang.text(&word.title).to_owned(),
        };
        declared.iter().map(word).collect()
    };
    CodesView {
        ranges: model
            .ranges
            .iter()
            .map(|range| range_view(desk, range))
            .collect(),
        operations: desk.link(Page::Index, Anchor::named("operations")),
        unassigned: unassigned.map(|operation| desk.entry(operation)).collect(),
        retired: retired.collect(),
        answers: desk.answers_to(&Subject::Codes),
        audiences: words(&model.availability.audiences),
        hardware: words(&model.availability.hardware),
        releases: words(&model.availability.releases),
    }
}

fn range_view(desk: Desk<'_, '_>, range: &CodeRange) -> RangeView {
    RangeView {
        first: range.first_spelling.clone(),
        last: range.last_spelling.clone(),
        usage: purpose(range, desk.lang),
        text: desk.lang.text(&range.text).to_owned(),
    }
}
