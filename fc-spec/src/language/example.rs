//! What may stand under a key, as an example.

use crate::language::grammar::{AnyKey, Kind};

/// As the key's declaration has it, or any value where one is as good as another.
pub(super) fn of(key: &AnyKey) -> Option<String> {
    let said = key.said.example.map(str::to_owned);
    said.or_else(|| any(&key.kind))
}

/// A value of a kind of which all are alike. None of what is made of keys, which is shown with its part.
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
