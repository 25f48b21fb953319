//! The makers: one small function for each kind of slip. A maker looks at a place in a spec. If the place has the right
//! shape, the maker returns the change that makes the slip there.

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

/// A kind of slip, and the function that makes it.
pub struct Maker {
    pub kind: &'static str,
    pub make: fn(At<'_>) -> Option<Change>,
}

const fn maker(kind: &'static str, make: fn(At<'_>) -> Option<Change>) -> Maker {
    Maker { kind, make }
}

/// Returns all makers.
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

/// Swaps the second and the third letter of a word. Returns `None` if that changes nothing.
fn swapped(word: &str) -> Option<String> {
    let mut letters: Vec<char> = word.chars().collect();
    let (first, second) = (*letters.get(1)?, *letters.get(2)?);
    if first == second || !first.is_ascii_alphabetic() || !second.is_ascii_alphabetic() {
        return None;
    }
    letters.swap(1, 2);
    Some(letters.into_iter().collect())
}

/// Capitalizes the first letter of a word.
fn capital(word: &str) -> Option<String> {
    let first = word.chars().next().filter(char::is_ascii_lowercase)?;
    Some(first.to_ascii_uppercase().to_string() + &word[1..])
}
