//! The map of command codes.

use super::shared::{AnswerView, Desk, OperationEntry};
use crate::emit::markdown::words::Word as _;
use crate::model::{CodeRange, Subject};
use serde::Serialize;
use std::collections::BTreeSet;

/// All that its template shows.
#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct CodesView {
    ranges: Vec<RangeView>,
    used: Vec<OperationEntry>,
    unassigned: Vec<OperationEntry>,
    retired: Vec<RetiredView>,
    total_free: usize,
    answers: Vec<AnswerView>,
}

#[derive(Debug, Serialize)]
struct RangeView {
    first: String,
    last: String,
    usage: &'static str,
    text: String,
    size: usize,
    used: usize,
    free: usize,
    /// Code that the next operation gets, in ranges from which new ones are given out.
    next: Option<String>,
}

#[derive(Debug, Serialize)]
struct RetiredView {
    code: String,
    decimal: u16,
    text: String,
}

pub(in crate::emit::markdown) fn codes(desk: Desk<'_, '_>) -> CodesView {
    let model = desk.book.model;
    let taken = model.taken_codes();
    let mut used: Vec<_> = model
        .operations
        .iter()
        .filter(|operation| operation.code.value.is_some())
        .collect();
    used.sort_by_key(|operation| operation.code.value);
    let unassigned = model
        .operations
        .iter()
        .filter(|operation| operation.code.value.is_none());
    let retired = model.retired.iter().map(|retired| RetiredView {
        code: retired.spelling.clone(),
        decimal: retired.code,
        text: desk.lang.text(&retired.text).to_owned(),
    });
    CodesView {
        ranges: model
            .ranges
            .iter()
            .map(|range| range_view(desk, range, &taken))
            .collect(),
        used: used
            .into_iter()
            .map(|operation| desk.entry(operation))
            .collect(),
        unassigned: unassigned.map(|operation| desk.entry(operation)).collect(),
        retired: retired.collect(),
        total_free: 0x1_0000 - taken.len(),
        answers: desk.answers(desk.book.answers_to(&Subject::Codes)),
    }
}

fn range_view(desk: Desk<'_, '_>, range: &CodeRange, taken: &BTreeSet<u16>) -> RangeView {
    let used = taken.range(range.first..=range.last).count();
    let size = usize::from(range.last - range.first) + 1;
    RangeView {
        first: range.first_spelling.clone(),
        last: range.last_spelling.clone(),
        usage: range.usage.word(desk.lang),
        text: desk.lang.text(&range.text).to_owned(),
        size,
        used,
        free: size - used,
        next: range.next(taken).map(|code| format!("0x{code:04X}")),
    }
}
