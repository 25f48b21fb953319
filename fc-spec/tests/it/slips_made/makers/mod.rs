//! The makers: one small function for each kind of slip, which looks at a place of a spec and, where it has the right
//! shape, says how the slip is made there.

mod blocks;
mod keys;
mod layout;
mod meaning;
mod merges;
mod punctuation;
mod types;
mod unfinished;
mod values;

use super::change::Change;
use super::place::At;

/// A kind of slip.
pub struct Maker {
    pub kind: &'static str,
    pub make: fn(At<'_>) -> Option<Change>,
}

const fn maker(kind: &'static str, make: fn(At<'_>) -> Option<Change>) -> Maker {
    Maker { kind, make }
}

/// All of them.
pub fn all() -> impl Iterator<Item = &'static Maker> {
    [
        keys::MAKERS,
        values::MAKERS,
        types::MAKERS,
        punctuation::MAKERS,
        layout::MAKERS,
        blocks::MAKERS,
        merges::MAKERS,
        unfinished::MAKERS,
        meaning::MAKERS,
    ]
    .into_iter()
    .flatten()
}

/// A word with its second and third letter in each other's place.
fn swapped(word: &str) -> Option<String> {
    let mut letters: Vec<char> = word.chars().collect();
    let (first, second) = (*letters.get(1)?, *letters.get(2)?);
    if first == second || !first.is_ascii_alphabetic() || !second.is_ascii_alphabetic() {
        return None;
    }
    letters.swap(1, 2);
    Some(letters.into_iter().collect())
}

/// A word with a capital letter at its start.
fn capital(word: &str) -> Option<String> {
    let first = word.chars().next().filter(char::is_ascii_lowercase)?;
    Some(first.to_ascii_uppercase().to_string() + &word[1..])
}
