//! Checks terms of the glossary.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{Form, Key, OTHER_FORMS, TERM, TEXT};
use crate::load::draft::{Draft, Sourced};
use crate::source::Span;
use crate::syntax::Node;
use crate::text;
use std::collections::HashMap;

/// Checks that, in each language, a word belongs to one term and occurs there once. Words that differ only in case
/// count as one, because readers do not distinguish them.
///
/// A term may be absent from all texts: readers also look up words from the source or the robot.
pub(super) fn check_words(draft: &Draft<'_>, faults: &mut Faults) {
    check_language(draft, TEXT.zh, OTHER_FORMS.zh, faults);
    check_language(draft, TEXT.en, OTHER_FORMS.en, faults);
}

/// A known word.
struct Seen<'d> {
    /// Id of its term.
    term: &'d str,
    word: &'d str,
    is_other: bool,
    span: Span,
}

fn check_language(
    draft: &Draft<'_>,
    own: Key<impl Form>,
    other: Key<impl Form>,
    faults: &mut Faults,
) {
    let mut first: HashMap<String, Seen<'_>> = HashMap::new();
    for Sourced { item, origin } in &draft.glossary {
        let own = own.of(origin.node).map(|node| (node, false));
        let others = other.items(TERM.also.of(origin.node));
        let words = own.into_iter().chain(others.map(|node| (node, true)));
        for (node, is_other) in words {
            // An empty or malformed text has its own error.
            let Some(word) = node.as_str().filter(|word| !word.trim().is_empty()) else {
                continue;
            };
            let Some(earlier) = first.get(&word.to_lowercase()) else {
                let seen = Seen {
                    term: &item.id,
                    word,
                    is_other,
                    span: node.span(),
                };
                first.insert(word.to_lowercase(), seen);
                continue;
            };
            let is_same_term = earlier.term == item.id;
            // The shape check reports a repeated list item.
            if is_same_term && earlier.is_other && is_other && earlier.word == word {
                continue;
            }
            faults.push(shared(node, word, earlier, is_same_term));
        }
    }
}

fn shared(node: Node<'_>, word: &str, earlier: &Seen<'_>, is_same_term: bool) -> Diagnostic {
    let message = if is_same_term {
        text!(
            "`{word}` 在术语 `{term}` 中出现两次",
            "`{word}` occurs twice in the term `{term}`",
            term = earlier.term
        )
    } else {
        text!(
            "`{word}` 已经属于术语 `{term}`",
            "`{word}` already belongs to the term `{term}`",
            term = earlier.term
        )
    };
    Diagnostic::error(FaultCode::SharedWord, node.span(), message).also_first(earlier.span)
}
