//! The codes of operations.

use super::shared::{Desk, list};
use crate::emit::markdown::links::{Anchor, Page};
use crate::emit::markdown::purpose;
use fc_spec::model::{CodeRange, Declared, Subject};
use minijinja::{Value, context};

pub(in crate::emit::markdown) fn codes(desk: Desk<'_, '_>) -> Value {
    let model = desk.book.model;
    // The page lists neither the codes in use nor the next free code. Every new operation would move a line for them,
    // and branches could not be merged. The overview lists the codes in use, and the site shows both here at run time.
    let operations = model.operations.iter();
    let unassigned = operations.filter(|operation| operation.code.value.is_none());
    let retired = model.retired.iter().map(|retired| {
        context! {
            code => &retired.spelling,
            decimal => retired.code,
            text => desk.lang.text(&retired.text),
        }
    });
    let words = |declared: &[Declared]| {
        let word = |word: &Declared| {
            context! {
                name => &word.name,
                title => desk.lang.text(&word.title),
            }
        };
        list(declared.iter().map(word))
    };
    context! {
        ranges => list(model.ranges.iter().map(|range| range_view(desk, range))),
        operations => desk.link(Page::Index, Anchor::named("operations")),
        unassigned => list(unassigned.map(|operation| desk.entry(operation))),
        retired => list(retired),
        answers => desk.answers_to(&Subject::Codes),
        audiences => words(&model.availability.audiences),
        hardware => words(&model.availability.hardware),
        releases => words(&model.availability.releases),
    }
}

fn range_view(desk: Desk<'_, '_>, range: &CodeRange) -> Value {
    context! {
        first => &range.first_spelling,
        last => &range.last_spelling,
        usage => purpose(range, desk.lang),
        text => desk.lang.text(&range.text),
    }
}
