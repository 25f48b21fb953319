//! Finds the constructions of `words/constructions.yaml` in English sentences.

use serde::Deserialize;
use std::collections::HashMap;
use std::fs;
use std::path::Path;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rules {
    longest: usize,
    test_name: usize,
    pub starts: Vec<Construction>,
    pub anywhere: Vec<Construction>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Construction {
    with: String,
    pub bad: String,
    pub say: String,
}

/// Phrases by their first word. Each value has the remaining words.
pub type Phrases = HashMap<String, Vec<Vec<String>>>;

pub struct Matcher {
    longest: usize,
    pub test_name: usize,
    starts: Phrases,
    anywhere: Phrases,
}

pub fn rules() -> Rules {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/words/constructions.yaml");
    serde_yaml::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// Returns every phrase of a pattern such as `of a|an|the`.
pub fn expand(patterns: &[Construction]) -> Phrases {
    let mut phrases = Phrases::new();
    for pattern in patterns {
        let mut all: Vec<Vec<String>> = vec![Vec::new()];
        for word in pattern.with.split(' ') {
            let longer = all.iter().flat_map(|phrase| {
                word.split('|').map(move |word| {
                    let mut phrase = phrase.clone();
                    phrase.push(word.to_owned());
                    phrase
                })
            });
            all = longer.collect();
        }
        for mut phrase in all {
            let first = phrase.remove(0);
            phrases.entry(first).or_default().push(phrase);
        }
    }
    phrases
}

impl Matcher {
    pub fn new(rules: &Rules) -> Self {
        Self {
            longest: rules.longest,
            test_name: rules.test_name,
            starts: expand(&rules.starts),
            anywhere: expand(&rules.anywhere),
        }
    }

    /// Returns the construction of a sentence, or its length if it is too long.
    pub fn find(&self, sentence: &str) -> Option<String> {
        let words = words(sentence);
        let at_start = words.first().and_then(|_| phrase(&self.starts, &words));
        if let Some(found) = at_start {
            return Some(found);
        }
        let mut rests = (0..words.len()).map(|at| &words[at..]);
        if let Some(found) = rests.find_map(|rest| phrase(&self.anywhere, rest)) {
            return Some(found);
        }
        let length = sentence.split_whitespace().count();
        (length > self.longest).then(|| format!("{length} words"))
    }

    /// Returns the sentences that count, each with its reason.
    pub fn count(&self, blocks: &[String]) -> Vec<String> {
        let sentences = blocks.iter().flat_map(|block| sentences(block));
        let found = sentences.filter_map(|it| Some((self.find(&it)?, it)));
        found.map(|(why, it)| format!("{it} [{why}]")).collect()
    }
}

/// Returns the phrase that these words start with.
pub fn phrase(phrases: &Phrases, words: &[String]) -> Option<String> {
    let (first, rest) = words.split_first()?;
    let found = phrases.get(first)?.iter().find(|it| rest.starts_with(it))?;
    let all = std::iter::once(first).chain(found);
    Some(all.map(String::as_str).collect::<Vec<_>>().join(" "))
}

pub fn words(sentence: &str) -> Vec<String> {
    let is_between = |c: char| !(c.is_alphanumeric() || matches!(c, '\'' | '-' | '_'));
    let words = sentence.split(is_between).filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect()
}

/// Returns `true` for Chinese characters and punctuation and for the dot between badges. They end a piece of English.
fn ends_piece(character: char) -> bool {
    matches!(character, '·' | '\u{2E80}'..='\u{9FFF}' | '\u{F900}'..='\u{FAFF}' | '\u{FF00}'..='\u{FFEF}' | '“' | '”')
}

/// Returns the English sentences of a block, which is one paragraph. A code span counts as one word.
pub fn sentences(block: &str) -> Vec<String> {
    let mut text = String::new();
    for (index, part) in block.split('`').enumerate() {
        text.push_str(if index % 2 == 1 { "X" } else { part });
    }
    let mut found = Vec::new();
    for piece in text.split(ends_piece) {
        let words: Vec<&str> = piece.split_whitespace().collect();
        let mut from = 0;
        for at in 1..=words.len() {
            let ends = words[at - 1].ends_with(['.', '!', '?']);
            let starts = words.get(at).and_then(|word| word.chars().next());
            let starts = starts.is_none_or(|c| c.is_ascii_uppercase() || c.is_ascii_digit());
            if at == words.len() || ends && starts {
                if at - from >= 3 {
                    found.push(words[from..at].join(" "));
                }
                from = at;
            }
        }
    }
    found
}
