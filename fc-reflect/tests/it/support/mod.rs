//! Helpers that several tests share.

pub mod specs;
pub mod typed;

use serde_json::Value;
use std::fs;
use std::path::PathBuf;

/// Returns the committed vectors with the names of their files.
pub fn vectors() -> Vec<(String, Value)> {
    let folder = specs::root().join("fc-generated/vectors");
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

/// Returns a list of cases.
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

/// Returns the number in an environment variable, or `otherwise`.
pub fn number(name: &str, otherwise: u64) -> u64 {
    let given = std::env::var(name).ok();
    given.map_or(otherwise, |text| text.parse().expect("a number"))
}
