//! The result codes.

use super::shared::{Desk, list};
use crate::emit::markdown::links::Anchor;
use crate::emit::markdown::words::Word as _;
use fc_spec::model::Subject;
use minijinja::{Value, context};

pub(in crate::emit::markdown) fn results(desk: Desk<'_, '_>) -> Value {
    let model = desk.book.model;
    let mut answers = desk.answers_to(&Subject::Results(None));
    for result in &model.results {
        let subject = Subject::Results(Some(result.code));
        answers.extend(desk.answers_to(&subject));
    }
    let view = |result: &fc_spec::model::ResultCode| {
        let declaring = model.operations.iter().filter_map(|operation| {
            let cause = operation.error(result.code)?.cause.as_ref();
            Some(context! {
                operation => desk.operation(operation),
                cause => cause.map(|cause| desk.sentence(cause)),
            })
        });
        context! {
            anchor => Anchor::of("result", &result.code.to_string()).id(),
            code => result.code,
            name => &result.name,
            text => desk.lang.text(&result.text),
            about => desk.sentence(&result.about),
            role => result.role.map(|role| role.word(desk.lang)),
            operations => list(declaring),
        }
    };
    let key = model.envelope.result_code();
    context! {
        is_sent => key.is_some(),
        aliases => key.map_or_else(Vec::new, |key| desk.lang.aliases(&key.aliases)),
        results => list(model.results.iter().map(view)),
        answers,
    }
}
