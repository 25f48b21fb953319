//! Sorts keys, and opens brackets that do not fit on one line.

use super::block::{Block, Row, Value, opened};
use super::comments::Line;
use super::{flow, scalar};
use crate::diagnostic::Faults;
use crate::language::Cursor;
use crate::load::check_keys;
use crate::source::SourceFile;
use crate::syntax::Node;

/// The columns per level.
pub(super) const LEVEL: usize = 2;

/// Reports every key that the language does not have.
pub(super) fn check(node: Node<'_>, cursor: Cursor, faults: &mut Faults) {
    check_keys(cursor, node, faults);
    for entry in node.entries() {
        check(entry.value, cursor.under(entry.name(), entry.value), faults);
    }
    for item in node.items() {
        check(item, cursor.item(item), faults);
    }
}

/// Sorts items by the order of their keys in the grammar, if the grammar declares the keys.
pub(super) fn sort<'t, T>(things: &mut [T], cursor: Cursor, key: impl Fn(&T) -> Option<Node<'t>>) {
    if cursor.is_declared() {
        things.sort_by_key(|thing| {
            let name = key(thing).and_then(Node::as_str);
            name.and_then(|name| cursor.rank(name))
                .unwrap_or(usize::MAX)
        });
    }
}

/// Sorts the rows of a mapping or list at column `indent`, and opens brackets that do not fit.
pub(super) fn arrange<'t>(
    block: &mut Block<'t>,
    cursor: Cursor,
    indent: usize,
    file: &'t SourceFile,
) {
    let text = &file.text;
    sort(&mut block.rows, cursor, |row| row.key);
    for row in &mut block.rows {
        let within = |value| match row.key.and_then(Node::as_str) {
            Some(name) => cursor.under(name, value),
            None => cursor.item(value),
        };
        if let Value::Flow(node) = row.value {
            let key = row.key.map(|key| scalar::short(key, text));
            let before = indent + key.map_or(0, |key| flow::columns(&key)) + LEVEL;
            let line = flow::line(node, within(node), text);
            if flow::fits(node, within(node), &line, before) {
                continue;
            }
            row.value = Value::Block(opened(node, file));
        }
        if let Value::Block(value) = &mut row.value {
            arrange(value, within(value.node), indent + LEVEL, file);
            if row.key.is_none() {
                share_line(row);
            }
        }
    }
}

/// Moves the comments of an item's first row above the item, because both share the line of the dash.
fn share_line(item: &mut Row<'_>) {
    if let Some(behind) = item.behind.take() {
        item.above.push(Line {
            text: behind,
            blank: false,
        });
    }
    let Value::Block(value) = &mut item.value else {
        return;
    };
    let Some(first) = value.rows.first_mut() else {
        return;
    };
    let mut lines = std::mem::take(&mut first.above);
    if let Some(line) = lines.first_mut() {
        line.blank = item.blank || (line.blank && !item.above.is_empty());
        item.blank = first.blank;
        item.above.append(&mut lines);
    }
    first.blank = false;
}

/// Takes the comments about the whole file from its first row. These are the comments above the last blank line,
/// otherwise the line for editors.
pub(super) fn head<'t>(root: &mut Block<'t>) -> Head<'t> {
    let Some(first) = root.rows.first_mut() else {
        return Head::default();
    };
    let lines = &mut first.above;
    let below_blank = lines.iter().rposition(|line| line.blank);
    let (count, has_gap) = match below_blank {
        _ if first.blank => (lines.len(), true),
        Some(last) => (last, true),
        None => {
            let of_editors = |line: &Line<'_>| line.text.starts_with("# yaml-language-server:");
            (usize::from(lines.first().is_some_and(of_editors)), false)
        }
    };
    first.blank &= lines.is_empty();
    let rest = lines.split_off(count);
    let mut lines = std::mem::replace(lines, rest);
    if let Some(line) = first.above.first_mut() {
        line.blank = false;
    }
    if let Some(line) = lines.first_mut() {
        line.blank = false;
    }
    Head { lines, has_gap }
}

/// The comments at the head of a file.
#[derive(Debug, Default)]
pub(super) struct Head<'t> {
    pub lines: Vec<Line<'t>>,
    /// `true` if a blank line follows.
    pub has_gap: bool,
}
