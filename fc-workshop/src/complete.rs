//! Completes the words of a call: names of operations, keys and values.

use crate::paths::{self, shapes};
use fc_spec::model::{Direction, Field, Kind, Model, StructRef, Type};
use std::collections::HashSet;

/// The levels of nested keys that one completion offers.
const LEVELS: usize = 4;

/// Returns the completions of a word, which comes after the words in `before`.
#[must_use]
pub fn complete(model: &Model, before: &[&str], word: &str) -> Vec<String> {
    let mut names = before.iter().filter(|word| !word.starts_with('-'));
    let Some(name) = names.next() else {
        let callable = model.operations.iter();
        let callable = callable.filter(|operation| operation.kind() != Kind::Report);
        let names = callable.map(|operation| operation.name.clone());
        return names.filter(|name| name.starts_with(word)).collect();
    };
    let operation = model.operation(name);
    let Some(body) = operation.and_then(|it| it.body(Direction::Request)) else {
        return Vec::new();
    };
    match word.split_once('=') {
        Some((key, start)) => values(model, &body.ty, key, start),
        None => keys(model, &body.ty, word),
    }
}

/// Returns the completions of a word, with nested keys in full.
#[must_use]
pub fn complete_nested(model: &Model, before: &[&str], word: &str) -> Vec<String> {
    nested(model, before, word, LEVELS)
}

fn nested(model: &Model, before: &[&str], word: &str, levels: usize) -> Vec<String> {
    let found = complete(model, before, word).into_iter();
    let whole = found.flat_map(|found| match (found.ends_with('.'), levels) {
        (false, _) => vec![found],
        (true, 0) => Vec::new(),
        (true, _) => nested(model, before, &found, levels - 1),
    });
    whole.collect()
}

/// Returns the keys that begin with a word, each up to the next dot or the equals sign.
fn keys(model: &Model, body: &StructRef, word: &str) -> Vec<String> {
    let (parent, start) = word.split_at(word.rfind('.').map_or(0, |dot| dot + 1));
    let parents = match parent.strip_suffix('.') {
        None => vec![model.types.structure(body)],
        Some(key) => {
            field(model, body, key).map_or_else(Vec::new, |field| shapes(model, &field.ty))
        }
    };
    let fields = parents.into_iter().flat_map(|shape| &shape.fields);
    let fields = fields.filter(|field| field.wire.starts_with(start));
    let keys = fields.map(|field| {
        let end = match (shapes(model, &field.ty).is_empty(), &field.ty) {
            (true, _) => "=",
            (false, Type::Array(_)) => ".0.",
            (false, _) => ".",
        };
        format!("{parent}{}{end}", field.wire)
    });
    // Variants may share a key.
    let mut known = HashSet::new();
    keys.filter(|key| known.insert(key.clone())).collect()
}

/// Returns the values of a key that begin with a text.
fn values(model: &Model, body: &StructRef, key: &str, start: &str) -> Vec<String> {
    let Some(field) = field(model, body, key) else {
        return Vec::new();
    };
    let known = match &field.ty {
        Type::Bool => vec!["true", "false"],
        Type::Named(named) => {
            let shape = model.types.get(named).shape.enumeration();
            let values = shape.into_iter().flat_map(|shape| &shape.values);
            values.map(|value| value.name.as_str()).collect()
        }
        _ => Vec::new(),
    };
    let known = known.into_iter().filter(|value| value.starts_with(start));
    known.map(|value| format!("{key}={value}")).collect()
}

/// Returns the field of a key, in which indexes follow dots.
fn field<'m>(model: &'m Model, body: &StructRef, key: &str) -> Option<&'m Field> {
    let steps = key.split('.').filter(|step| step.parse::<usize>().is_err());
    let path: Vec<&str> = steps.collect();
    paths::field(model, body, &path.join("."))
}
