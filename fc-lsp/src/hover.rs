//! Hover texts of keys, words and definitions, in both languages. Types and messages also show their Rust code and a
//! JSON example.

use crate::item::of_site;
use crate::language::{self, both, markdown};
use crate::snapshot::Snapshot;
use fc_codegen::emit::rust;
use fc_reflect::sample::{Profile, Samples};
use fc_spec::index::{DefId, Occurrence, Role};
use fc_spec::model::Lang;
use fc_spec::model::{Direction, Model, Operation, Text, TypeDef, TypeShape, Value};
use fc_spec::source::FileId;
use gen_lsp_types::Hover;
use std::fmt::Write as _;

/// The maximum number of lines of Rust or JSON that a hover shows.
const LINES: usize = 60;

/// Returns the hover text at an offset.
#[must_use]
pub fn hover(snapshot: &Snapshot, at: (FileId, usize)) -> Option<Hover> {
    let (text, span) = snapshot.at(at, |occurrence| {
        let span = occurrence.node.span();
        if occurrence.role == Role::Key {
            return Some((of_key(snapshot, occurrence)?, span));
        }
        if let Some(meant) = of_site(snapshot, occurrence) {
            return Some((thing(snapshot, &meant.item)?, meant.span));
        }
        Some((of_word(snapshot, occurrence)?, span))
    })?;
    Some(Hover {
        contents: markdown(text).into(),
        range: Some(snapshot.range(span)),
    })
}

fn of_key(snapshot: &Snapshot, occurrence: &Occurrence<'_>) -> Option<String> {
    let lang = snapshot.settings.lang;
    let key = language::key(occurrence.part, occurrence.key?)?;
    let required = if key.required {
        lang.pick("（必填）", " (required)")
    } else {
        ""
    };
    let mut text = format!("`{}`{required}\n\n{}", key.name, both(&key.text, lang));
    let takes = key.takes.iter().filter(|takes| !takes.text.en.is_empty());
    for takes in takes {
        text.push_str("\n\n— ");
        text.push_str(lang.text(&takes.text));
    }
    for word in key.takes.iter().flat_map(|takes| &takes.words) {
        // Writing to a String cannot fail.
        let _ = write!(text, "\n- `{}` {}", word.word, lang.text(&word.text));
    }
    Some(text)
}

fn of_word(snapshot: &Snapshot, occurrence: &Occurrence<'_>) -> Option<String> {
    let lang = snapshot.settings.lang;
    let written = occurrence.node.as_str()?.trim_end_matches('?');
    let mut words = occurrence.words().into_iter();
    if let Some(word) = words.find(|word| word.word == written) {
        return Some(format!("`{}`\n\n{}", word.word, both(&word.text, lang)));
    }
    // For an unknown word, the description of its key.
    let key = language::key(occurrence.part, occurrence.key?)?;
    Some(format!("`{}`\n\n{}", key.name, both(&key.text, lang)))
}

/// Returns the hover text of a definition.
pub fn thing(snapshot: &Snapshot, item: &DefId) -> Option<String> {
    let known = snapshot.known().analysis();
    let lang = snapshot.settings.lang;
    let mut text = format!("**{}** `{}`", kind(item, lang), name(item));
    if item.is_operation() {
        let mut operations = known.operations().iter();
        let operation = operations.find(|it| it.name == item.name)?;
        of_operation(&mut text, operation, lang);
        if let Some(model) = known.model() {
            messages(&mut text, snapshot, model, operation);
        }
    } else if item.is_type() {
        let ty = known.types().named(&item.name)?;
        described(&mut text, &ty.title, ty.about.as_ref(), lang);
        if let Some(model) = known.model() {
            let shown = rust::items(model, &snapshot.project.targets, &[&ty.name]);
            code(&mut text, "rust", &without_docs(&shown));
            let sample = Samples::new(model).named(ty, Profile::Example);
            json(&mut text, &sample);
        }
    } else if let Some(owner) = item.owner.as_deref().and_then(|it| known.types().named(it)) {
        of_part(&mut text, snapshot, owner, item)?;
    } else {
        let place = snapshot.definitions().get(item)?;
        let (title, about) = fc_spec::index::described(snapshot.trees(), place)?;
        described(&mut text, &title, about.as_ref(), lang);
    }
    Some(text)
}

