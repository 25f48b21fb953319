//! Checks values that may have one of several forms.

use super::Shape;
use super::expected::{describe_either, wrong_kind};
use crate::diagnostic::{Diagnostic, FaultCode, nearest};
use crate::language::grammar::{FIELD, FIELD_FORMS, Kind, TEXT, Table};
use crate::language::scalar;
use crate::source::Span;
use crate::syntax::{Entry, Node};
use crate::text;

impl Shape<'_> {
    /// Checks the node against the most likely alternative: an exact match, otherwise a similar word, otherwise the
    /// first candidate.
    pub(super) fn either(&mut self, kinds: &[Kind], node: Node<'_>, at: Span) {
        let candidates: Vec<_> = kinds.iter().filter(|kind| kind.could_be(node)).collect();
        let chosen = candidates
            .iter()
            .find(|kind| fits(kind, node))
            .or_else(|| candidates.iter().find(|kind| is_nearly(kind, node)))
            .or(candidates.first());
        if let Some(kind) = chosen {
            self.kind(kind, node, at);
        } else {
            wrong_kind(&describe_either(kinds), node, at, self.faults);
        }
    }

    pub(super) fn by_key(
        &mut self,
        tables: &'static [(&'static str, &'static Table)],
        otherwise: &Kind,
        node: Node<'_>,
        at: Span,
    ) {
        let entries = node.entries().filter(|entry| entry.value.is_null());
        let slips: Vec<_> = entries.filter_map(|entry| entry.key.slip()).collect();
        if !slips.is_empty() && tables.iter().all(|(mark, _)| node.entry(mark).is_none()) {
            self.faults.extend(slips);
            return;
        }
        let mut marks = tables
            .iter()
            .filter_map(|(mark, table)| Some((node.entry(mark)?, *table)));
        let Some((first, table)) = marks.next() else {
            return match likely(tables, otherwise, node) {
                Some(table) => self.map(table, node, at),
                None => self.kind(otherwise, node, at),
            };
        };
        if let Some(marker) = misread_marker(node) {
            self.faults.hide(node.span());
            let name = marker.name();
            let message = text!(
                "`{name}` 是字段完整写法的开头，所以不会当作报文中的键名",
                "`{name}` starts the long form of a field, so it is not read as a wire key"
            );
            let remedy = text!(
                "把外层对象写成 `{{ fields: {{ {name}: … }} }}`；`fields:` 之下都是报文中的键名",
                "write the enclosing object as `{{ fields: {{ {name}: … }} }}`; below `fields:` every key is a wire key"
            );
            let fault = Diagnostic::error(FaultCode::MarkerAsKey, marker.key.span(), message);
            self.faults.push(fault.note(remedy));
            return;
        }
        if let Some((second, _)) = marks.next() {
            self.faults.hide(node.span());
            let message = text!(
                "`{first}` 和 `{second}` 不能同时使用",
                "`{first}` and `{second}` cannot be combined",
                first = first.name(),
                second = second.name()
            );
            let fault = Diagnostic::error(FaultCode::TwoForms, second.key.span(), message);
            self.faults.push(fault.also(
                first.key.span(),
                text!("这里已经定义了字段", "this already defines the field"),
            ));
            return;
        }
        self.map(table, node, at);
    }
}

/// Returns `true` if a scalar is exactly a value of the kind.
fn fits(kind: &Kind, node: Node<'_>) -> bool {
    match kind.form() {
        Kind::Code => scalar::code(node).is_some(),
        Kind::Int { .. } => scalar::int(node).is_some(),
        words @ Kind::Word(_) => node.as_str().is_some_and(|it| words.word(it).is_some()),
        _ => true,
    }
}

/// Returns `true` if a scalar is similar to one of the kind's words.
fn is_nearly(kind: &Kind, node: Node<'_>) -> bool {
    match (kind, node.as_str()) {
        (Kind::Word(words), Some(text)) => {
            nearest(text, words.iter().map(|(word, ..)| *word)).is_some()
        }
        _ => false,
    }
}

/// Returns the likely table of a mapping that lacks the deciding key, judged by its other keys.
fn likely(
    tables: &'static [(&'static str, &'static Table)],
    otherwise: &Kind,
    node: Node<'_>,
) -> Option<&'static Table> {
    let knows = |table: &Table| {
        node.entries()
            .all(|entry| table.key(entry.name()).is_some())
    };
    if let Kind::Body = otherwise {
        let marks = tables.iter().map(|(mark, _)| *mark);
        let near = node
            .entries()
            .find_map(|entry| nearest(entry.name(), marks.clone()));
        let table = tables.iter().find(|(mark, _)| near == Some(*mark));
        let table = table.or(tables.first()).map(|(_, table)| *table);
        return table.filter(|_| lacks_form(node));
    }
    let is_otherwise = match otherwise {
        Kind::Map(table) => knows(table),
        _ => false,
    };
    let mut fitting = tables
        .iter()
        .map(|(_, table)| *table)
        .filter(|table| knows(table));
    fitting
        .next()
        .filter(|_| !is_otherwise && node.entries().count() > 0)
}

/// Returns `true` for a field with the text of the long form but without a key that marks its form. Its keys are not
/// wire keys.
pub(in crate::load) fn lacks_form(node: Node<'_>) -> bool {
    marker(node).is_none() && has_text(node)
}

/// Returns the key that marks the long form of a field, and the table of the form.
pub(in crate::load) fn marker(node: Node<'_>) -> Option<(Entry<'_>, &'static Table)> {
    let mut forms = FIELD_FORMS.into_iter();
    forms.find_map(|(mark, table)| Some((node.entry(mark)?, table)))
}

/// Returns `true` if the node has a text that is not a type, like the long form of a field.
fn has_text(node: Node<'_>) -> bool {
    let text = TEXT.zh.of(node).or(TEXT.en.of(node));
    text.is_some_and(|text| text.as_scalar().is_some() && scalar::field_type(text).is_none())
}

/// Returns the key of a field that marks a long form, but most likely is a wire key.
pub(in crate::load) fn misread_marker(node: Node<'_>) -> Option<Entry<'_>> {
    if has_text(node) {
        return None;
    }
    let (mark, table) = marker(node)?;
    let is_misread = if mark.name() == FIELD.r#type.name {
        mark.value.as_mapping().is_some()
    } else {
        let ty = FIELD.r#type.of(mark.value);
        let text = TEXT.zh.of(mark.value).or(TEXT.en.of(mark.value));
        ty.is_some_and(|ty| ty.as_mapping().is_none()) && text.is_some()
    };
    // Only keys of the long form may follow the marker, but these are fields.
    let has_fields_beside = node
        .entries()
        .any(|entry| table.key(entry.name()).is_none() && marker(entry.value).is_some());
    (is_misread || has_fields_beside).then_some(mark)
}
