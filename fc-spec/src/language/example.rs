//! An example for the value of each key.

use crate::language::grammar::{AnyKey, Kind};

/// Returns the example in the declaration of the key, or else one that follows from its kind.
pub(super) fn for_key(key: &AnyKey) -> Option<String> {
    let said = key.said.example.map(str::to_owned);
    said.or_else(|| any(&key.kind))
}

/// Returns a value of a kind whose values are all equally good examples.
///
/// Returns `None` for a mapping, because its part has an example.
fn any(kind: &Kind) -> Option<String> {
    let value = match kind.form() {
        Kind::Bool => "true",
        Kind::Code => "0x0A01",
        Kind::Date => "2024-05-06",
        Kind::ConflictId => "C040",
        Kind::MediaType => "image/png",
        Kind::Word(words) => words.first()?.0,
        Kind::List { of, .. } => return Some(format!("[{}]", any(of)?)),
        Kind::Either(kinds) => return kinds.iter().find_map(any),
        _ => return None,
    };
    Some(value.to_owned())
}
