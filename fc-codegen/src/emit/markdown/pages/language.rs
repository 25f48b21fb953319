//! The keys of the spec language, from its grammar.

use super::shared::Desk;
use fc_spec::diagnostic::FaultCode;
use fc_spec::language::{self, Key, Part, Takes, Word};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct LanguageView {
    parts: Vec<PartView>,
}

#[derive(Debug, Serialize)]
struct PartView {
    link: PartLink,
    /// The name in errors, for the Chinese page.
    printed: Option<String>,
    text: String,
    example: Option<&'static str>,
    /// The errors about the part as a whole.
    faults: Vec<&'static str>,
    keys: Vec<KeyView>,
    words: Vec<WordView>,
}

#[derive(Debug, Serialize)]
struct PartLink {
    anchor: String,
    text: String,
}

#[derive(Debug, Serialize)]
struct KeyView {
    anchor: String,
    name: &'static str,
    required: bool,
    default: Option<&'static str>,
    text: String,
    takes: Vec<TakesView>,
    example: Option<String>,
    faults: Vec<&'static str>,
}

#[derive(Debug, Serialize)]
struct TakesView {
    text: String,
    parts: Vec<PartLink>,
    words: Vec<WordView>,
}

#[derive(Debug, Serialize)]
struct WordView {
    word: &'static str,
    text: String,
}

pub(in crate::emit::markdown) fn language(desk: Desk<'_, '_>) -> LanguageView {
    let all = language::reference();
    let words = |words: &[Word]| -> Vec<WordView> {
        let word = |word: &Word| WordView {
            word: word.word,
            text: desk.lang.text(&word.text).to_owned(),
        };
        words.iter().map(word).collect()
    };
    let link = |part: &Part| PartLink {
        anchor: anchor(part.id),
        text: desk.lang.text(&part.name).to_owned(),
    };
    let takes = |takes: &Takes| TakesView {
        text: desk.lang.text(&takes.text).to_owned(),
        parts: (all.iter().filter(|part| takes.parts.contains(&part.id)))
            .map(link)
            .collect(),
        words: words(&takes.words),
    };
    let key = |part: &Part, key: &Key| KeyView {
        anchor: format!("{}-{}", anchor(part.id), key.name),
        name: key.name,
        required: key.required,
        default: key.default,
        text: desk.lang.text(&key.text).to_owned(),
        takes: key.takes.iter().map(takes).collect(),
        example: key.example.clone(),
        faults: numbers(&key.faults),
    };
    let part = |part: &Part| PartView {
        link: link(part),
        printed: desk.lang.pick(Some(part.name.zh.clone()), None),
        text: desk.lang.text(&part.text).to_owned(),
        example: part.example,
        faults: numbers(&part.faults),
        keys: part.keys.iter().map(|one| key(part, one)).collect(),
        words: words(&part.words),
    };
    LanguageView {
        parts: all.iter().map(part).collect(),
    }
}

/// Returns the codes of errors, which are their anchors on the page of errors.
fn numbers(faults: &[FaultCode]) -> Vec<&'static str> {
    faults.iter().map(|fault| fault.as_str()).collect()
}

fn anchor(id: &str) -> String {
    id.replace(' ', "-")
}
