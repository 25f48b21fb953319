//! Renames a thing everywhere in a spec.
//!
//! The messages stay the same: a field gets another name in code and keeps its wire key.

use crate::index::{DefId, DefSite, Index, described, entry_at};
use crate::language::grammar::{
    COMMON, EnumValue, EnvelopeField, FIELD, FIELD_FORMS, Field, HeaderField, TEXT, Table,
};
use crate::load::yaml_scalar;
use crate::source::{SourceFile, Span};
use crate::syntax::{Entry, Node};

/// Returns the replacements that rename a thing to `new`.
///
/// Returns `None` for a thing without its own name, such as a type named after its operation.
///
/// It does not check the new name. [`load`](crate::load::load) reports a name that is taken or not valid.
#[must_use]
pub fn rename(
    index: &Index,
    (item, place): (&DefId, &DefSite),
    new: &str,
) -> Option<Vec<(Span, String)>> {
    let tree = index.trees().tree(place.key.file)?;
    let entry = entry_at(tree.root(), place.key)?;
    let mut changes: Vec<(Span, String)> = Vec::new();
    if let Some(table) = sent(item) {
        changes.push(code_name(index, (table, entry), new)?);
    } else if entry.key.as_str() == Some(&item.name) {
        changes.push((entry.key.span(), new.to_owned()));
    }
    let uses = index.references();
    changes.extend(
        uses.of(item)
            .map(|reference| (reference.span, new.to_owned())),
    );
    (!changes.is_empty()).then_some(changes)
}

/// Returns the keys of a thing whose own key is part of the messages. Its name in code is a separate key.
fn sent(item: &DefId) -> Option<&'static Table> {
    let sent = [
        Field::TABLE,
        EnvelopeField::TABLE,
        HeaderField::TABLE,
        EnumValue::TABLE,
    ];
    sent.into_iter().find(|table| table.name == item.kind)
}

/// Returns the edit that sets the name in code of a thing with a wire key.
fn code_name(
    index: &Index,
    (table, entry): (&'static Table, Entry<'_>),
    new: &str,
) -> Option<(Span, String)> {
    let (node, name) = (entry.value, COMMON.name.name);
    let file = index.trees().sources().get(entry.key.span().file)?;
    if let Some(old) = COMMON.name.of(node) {
        return Some((old.span(), new.to_owned()));
    }
    let pair = format!("{name}: {new}");
    if node.as_mapping().is_none() {
        let long = longhand(index, file, node, &pair)?;
        return Some((node.span(), long));
    }
    let mut forms = FIELD_FORMS.iter();
    let form = forms.find(|(mark, _)| node.entry(mark).is_some());
    let table = match form {
        Some((_, form)) if table.name == Field::TABLE.name => *form,
        _ => table,
    };
    let rank = |key: &str| table.keys.iter().position(|known| known.name == key);
    let before = node
        .entries()
        .filter(|entry| rank(entry.name()) < rank(name));
    let is_flow = file.text.get(node.span().start..)?.starts_with('{');
    let first = node.entries().next()?;
    Some(match before.last() {
        Some(last) if is_flow => (after(last.span()), format!(", {pair}")),
        None if is_flow => (before_key(first), format!("{pair}, ")),
        Some(last) => {
            let span = last.span();
            let line = file.last_line(span);
            let (_, end) = file.lines(line, line)?;
            let indent = indent(file, last.key.span());
            let newline = file.newline();
            (
                Span::point(span.file, end),
                format!("{newline}{indent}{pair}"),
            )
        }
        None => {
            let indent = indent(file, first.key.span());
            (
                before_key(first),
                format!("{pair}{}{indent}", file.newline()),
            )
        }
    })
}

/// Returns the long form of a field in its short form. The short form has no key for a name and takes its text from its type.
fn longhand(index: &Index, file: &SourceFile, node: Node<'_>, pair: &str) -> Option<String> {
    let span = node.span();
    let short = file.text.get(span.start..span.end)?;
    let named = short.trim_matches(['[', ']', '?', ' ', '"', '\'']);
    let places = index.definitions();
    let mut named = places.named(named);
    let (_, place) = named.find(|(item, _)| item.is_type())?;
    let (title, _) = described(index.trees(), place)?;
    let in_quotes = short.contains(['?', '[']) && !short.starts_with(['"', '\'', '[']);
    let ty = if in_quotes {
        format!("\"{short}\"")
    } else {
        short.to_owned()
    };
    let (zh, en) = (yaml_scalar(&title.zh), yaml_scalar(&title.en));
    Some(format!(
        "{{ {}: {ty}, {pair}, {}: {zh}, {}: {en} }}",
        FIELD.r#type.name, TEXT.zh.name, TEXT.en.name
    ))
}

fn after(span: Span) -> Span {
    Span::point(span.file, span.end)
}

fn before_key(entry: Entry<'_>) -> Span {
    let span = entry.key.span();
    Span::point(span.file, span.start)
}

/// Returns blanks as wide as the text before a key on its line.
fn indent(file: &SourceFile, key: Span) -> String {
    " ".repeat(file.before(key.start).chars().count())
}
