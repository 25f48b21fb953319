//! Mappings and lists in brackets on one line.

use super::{order, scalar};
use crate::language::Cursor;
use crate::syntax::{Node, NodeKind};

/// The maximum number of columns of a line with brackets.
const COLUMNS: usize = 160;

/// Returns `true` if a mapping or list is written in brackets. A list without brackets can start with an item in
/// brackets. Then both spans start at the same byte.
pub(super) fn is_flow(node: Node<'_>, text: &str) -> bool {
    let start = node.span().start;
    let rest = text.get(start..).unwrap_or_default();
    let first = node.items().next();
    rest.starts_with(['{', '[']) && first.is_none_or(|first| first.span().start > start)
}

/// Returns `true` if a node can be on one line of any length. Empty values and scalars over several lines cannot.
pub(super) fn may_close(node: Node<'_>, text: &str) -> bool {
    match node.kind() {
        NodeKind::Null | NodeKind::Scalar(_) => {
            let written = scalar::written(node, text);
            !written.is_empty() && !written.contains('\n')
        }
        NodeKind::Sequence(mut items) => items.all(|item| may_close(item, text)),
        NodeKind::Mapping(mut entries) => {
            entries.all(|entry| may_close(entry.key, text) && may_close(entry.value, text))
        }
    }
}

/// Returns `true` if a node may be on this line, after `before` columns. Values of the protocol are rows of a table,
/// and a list of scalars is one unit. They have no limit, because more lines would not make them clearer.
pub(super) fn fits(node: Node<'_>, cursor: Cursor, line: &str, before: usize) -> bool {
    let is_scalar = |item: Node<'_>| item.as_scalar().is_some() || item.is_null();
    cursor.is_free()
        || (node.as_sequence().is_some() && node.items().all(is_scalar))
        || before + columns(line) <= COLUMNS
}

/// Returns the width of a text in columns. A Chinese character has two.
pub(super) fn columns(text: &str) -> usize {
    let wide = |character: char| {
        matches!(
            character,
            '\u{1100}'..='\u{115f}'
                | '\u{2e80}'..='\u{a4cf}'
                | '\u{ac00}'..='\u{d7a3}'
                | '\u{f900}'..='\u{faff}'
                | '\u{fe30}'..='\u{fe6f}'
                | '\u{ff00}'..='\u{ff60}'
                | '\u{ffe0}'..='\u{ffe6}'
                | '\u{1f300}'..='\u{1faff}'
                | '\u{20000}'..='\u{3fffd}'
        )
    };
    text.chars()
        .map(|character| 1 + usize::from(wide(character)))
        .sum()
}

/// Returns a node on one line, with its declared keys in order.
pub(super) fn line(node: Node<'_>, cursor: Cursor, text: &str) -> String {
    match node.kind() {
        NodeKind::Null | NodeKind::Scalar(_) => scalar::short(node, text),
        NodeKind::Sequence(items) => {
            let items: Vec<_> = items
                .map(|item| line(item, cursor.item(item), text))
                .collect();
            format!("[{}]", items.join(", "))
        }
        NodeKind::Mapping(entries) => {
            let mut entries: Vec<_> = entries.collect();
            order::sort(&mut entries, cursor, |entry| Some(entry.key));
            let entries: Vec<_> = entries
                .into_iter()
                .map(|entry| {
                    let value = line(entry.value, cursor.under(entry.name(), entry.value), text);
                    format!("{}: {value}", scalar::short(entry.key, text))
                })
                .collect();
            if entries.is_empty() {
                "{}".to_owned()
            } else {
                format!("{{ {} }}", entries.join(", "))
            }
        }
    }
}
