//! The keys of the spec language, from its grammar.

use super::shared::{Desk, list};
use fc_spec::diagnostic::FaultCode;
use fc_spec::language::{self, Key, Part, Takes, Word};
use minijinja::{Value, context};

pub(in crate::emit::markdown) fn language(desk: Desk<'_, '_>) -> Value {
    let all = language::reference();
    let words = |words: &[Word]| -> Vec<Value> {
        let word = |word: &Word| {
            context! {
                word => word.word,
                text => desk.lang.text(&word.text),
            }
        };
        words.iter().map(word).collect()
    };
    let link = |part: &Part| {
        context! {
            anchor => anchor(part.id),
            text => desk.lang.text(&part.name),
        }
    };
    let takes = |takes: &Takes| {
        context! {
            text => desk.lang.text(&takes.text),
            parts => list((all.iter().filter(|part| takes.parts.contains(&part.id))).map(link)),
            words => words(&takes.words),
        }
    };
    let key = |part: &Part, key: &Key| {
        context! {
            anchor => format!("{}-{}", anchor(part.id), key.name),
            name => key.name,
            required => key.required,
            default => key.default,
            text => desk.lang.text(&key.text),
            takes => list(key.takes.iter().map(takes)),
            example => &key.example,
            faults => numbers(&key.faults),
        }
    };
    let part = |part: &Part| {
        context! {
            link => link(part),
            printed => desk.lang.pick(Some(part.name.zh.clone()), None),
            text => desk.lang.text(&part.text),
            example => part.example,
            faults => numbers(&part.faults),
            keys => list(part.keys.iter().map(|one| key(part, one))),
            words => words(&part.words),
        }
    };
    context! {
        parts => list(all.iter().map(part)),
    }
}

/// Returns the codes of errors, which are their anchors on the page of errors.
fn numbers(faults: &[FaultCode]) -> Vec<&'static str> {
    faults.iter().map(|fault| fault.as_str()).collect()
}

fn anchor(id: &str) -> String {
    id.replace(' ', "-")
}
