//! What is said where something of another kind stands.

use super::keys::article;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::grammar::Kind;
use crate::syntax::{Node, Span};
use crate::vocabulary::Meaning;

/// Reports a node that is not what is expected in its place.
pub(super) fn wrong_kind(expected: &str, node: Node<'_>, at: Span, faults: &mut Faults) {
    if let Some(slip) = node.slip() {
        faults.push(slip);
        return;
    }
    if node.is_null() && node.lacks(faults.gaps(), at) {
        return;
    }
    let span = if node.is_null() { at } else { node.span() };
    faults.hide(node.span());
    // A file that breaks off here had more in it.
    if node.ends_file() {
        faults.lose();
    }
    let fault = Diagnostic::error(
        FaultCode::WrongKind,
        span,
        format!("expected {expected}, found {}", node.describe()),
    );
    faults.push(
        if node.is_null() && expected.starts_with("a mapping from") {
            fault.note("write `{}` if there are none")
        } else if node.is_null() && expected == "a list" {
            fault.note("write `[]` if there are none")
        } else {
            fault
        },
    );
}

/// What a value has to be.
pub(super) fn describe(kind: &Kind) -> String {
    match kind {
        Kind::Text | Kind::WireKey => "a text".to_owned(),
        Kind::Bool => "`true` or `false`".to_owned(),
        Kind::Int { .. } => "an integer".to_owned(),
        Kind::Number => "a number".to_owned(),
        Kind::Scalar => "a number, text or boolean".to_owned(),
        Kind::Json => "a JSON value".to_owned(),
        Kind::Code => "a code such as 0x0A01".to_owned(),
        Kind::Date => "a date such as 2024-01".to_owned(),
        Kind::Name => "a snake_case name".to_owned(),
        Kind::TypeName => "the name of a type".to_owned(),
        Kind::Type => "a type".to_owned(),
        Kind::ConflictId => "a conflict id such as C040".to_owned(),
        Kind::MediaType => "a media type such as `image/png`".to_owned(),
        Kind::Unit => "a unit such as `ms`".to_owned(),
        Kind::Word(words) => list_words(words),
        Kind::List { .. } => "a list".to_owned(),
        Kind::Map(table) => format!("a mapping with the keys of {}", article(table.name)),
        Kind::Entries { .. } | Kind::ByKey { .. } | Kind::Body => "a mapping".to_owned(),
        Kind::Either(kinds) => kinds.iter().map(describe).collect::<Vec<_>>().join(" or "),
    }
}

/// What the keys of a mapping have to be.
pub(super) fn describe_key(key: &Kind) -> &'static str {
    match key {
        Kind::Name => "snake_case names",
        Kind::TypeName => "PascalCase names",
        Kind::Int { .. } => "numbers",
        Kind::Scalar => "the values that are sent",
        Kind::ConflictId => "conflict ids",
        _ => "wire keys",
    }
}

/// Words as a sentence lists them.
pub(super) fn list_words(words: &[Meaning]) -> String {
    let quoted: Vec<_> = words.iter().map(|(word, ..)| format!("`{word}`")).collect();
    quoted.join(", ")
}
