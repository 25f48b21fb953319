//! Conflicts between attributes of a message.

use super::ast::Message;
use super::condition;
use crate::errors::Errors;
use crate::item;
use std::collections::HashSet;

/// Reports all conflicts between attributes.
pub fn check(message: &Message<'_>, errors: &mut Errors) {
    item::forbid_parameters(message.generics, errors, "a message");
    check_keys(message, errors);
    for (extra, _) in message.extra.iter().skip(1) {
        errors.on(
            extra,
            "unknown keys are kept by one field; `extra` is given twice",
        );
    }
    for field in &message.fields {
        field.attributes.constraints.check_limits(errors);
        condition::check(message, field, errors);
    }
}

/// Reports a key that two fields read.
fn check_keys(message: &Message<'_>, errors: &mut Errors) {
    let mut seen = HashSet::new();
    for field in &message.fields {
        let also = field.attributes.also.get().into_iter().flatten();
        let keys = std::iter::once((field.key.clone(), field.key_span))
            .chain(also.map(|literal| (literal.value(), literal.span())));
        for (key, span) in keys {
            if key.is_empty() {
                errors.at(span, "a key has at least one character");
            } else if key
                .chars()
                .any(|c| c.is_control() && !matches!(c, '\n' | '\r' | '\t'))
            {
                errors.at(span, "a key has no control characters");
            } else if !seen.insert(key.clone()) {
                errors.at(span, format!("the key `{key}` is read already"));
            }
        }
    }
}