fn kind(item: &DefId, lang: Lang) -> &str {
    let part = language::part(item.kind);
    part.map_or(item.kind, |part| lang.text(&part.name))
}

fn name(item: &DefId) -> String {
    match &item.owner {
        Some(owner) => format!("{owner}.{}", item.name),
        None => item.name.clone(),
    }
}

fn described(text: &mut String, title: &Text, about: Option<&Text>, lang: Lang) {
    for part in std::iter::once(title).chain(about) {
        text.push_str("\n\n");
        text.push_str(&both(part, lang));
    }
}

fn of_operation(text: &mut String, operation: &Operation, lang: Lang) {
    let _ = write!(text, " · `{}`", operation.code.spelling);
    if let Some(effect) = operation.effect() {
        let _ = write!(text, " · {}", effect.name());
    }
    described(text, &operation.title, operation.about.as_ref(), lang);
    if let Some(deprecated) = &operation.deprecated {
        text.push_str("\n\n⚠ ");
        text.push_str(&both(&deprecated.note, lang));
    }
}

/// Adds the Rust types and the example messages of both directions.
fn messages(text: &mut String, snapshot: &Snapshot, model: &Model, operation: &Operation) {
    let bodies: Vec<&str> = operation.bodies().map(|body| body.ty.name()).collect();
    let shown = rust::items(model, &snapshot.project.targets, &bodies);
    code(text, "rust", &without_docs(&shown));
    let samples = Samples::new(model);
    for direction in [Direction::Request, Direction::Response] {
        if operation.body(direction).is_some() {
            let sample = samples.message(operation, direction, Profile::Example);
            json(text, &sample);
        }
    }
}

/// Adds a field, an enum value or a variant.
fn of_part(text: &mut String, snapshot: &Snapshot, owner: &TypeDef, item: &DefId) -> Option<()> {
    let lang = snapshot.settings.lang;
    match &owner.shape {
        TypeShape::Struct(shape) => {
            let field = shape.field(&item.name)?;
            let mark = if field.optional { "?" } else { "" };
            let _ = write!(text, " · `{}{mark}`", field.ty);
            let details = field.details();
            if let Some(unit) = &details.unit {
                let _ = write!(text, " · {unit}");
            }
            described(text, &field.text, details.note.as_ref(), lang);
            let model = snapshot.known().analysis().model()?;
            let targets = &snapshot.project.targets;
            let rust = rust::field(model, targets, &owner.name, &item.name)?;
            code(text, "rust", &rust);
            let sample = Samples::new(model).value_of(field);
            json(text, &Value::Object(vec![(field.wire.clone(), sample)]));
        }
        TypeShape::Enum(shape) => {
            let value = shape.values.iter().find(|it| it.name == item.name)?;
            let _ = write!(text, " · `{}`", Value::from(&value.wire));
            described(text, &value.text, None, lang);
        }
        TypeShape::OneOf(choice) => {
            let variant = choice.variants.iter().find(|it| it.name == item.name)?;
            described(text, &variant.text, None, lang);
        }
    }
    Some(())
}

fn code(text: &mut String, language: &str, code: &str) {
    let code = code.trim_end();
    if code.is_empty() {
        return;
    }
    let mut lines: Vec<&str> = code.lines().take(LINES).collect();
    if code.lines().count() > LINES {
        lines.push("…");
    }
    let _ = write!(text, "\n\n```{language}\n{}\n```", lines.join("\n"));
}

fn json(text: &mut String, value: &Value) {
    if let Ok(pretty) = serde_json::to_string_pretty(value) {
        code(text, "json", &pretty);
    }
}

/// Returns Rust without doc comments. The hover shows their text already.
fn without_docs(rust: &str) -> String {
    let is_kept = |line: &&str| !line.trim_start().starts_with("///");
    let lines = rust.lines().filter(is_kept);
    let mut kept = String::new();
    let mut was_blank = true;
    for line in lines {
        let is_blank = line.trim().is_empty();
        if !(is_blank && was_blank) {
            kept.push_str(line);
            kept.push('\n');
        }
        was_blank = is_blank;
    }
    kept
}
