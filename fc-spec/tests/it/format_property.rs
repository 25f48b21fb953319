//! Property test of the layout of a file. The layout of any mutated file has the same meaning and the same comments,
//! and a second pass changes nothing.
//!
//! `FC_FORMAT_CASES` sets the number of files to try.

use crate::format_support::{Mutations, mutate};
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::format::format;
use fc_spec::load::load;
use fc_spec::model::{Dump, Lang};
use fc_spec::source::{FileId, SourceFile, Sources};
use fc_spec::syntax::parse;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use serde_json::Value;
use std::path::Path;
use std::sync::LazyLock;

/// A spec: its files by path, and its model as JSON.
struct Seed {
    files: Vec<(String, String)>,
    says: Value,
}

/// Small specs that use much of the language, with the text of their files in the standard layout.
static SEEDS: LazyLock<Vec<Seed>> = LazyLock::new(|| {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    [
        "tests/good",
        "../fc-generated/tests/meter/spec",
        "../fc-generated/tests/beacon/spec",
    ]
    .iter()
    .map(|directory| {
        let mut files = Vec::new();
        read(&here.join(directory), "spec", &mut files);
        files.sort();
        for (_, text) in &mut files {
            // Drops the comments below the head, which mutations do not keep.
            *text = laid_out(&mutate(text, Mutations::default(), 1));
        }
        let says = says(&files);
        Seed { files, says }
    })
    .collect()
});

fn read(directory: &Path, path: &str, files: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(directory).expect("a directory") {
        let disk = entry.expect("an entry").path();
        let name = disk.file_name().expect("a name").to_string_lossy();
        let path = format!("{path}/{name}");
        if disk.is_dir() {
            read(&disk, &path, files);
        } else if disk.extension().is_some_and(|found| found == "yaml") {
            files.push((path, std::fs::read_to_string(&disk).expect("a file")));
        }
    }
}

fn laid_out(text: &str) -> String {
    let source = SourceFile::new("spec/a.yaml", text);
    let new = format(FileId(0), &source);
    new.unwrap_or_else(|refused| panic!("{refused:?}\n{text}"))
}

/// Returns the model as JSON, without lines, excerpts, and the order and numbers of answers. These change with the
/// layout.
fn says(files: &[(String, String)]) -> Value {
    let sources = Sources::from_texts(files.iter().cloned());
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    let faults = render(&faults, &sources, Format::Text, Lang::En);
    let model = model.expect(&faults);
    let mut value = serde_json::to_value(Dump::from(&model)).expect("a model");
    strip(&mut value);
    value
}

fn strip(value: &mut Value) {
    match value {
        Value::Object(keys) => {
            keys.retain(|key, _| !matches!(key.as_str(), "line" | "edit"));
            for (key, value) in keys {
                strip(value);
                match value {
                    Value::Array(items) if matches!(key.as_str(), "answers" | "questions") => {
                        items.sort_by_key(Value::to_string);
                    }
                    Value::String(name) if matches!(key.as_str(), "name" | "id") => {
                        let end = name.trim_end_matches(|it: char| it.is_ascii_digit());
                        if let Some(first) = end.strip_suffix('.') {
                            *name = first.to_owned();
                        }
                    }
                    _ => {}
                }
            }
        }
        Value::Array(items) => items.iter_mut().for_each(strip),
        _ => {}
    }
}

fn comments(text: &str) -> Vec<String> {
    let text = text.replace("\r\n", "\n");
    let tree = parse(FileId(0), &text, &mut Faults::new()).expect("a tree");
    let spans = tree.comments();
    spans
        .map(|span| text[span.start..span.end].to_owned())
        .collect()
}

fn mutations() -> impl Strategy<Value = Mutations> {
    let one = || prop::bool::weighted(0.6);
    (one(), one(), one(), one(), one(), prop::bool::weighted(0.1)).prop_map(
        |(order, comments, brackets, texts, blanks, crlf)| Mutations {
            order,
            comments,
            brackets,
            texts,
            blanks,
            crlf,
        },
    )
}

fn check(seed: &Seed, index: usize, mutations: Mutations, number: u64) {
    let mut files = seed.files.clone();
    let original = files[index].1.clone();
    let mutated = mutate(&original, mutations, number);
    let new = laid_out(&mutated);
    let context = || format!("{mutations:?}\n--- mutated\n{mutated}\n--- laid out\n{new}");

    assert_eq!(laid_out(&new), new, "not the same again: {}", context());
    let (mut before, mut after) = (comments(&mutated), comments(&new));
    if mutations.order {
        before.sort();
        after.sort();
    }
    assert_eq!(before, after, "other comments: {}", context());
    files[index].1.clone_from(&mutated);
    assert_eq!(
        says(&files),
        seed.says,
        "the mutation says something else: {}",
        context()
    );
    files[index].1.clone_from(&new);
    assert_eq!(
        says(&files),
        seed.says,
        "the layout says something else: {}",
        context()
    );
    let kept = mutations.comments || mutations.brackets || mutations.texts || mutations.blanks;
    if !kept {
        let new = new.replace("\r\n", "\n");
        assert_eq!(new, original, "another layout: {}", context());
    }
}

#[test]
fn every_layout_becomes_the_one_that_says_the_same() {
    let cases = std::env::var("FC_FORMAT_CASES").ok();
    let cases = cases.map_or(200, |cases| cases.parse().expect("a number"));
    let config = Config {
        cases,
        failure_persistence: None,
        ..Config::default()
    };
    let strategy = (
        any::<prop::sample::Index>(),
        any::<prop::sample::Index>(),
        mutations(),
        any::<u64>(),
    );
    TestRunner::new(config)
        .run(&strategy, |(seed, file, mutations, number)| {
            let seed = seed.get(&SEEDS);
            check(seed, file.index(seed.files.len()), mutations, number);
            Ok(())
        })
        .unwrap_or_else(|failure| panic!("{failure}"));
}
