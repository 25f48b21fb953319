//! Tests that examples and defaults of the language are valid.

use super::shape;
use crate::diagnostic::{Faults, Format, render};
use crate::language;
use crate::language::grammar::{Kind, STATED, Table};
use crate::model::{Lang, Languages};
use crate::source::Sources;
use crate::syntax::parse;

/// Checks a value under a key as if it were in a file of the spec. Returns the errors, if any.
fn check(what: &str, kind: &Kind, value: &str) -> Option<String> {
    let value = value.trim_end().replace('\n', "\n  ");
    let goes_over_lines = value.contains('\n') || !value.starts_with('{') && value.contains(": ");
    let between = if goes_over_lines { "\n  " } else { " " };
    let text = format!("shown:{between}{value}\n");
    let sources = Sources::from_texts([(what.to_owned(), text)]);
    let mut faults = Faults::new();
    for (id, file) in sources.iter() {
        if let Some(tree) = parse(id, &file.text, &mut faults)
            && let Some(entry) = tree.root().entry("shown")
        {
            shape::check_kind(
                kind,
                entry.value,
                entry.key.span(),
                Languages::All,
                &mut faults,
            );
        }
    }
    let is_sound = faults.is_empty();
    (!is_sound).then(|| render(&faults, &sources, Format::Text, Lang::En))
}

/// Returns `true` for a kind that refers to another part. The example of that part applies.
fn is_of_parts(kind: &Kind) -> bool {
    match kind {
        Kind::Map(_) | Kind::ByKey { .. } | Kind::Body => true,
        Kind::List { of, .. } => is_of_parts(of),
        Kind::Entries { value, .. } => is_of_parts(value),
        Kind::Either(kinds) => kinds.iter().all(is_of_parts),
        _ => false,
    }
}

fn each_key(mut see: impl FnMut(String, &Kind, &language::Key)) {
    let tables = language::tables();
    for part in language::reference() {
        let table = tables.iter().find(|table| table.name == part.id);
        let keys = table.map(|table| table.keys).unwrap_or_default();
        for (declared, key) in keys.iter().zip(&part.keys) {
            see(format!("{}.{}", part.id, key.name), &declared.kind, key);
        }
    }
}

#[test]
fn every_example_of_a_part_is_one_of_it() {
    let tables: Vec<&'static Table> = language::tables();
    let wrong: Vec<String> = tables
        .into_iter()
        .filter_map(|table| check(table.name, &Kind::Map(table), table.example))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn each_key_has_a_valid_example() {
    let mut wrong = Vec::new();
    each_key(|name, kind, key| match &key.example {
        Some(example) => wrong.extend(check(&name, kind, example)),
        None if is_of_parts(kind) => {}
        None => wrong.push(format!("{name} has no example")),
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn defaults_are_valid_and_of_optional_keys() {
    let mut wrong = Vec::new();
    each_key(|name, kind, key| {
        // The default `stated` is never written.
        if let Some(default) = key.default.filter(|default| *default != STATED.name()) {
            let is_idle = key.required.then(|| format!("{name} is required"));
            wrong.extend(check(&name, kind, default).or(is_idle));
        }
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
