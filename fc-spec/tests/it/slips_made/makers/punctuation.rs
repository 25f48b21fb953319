//! Makers of punctuation that is missing, doubled, full-width or invisible.

use super::{Maker, maker};
use crate::slips_made::change::Change;
use crate::slips_made::place::{At, Form};

pub const MAKERS: &[Maker] = &[
    maker("no colon behind a key with a value", |at| {
        (row(at) && at.is_scalar()).then(|| at.between(" ").on_its_lines())
    }),
    maker("no colon behind a key with a block", |at| {
        let is_block = row(at) && at.form == Form::Map && !at.written().starts_with('{');
        is_block.then(|| Change::new(at.file, at.key.end..at.key.end + 1, "").on_its_lines())
    }),
    maker("no colon in brackets", |at| {
        (at.flow && at.is_word() && at.is_scalar()).then(|| at.between(" ").or(at))
    }),
    maker("no blank behind a colon", |at| {
        (row(at) && at.form == Form::Plain).then(|| at.between(":").or(at))
    }),
    maker("no blank behind a colon in brackets", |at| {
        (at.flow && at.is_word() && at.form == Form::Plain).then(|| at.between(":").or(at))
    }),
    maker("a full-width colon", |at| {
        (row(at) && at.is_scalar()).then(|| at.between("：").or(at))
    }),
    maker("a full-width colon and a blank", |at| {
        (row(at) && at.is_scalar()).then(|| at.between("： ").or(at))
    }),
    maker("a full-width colon in brackets", |at| {
        (at.flow && at.is_word() && at.is_scalar()).then(|| at.between("：").or(at))
    }),
    maker("a full-width colon before a block", |at| {
        let is_block = row(at) && at.form == Form::Map && !at.written().starts_with('{');
        is_block.then(|| Change::new(at.file, at.key.end..at.key.end + 1, "：").or(at))
    }),
    maker("a full-width comma in brackets", |at| comma(at, "，")),
    maker("a semicolon in brackets", |at| comma(at, "; ")),
    maker("no comma in brackets", |at| comma(at, " ")),
    maker("two commas in brackets", |at| comma(at, ", , ")),
    maker("full-width braces", |at| {
        braces(at).then(|| brackets(at, "｛", "｝").on_its_lines())
    }),
    maker("a full-width brace at the end", |at| {
        braces(at).then(|| brackets(at, "{", "｝").on_its_lines())
    }),
    maker("a brace that is not closed", |at| {
        braces(at).then(|| brackets(at, "{", "").on_its_lines())
    }),
    maker("a brace that is not opened", |at| {
        braces(at).then(|| brackets(at, "", "}").on_its_lines())
    }),
    maker("a brace closed by a bracket", |at| {
        braces(at).then(|| brackets(at, "{", "]").on_its_lines())
    }),
    maker("a brace too many", |at| {
        braces(at).then(|| brackets(at, "{", "}}").on_its_lines())
    }),
    maker("a bracket that is not closed", |at| {
        square(at).then(|| brackets(at, "[", "").on_its_lines())
    }),
    maker("a bracket too many", |at| {
        square(at).then(|| brackets(at, "[", "]]").on_its_lines())
    }),
    maker("full-width brackets", |at| {
        square(at).then(|| brackets(at, "【", "】").on_its_lines())
    }),
    maker("typographic quotes", |at| quotes(at, "“", "”")),
    maker("full-width quotes", |at| quotes(at, "＂", "＂")),
    maker("a quote that is not closed", |at| {
        quotes(at, "\"", "").map(Change::on_its_lines)
    }),
    maker("a quote that is not opened", |at| {
        (at.written().starts_with('"') && row(at)).then(|| brackets(at, "", "\"").on_its_lines())
    }),
    maker("no quotes around a text with a colon", |at| {
        let has_colon = at.written().starts_with('"') && at.written().contains(": ");
        (has_colon && row(at)).then(|| brackets(at, "", "").on_its_lines())
    }),
    maker("a quote inside quotes", |at| {
        let is_quoted = at.written().starts_with('"') && at.is_word() && at.is_scalar();
        let middle = at.written().find(' ').filter(|_| is_quoted)? + at.value.start;
        Some(at.insert(middle, " \"word\"").or_value(at))
    }),
    maker("a backslash in a quoted text", |at| {
        let is_quoted = at.written().starts_with('"') && at.is_word() && at.is_scalar();
        let middle = at.written().find(' ').filter(|_| is_quoted)? + at.value.start;
        Some(at.insert(middle, " C:\\data").or_value(at))
    }),
    maker("a comma in an unquoted text in brackets", |at| {
        let is_text = at.flow && (at.is("zh") || at.is("en")) && at.form == Form::Plain;
        let middle = at.written().find(' ').filter(|_| is_text)? + at.value.start;
        Some(at.insert(middle, ", perhaps,").or_value(at))
    }),
    maker("a colon in an unquoted text", |at| {
        let is_text = row(at) && (at.is("zh") || at.is("en")) && at.form == Form::Plain;
        let middle = at.written().find(' ').filter(|_| is_text)? + at.value.start;
        Some(at.insert(middle, ":").or_value(at))
    }),
    maker("a text that goes on behind ` #`", |at| {
        let is_text = at.flow && (at.is("zh") || at.is("en")) && at.form == Form::Plain;
        let middle = at.written().find(' ').filter(|_| is_text)? + at.value.start;
        Some(at.insert(middle, " #1").or_value(at))
    }),
    maker("a text that begins with a backtick", |at| {
        (at.is("en") && at.form == Form::Plain)
            .then(|| at.insert(at.value.start, "`msgId` ").or_value(at))
    }),
    maker("a text that begins with a star", |at| {
        (at.is("en") && at.form == Form::Plain).then(|| at.insert(at.value.start, "*").or_value(at))
    }),
    maker("a comma behind a value", |at| {
        (row(at)
            && at.form == Form::Plain
            && matches!(at.name(), "effect" | "code" | "since" | "as"))
        .then(|| at.insert(at.value.end, ",").or_value(at))
    }),
    maker("a full stop behind a value", |at| {
        (row(at)
            && at.form == Form::Plain
            && matches!(at.name(), "effect" | "code" | "since" | "as"))
        .then(|| at.insert(at.value.end, "。").or_value(at))
    }),
    maker("an equals sign for a colon", |at| {
        (row(at) && at.form == Form::Plain).then(|| at.between(" = ").on_its_lines())
    }),
    maker("a no-break space behind a colon", |at| {
        (row(at) && at.form == Form::Plain && !at.is("zh") && !at.is("en"))
            .then(|| at.between(":\u{a0}").on_its_lines())
    }),
    maker("a no-break space in the indentation", |at| {
        indentation(at, "\u{a0}")
    }),
    maker("a full-width space in the indentation", |at| {
        indentation(at, "\u{3000}")
    }),
    maker("a tab in the indentation", |at| indentation(at, "\t")),
    maker("a zero-width space in a key", |at| {
        at.is_word()
            .then(|| at.insert(at.key.start + 1, "\u{200b}").or(at))
    }),
    maker("a byte order mark in the middle", |at| {
        at.is_operation()
            .then(|| at.insert(at.line().start, "\u{feff}").or(at))
    }),
    maker("a comment without its mark", |at| {
        let before = at.whole()[..at.line().start]
            .strip_suffix('\n')
            .filter(|_| at.path.len() == 1)?;
        let mark = before.rfind("\n# ").map(|at| at + 1)?;
        let is_alone = !before[mark..].contains("\n\n") || before[mark..].ends_with('\n');
        is_alone.then(|| Change::new(at.file, mark..mark + 2, "").on_its_lines())
    }),
];

