//! Each word of a closed set is written in `fc-spec/src/vocabulary` only. All other code uses its constants.

use fc_spec::model::{
    AnswerKind, BodyState, ByteOrder, DigestAlgorithm, Direction, Effect, EncodingRole,
    EnvelopeRole, Fact, FloatKind, HeaderQuirk, HeaderRole, Impact, IntKind, JsonRule, Kind,
    KindRole, PortRole, Quirk, RangeUse, ResultRole, Severity, Side, StateOrder, WireForm,
};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The directories to search.
const SOURCES: [&str; 8] = [
    "fc-cli/src",
    "fc-codegen/src",
    "fc-diff/src",
    "fc-lsp/src",
    "fc-package/src",
    "fc-reflect/src",
    "fc-workshop/src",
    "fc-spec/src",
];

/// The only folder for these words.
const HOME: &str = "fc-spec/src/vocabulary";

/// Words with another meaning, and that meaning.
const ALSO: [(&str, &str); 29] = [
    (
        "code",
        "a key of operations, and of what products say of them",
    ),
    ("command", "what the grammar calls an entry of `commands`"),
    ("commands", "a top key of the spec, and a folder of pages"),
    ("config", "a command of git"),
    ("data", "the data area of a frame"),
    ("effect", "a key of commands, and a word of the pages"),
    ("encoding", "what faults call an entry of `encodings`"),
    ("f32", "a type in the cases of JSON, which know no spec"),
    ("f64", "a type in the cases of JSON"),
    ("i16", "what other languages call a type"),
    ("i32", "a type in the cases of JSON"),
    ("i64", "a type in the cases of JSON"),
    ("id", "a key of groups and of the protocol"),
    ("kind", "a key of what products say of an operation"),
    (
        "number",
        "what JSON calls a value, in faults, schemas and vectors",
    ),
    ("protocol", "a top key of the spec"),
    (
        "question",
        "a column of the sheet, and the anchor of a question",
    ),
    ("read", "what failed on the disk"),
    ("report", "what the grammar calls an entry of `reports`"),
    ("reports", "a top key of the spec, and a folder of pages"),
    ("request", "a key of commands, of heads and of the envelope"),
    (
        "response",
        "a key of commands, of heads and of the envelope",
    ),
    ("stream", "what the grammar calls an entry of `streams`"),
    ("string", "a type"),
    ("text", "a key of what products say, and a format of output"),
    (
        "timeout",
        "an option of calls in the packages of other languages",
    ),
    ("title", "a key of the JSON Schema"),
    ("type", "a key of fields"),
    (
        "unknown_keys",
        "a case of the vectors, and a name in the generated crate",
    ),
];

/// Header fields use the widths of integers too, and are not a closed set: `bytes(16)`.
const WIDTHS: [&str; 4] = ["u8", "u16", "u32", "u64"];

fn words() -> Vec<&'static str> {
    let sets: [&[(&str, &str, &str)]; 25] = [
        AnswerKind::WORDS,
        BodyState::WORDS,
        ByteOrder::WORDS,
        DigestAlgorithm::WORDS,
        Direction::WORDS,
        Effect::WORDS,
        EncodingRole::WORDS,
        EnvelopeRole::WORDS,
        FloatKind::WORDS,
        HeaderQuirk::WORDS,
        HeaderRole::WORDS,
        IntKind::WORDS,
        JsonRule::WORDS,
        Kind::WORDS,
        KindRole::WORDS,
        Fact::WORDS,
        Impact::WORDS,
        PortRole::WORDS,
        Quirk::WORDS,
        RangeUse::WORDS,
        ResultRole::WORDS,
        Severity::WORDS,
        StateOrder::WORDS,
        Side::WORDS,
        WireForm::WORDS,
    ];
    let files = fs::read_dir(root().join(HOME)).expect("the vocabulary");
    let texts = files.map(|file| fs::read_to_string(file.unwrap().path()).unwrap());
    assert_eq!(
        texts
            .map(|it| it.matches("\nwords! {").count())
            .sum::<usize>(),
        sets.len(),
        "a set is not looked for"
    );
    sets.concat().into_iter().map(|(word, ..)| word).collect()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the root")
}

/// Collects the literals of a source outside of comments and tests, each with its file.
fn literals(found: &mut BTreeMap<String, Vec<String>>, path: &Path) {
    if path.is_dir() {
        for entry in fs::read_dir(path).unwrap() {
            literals(found, &entry.unwrap().path());
        }
        return;
    }
    let name = path
        .strip_prefix(root())
        .unwrap()
        .to_string_lossy()
        .into_owned();
    if path.extension().is_none_or(|ending| ending != "rs") || name.starts_with(HOME) {
        return;
    }
    let text = fs::read_to_string(path).unwrap();
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    for line in code.lines() {
        let line = line.split("//").next().unwrap_or_default();
        // Every second part is inside quotes. No word contains an escaped quote.
        for literal in line.split('"').skip(1).step_by(2) {
            found
                .entry(literal.to_owned())
                .or_default()
                .push(name.clone());
        }
    }
}

#[test]
fn no_word_is_spelled_twice_outside_its_set() {
    let mut found = BTreeMap::new();
    for source in SOURCES {
        literals(&mut found, &root().join(source));
    }
    let words = words();
    let mut wrong = Vec::new();
    for word in &words {
        let places = found.get(*word).map(Vec::as_slice).unwrap_or_default();
        let is_known = ALSO.iter().any(|(known, _)| known == word) || WIDTHS.contains(word);
        if places.len() > 1 && !is_known {
            wrong.push(format!("`{word}`: {}", places.join(", ")));
        }
    }
    // An exception that is no longer needed must go.
    for (word, _) in ALSO {
        if !words.contains(&word) || found.get(word).map_or(0, Vec::len) < 2 {
            wrong.push(format!("`{word}` is no exception any more"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
