//! What several tests need.

#![allow(
    dead_code,
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::unwrap_used,
    reason = "tests; each uses a part of it"
)]

pub mod typed;

use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::Model;
use fc_spec::syntax::{Sources, read_dir};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// The project's root.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap().to_owned()
}

/// The model of the project's own spec, to which the committed vectors belong.
pub fn model() -> Model {
    let mut faults = Faults::new();
    let sources = read_dir(&root(), Path::new("spec"), &mut faults);
    loaded(&sources, faults)
}

/// The header and envelope of the small protocol.
pub const SMALL: &str = include_str!("../small/protocol.yaml");

/// The small protocol.
pub fn small() -> Model {
    model_of(SMALL, include_str!("../small/commands/lamp.yaml"))
}

/// The model of a protocol with one group.
pub fn model_of(protocol: &str, commands: &str) -> Model {
    let files = [
        ("spec/protocol.yaml", protocol),
        ("spec/commands/lamp.yaml", commands),
    ];
    let files = files.map(|(path, text)| (path.to_owned(), text.to_owned()));
    loaded(&Sources::from_texts(files), Faults::new())
}

fn loaded(sources: &Sources, mut faults: Faults) -> Model {
    let model = load(sources, &mut faults);
    model.unwrap_or_else(|| panic!("{}", render(&faults, sources, Format::Text)))
}

/// The committed vectors: each file by its name.
pub fn vectors() -> Vec<(String, Value)> {
    let folder = root().join("fc-generated/vectors");
    let mut files: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "json"))
        .collect();
    files.sort();
    let read = |path: PathBuf| {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let text = fs::read_to_string(&path).unwrap();
        (name, serde_json::from_str(&text).unwrap())
    };
    files.into_iter().map(read).collect()
}

/// A list of cases.
pub fn cases<'v>(file: &'v Value, list: &str) -> &'v [Value] {
    file[list].as_array().unwrap()
}

pub fn hex(bytes: &[u8]) -> String {
    let push = |text: String, byte: &u8| text + &format!("{byte:02x}");
    bytes.iter().fold(String::new(), push)
}

pub fn unhex(text: &str) -> Vec<u8> {
    let digit = |at: usize| u8::from_str_radix(&text[at..at + 2], 16).unwrap();
    (0..text.len()).step_by(2).map(digit).collect()
}