/// Returns `true` for a key of the language that begins a line.
fn row(at: At<'_>) -> bool {
    at.is_word() && at.is_row() && at.path.len() > 1
}

fn comma(at: At<'_>, new: &str) -> Option<Change> {
    let next = at
        .behind()
        .filter(|_| at.flow && at.is_word() && at.is_scalar())?;
    (!next.key.is_empty()).then(|| {
        Change::new(at.file, at.value.end..next.key.start, new)
            .or_value(at)
            .or(next)
    })
}

fn braces(at: At<'_>) -> bool {
    !at.flow && at.written().starts_with('{') && !at.written().contains('\n')
}

fn square(at: At<'_>) -> bool {
    !at.flow && at.written().starts_with('[') && !at.written().contains('\n')
}

/// Replaces the marks at both ends of the value.
fn brackets(at: At<'_>, open: &str, close: &str) -> Change {
    let first = at.value.start..at.value.start + 1;
    Change::new(at.file, first, open).and(at.value.end - 1..at.value.end, close)
}

fn quotes(at: At<'_>, open: &str, close: &str) -> Option<Change> {
    let is_quoted = at.form == Form::Quoted && at.written().starts_with('"') && at.is_scalar();
    // An apostrophe or a backslash has another meaning in other quotes.
    let is_simple = is_quoted && at.is_word() && !at.written().contains(['\'', '\\']);
    is_simple.then(|| brackets(at, open, close).or_value(at))
}

fn indentation(at: At<'_>, blank: &str) -> Option<Change> {
    let line = at.line();
    (row(at) && at.indent() >= 2).then(|| {
        let end = line.start + at.indent();
        Change::new(at.file, end - 2..end, blank).or(at)
    })
}
