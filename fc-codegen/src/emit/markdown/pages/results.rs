//! The result codes.

use super::shared::{AnswerView, Desk};
use crate::emit::markdown::links::{Anchor, Link};
use crate::emit::markdown::words::Word as _;
use fc_spec::model::Subject;
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct ResultsView {
    /// `true` if responses carry a result code.
    is_sent: bool,
    /// Other words for the key of a result code.
    aliases: Vec<String>,
    results: Vec<ResultView>,
    answers: Vec<AnswerView>,
}

#[derive(Debug, Serialize)]
struct ResultView {
    anchor: String,
    code: i64,
    name: String,
    text: String,
    about: String,
    /// The case in which the runtime returns it.
    role: Option<&'static str>,
    /// The operations that declare it.
    operations: Vec<Declaring>,
}

#[derive(Debug, Serialize)]
struct Declaring {
    operation: Link,
    /// The meaning for the operation.
    cause: Option<String>,
}

pub(in crate::emit::markdown) fn results(desk: Desk<'_, '_>) -> ResultsView {
    let model = desk.book.model;
    let mut answers = desk.answers_to(&Subject::Results(None));
    for result in &model.results {
        let subject = Subject::Results(Some(result.code));
        answers.extend(desk.answers_to(&subject));
    }
    let view = |result: &fc_spec::model::ResultCode| {
        let declaring = model.operations.iter().filter_map(|operation| {
            let cause = operation.error(result.code)?.cause.as_ref();
            Some(Declaring {
                operation: desk.operation(operation),
                cause: cause.map(|cause| desk.sentence(cause)),
            })
        });
        ResultView {
            anchor: Anchor::of("result", &result.code.to_string()).id(),
            code: result.code,
            name: result.name.clone(),
            text: desk.lang.text(&result.text).to_owned(),
            about: desk.sentence(&result.about),
            role: result.role.map(|role| role.word(desk.lang)),
            operations: declaring.collect(),
        }
    };
    let key = model.envelope.result_code();
    ResultsView {
        is_sent: key.is_some(),
        aliases: key.map_or_else(Vec::new, |key| desk.lang.aliases(&key.aliases)),
        results: model.results.iter().map(view).collect(),
        answers,
    }
}
