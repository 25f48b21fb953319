//! Detects entries in the wrong section and list items that are split in two.

use super::keys::{article, looks_like};
use crate::diagnostic::{Diagnostic, FaultCode};
use crate::language::grammar::{Command, Enum, FILE, Kind, OneOf, Report, Stream, Struct, Table};
use crate::syntax::{Entry, Node};
use crate::text;

/// Returns the table of an operation or type that is in a section of another kind.
pub(super) fn misplaced(value: &Kind, node: Node<'_>) -> Option<&'static Table> {
    let homes: Vec<&Table> = match value {
        Kind::Map(table) => vec![table],
        Kind::ByKey { tables, .. } => tables.iter().map(|(_, table)| *table).collect(),
        _ => return None,
    };
    let is_home = |table: &Table| homes.iter().any(|home| home.name == table.name);
    // Only entries of operations and types can be recognized by their keys.
    let is_known = SECTIONS.iter().any(|(_, table)| is_home(table));
    let table = looks_like(node).filter(|table| is_known && !is_home(table))?;
    // One foreign key is a misspelling, unless the entry also lacks several required keys.
    let is_stranger = |home: &&Table| {
        let foreign = node
            .entries()
            .filter(|entry| home.key(entry.name()).is_none());
        let required = home.keys.iter().filter(|key| key.required);
        let lacking = required.filter(|key| node.entry(key.name).is_none());
        match foreign.count() {
            0 => false,
            1 => lacking.count() > 1,
            _ => true,
        }
    };
    homes.iter().all(is_stranger).then_some(table)
}

/// The sections of operations and types, and the table of each.
pub(super) const SECTIONS: [(&str, &Table); 6] = [
    (FILE.commands.name, Command::TABLE),
    (FILE.reports.name, Report::TABLE),
    (FILE.streams.name, Stream::TABLE),
    (FILE.types.name, Enum::TABLE),
    (FILE.types.name, OneOf::TABLE),
    (FILE.types.name, Struct::TABLE),
];

/// Returns the section for entries of this table.
pub(super) fn section_of(table: &Table) -> &'static str {
    let section = SECTIONS.iter().find(|(_, home)| home.name == table.name);
    section.map_or("", |(section, _)| section)
}

/// Returns the error for misplaced entries: the first, its table, and the number of further ones.
pub(super) fn misplaced_entry((entry, table, more): (Entry<'_>, &Table, usize)) -> Diagnostic {
    let name = entry.name();
    let message = text!(
        "`{name}` 的键是“{kind}”的键，而这里不能写“{kind}”",
        "`{name}` has the keys of {kind}, which is not allowed here",
        kind = article(table)
    );
    let section = section_of(table);
    let fault = Diagnostic::error(FaultCode::MisplacedEntry, entry.key.span(), message);
    let fault = fault.note(text!(
        "写在 `{section}:` 之下；检查上面是否缺少这一行",
        "write it under `{section}:`; check whether that line is missing above it"
    ));
    match more {
        0 => fault,
        _ => fault.note(text!(
            "下面另有 {more} 处也是如此",
            "{more} more below it are the same"
        )),
    }
}

/// Returns `true` if two items of a list each have exactly the keys that the other lacks.
pub(super) fn is_split(of: &Kind, first: Node<'_>, second: Node<'_>) -> bool {
    let Kind::Map(table) = of else { return false };
    let lacks = |item: Node<'_>| -> Vec<&str> {
        let required = table.keys.iter().filter(|key| key.required);
        let names = required.map(|key| key.name);
        names.filter(|name| item.entry(name).is_none()).collect()
    };
    let has = |item: Node<'_>, names: &[&str]| names.iter().all(|name| item.entry(name).is_some());
    let is_apart = first
        .entries()
        .all(|entry| second.entry(entry.name()).is_none());
    let (first_lacks, second_lacks) = (lacks(first), lacks(second));
    let has_keys = |item: Node<'_>| item.entries().next().is_some();
    let is_cut = !first_lacks.is_empty() && has_keys(first) && has_keys(second);
    is_cut && is_apart && has(second, &first_lacks) && has(first, &second_lacks)
}
