//! Makers of lines and blocks at the wrong depth, and of wrong dashes.

use super::{Maker, maker};
use crate::slips_made::change::Change;
use crate::slips_made::place::{At, Form};

pub const MAKERS: &[Maker] = &[
    maker("a line one blank less", |at| {
        line(at).then(|| at.shifted(-1)).flatten()
    }),
    maker("a line one blank more", |at| {
        line(at).then(|| at.shifted(1)).flatten()
    }),
    maker("a line a level deeper", |at| {
        line(at).then(|| at.shifted(2)).flatten()
    }),
    maker("a line a level higher", |at| {
        // These keys have no meaning a level higher.
        (line(at) && matches!(at.name(), "effect" | "code" | "as" | "enum" | "state"))
            .then(|| at.shifted(-2))
            .flatten()
    }),
    maker("a block one blank less", |at| {
        block(at).then(|| at.shifted(-1)).flatten()
    }),
    maker("a block one blank more", |at| {
        block(at).then(|| at.shifted(1)).flatten()
    }),
    maker("a block a level deeper", |at| {
        block(at).then(|| at.shifted(2)).flatten()
    }),
    maker("a block a level higher", |at| {
        (block(at) && at.parent().is_some_and(At::is_operation))
            .then(|| at.shifted(-2))
            .flatten()
    }),
    maker("an operation a level deeper", |at| {
        (at.is_operation() && at.before().is_some())
            .then(|| at.shifted(2))
            .flatten()
    }),
    maker("an operation a level higher", |at| {
        at.is_operation().then(|| at.shifted(-2)).flatten()
    }),
    maker("the fields of `data` beside it", |at| {
        let data = at.name() == "data" && at.parent().is_some_and(At::is_body);
        let first = at
            .children()
            .next()
            .filter(|first| data && first.is_row())?;
        let lines = first.lines().start..at.lines().end;
        let moved = at.whole()[lines.clone()].replace("\n  ", "\n");
        let moved = moved.strip_prefix("  ")?.to_owned();
        Some(Change::new(at.file, lines, moved).or(at))
    }),
    maker("what stands below a key at its depth", |at| {
        let first = at
            .children()
            .next()
            .filter(|first| block(at) && first.is_row())?;
        let lines = first.lines().start..at.lines().end;
        let by = first.indent() - at.indent();
        let moved: String = at.whole()[lines.clone()]
            .split_inclusive('\n')
            .map(|line| {
                line.get(by..)
                    .filter(|_| line.starts_with("  "))
                    .unwrap_or(line)
            })
            .collect();
        let names = [
            "request_state",
            "response_state",
            "aliases",
            "source",
            "request",
        ];
        names
            .contains(&at.name())
            .then(|| Change::new(at.file, lines, moved).or(at))
    }),
    maker("no dash before an item", |at| {
        let dash = dash(at)?;
        Some(Change::new(at.file, dash..dash + 2, "").on_its_lines())
    }),
    maker("blanks for the dash of an item", |at| {
        let dash = dash(at)?;
        Some(Change::new(at.file, dash..dash + 1, " ").on_its_lines())
    }),
    maker("no blank behind a dash", |at| {
        let dash = dash(at)?;
        Some(Change::new(at.file, dash + 1..dash + 2, "").on_its_lines())
    }),
    maker("a dash before a key of an item", |at| {
        let item = at
            .parent()
            .filter(|item| item.name().is_empty() && !at.flow && at.is_word())?;
        let is_first = item
            .children()
            .next()
            .is_some_and(|first| first.index == at.index);
        // The keys after the dash become a second item.
        (!is_first && at.is_row()).then(|| {
            let dash = at.key.start - 2..at.key.start - 1;
            Change::new(at.file, dash, "-")
                .on_its_lines()
                .or_value(item)
        })
    }),
    maker("a dash before a key of an operation", |at| {
        at.parent()
            .filter(|operation| operation.is_operation() && at.is_scalar())?;
        Some(at.insert(at.key.start, "- ").on_its_lines())
    }),
    maker("a text of many lines without its `|`", |at| {
        let is_block = at.form == Form::Block && at.written().starts_with('|');
        let text = at.written().to_owned();
        // Without `|`, most texts are still one string. A text with a colon is not.
        (is_block && text.contains(": ")).then(|| {
            Change::new(at.file, at.value.start..at.value.start + 1, "")
                .or(at)
                .or_value(at)
        })
    }),
    maker("a text of many lines at the depth of its key", |at| {
        let is_block = at.form == Form::Block && at.is_row();
        let first = at.written().find('\n').filter(|_| is_block)? + at.value.start + 1;
        let end = at.whole()[first..].find('\n')? + first;
        let text = at.whole()[first..end].trim_start();
        Some(
            Change::new(
                at.file,
                first..end,
                format!("{}{text}", " ".repeat(at.indent())),
            )
            .on_its_lines()
            .or(at),
        )
    }),
];

/// Returns `true` for a key of the language that begins a line and has a scalar.
fn line(at: At<'_>) -> bool {
    at.is_word() && at.is_row() && at.is_scalar() && at.path.len() > 2
}

/// Returns `true` for a key of the language that has a block below it.
fn block(at: At<'_>) -> bool {
    at.is_word()
        && at.is_row()
        && at.path.len() > 2
        && at.form == Form::Map
        && at.written().contains('\n')
}

/// Returns the position of the dash before an item that is a mapping.
fn dash(at: At<'_>) -> Option<usize> {
    let is_item = at.name().is_empty() && !at.flow && at.form == Form::Map;
    at.children().nth(1).filter(|_| is_item)?;
    let before = at.whole().get(..at.value.start)?;
    before.ends_with("- ").then(|| before.len() - 2)
}
