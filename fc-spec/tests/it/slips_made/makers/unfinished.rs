//! Makers of unfinished edits.

use super::{Maker, maker};
use crate::slips_made::change::Change;
use crate::slips_made::place::Form;

pub const MAKERS: &[Maker] = &[
    maker("a key without its value", |at| {
        let keys = [
            "code", "effect", "since", "as", "source", "enum", "zh", "en",
        ];
        (keys.contains(&at.name()) && at.is_word() && at.is_row() && at.path.len() > 2)
            .then(|| Change::new(at.file, at.key.end + 1..at.value.end, "").or(at))
    }),
    maker("`type:` without its value", |at| {
        (at.is("type") && at.is_row())
            .then(|| Change::new(at.file, at.key.end + 1..at.value.end, " ").or(at))
    }),
    maker("a key in brackets without its value", |at| {
        (at.is_word() && at.flow && at.is_scalar() && !at.is("example"))
            .then(|| Change::new(at.file, at.key.end + 1..at.value.end, "").or(at))
    }),
    maker("a row in brackets cut in the middle", |at| {
        let row = at
            .parent()
            .filter(|row| !row.flow && row.form == Form::Map && at.is_word())?;
        (at.flow && at.before().is_some() && row.name() != "-")
            .then(|| Change::new(at.file, at.value.end..row.value.end, "").on_its_lines())
    }),
    maker("a key cut in the middle", |at| {
        let half = at.key.start + at.name().len() / 2;
        (at.is_word() && at.is_row() && at.is_scalar() && at.name().len() > 3 && at.path.len() > 2)
            .then(|| Change::new(at.file, half..at.value.end, "").on_its_lines())
    }),
    maker("a file cut behind a key", |at| {
        let is_open =
            at.is_row() && at.path.len() > 2 && at.form == Form::Map && at.written().contains('\n');
        is_open.then(|| Change::new(at.file, at.key.end + 1..at.whole().len(), "\n").or(at))
    }),
    maker("a file cut in a row in brackets", |at| {
        let is_open = at.flow && at.is_word() && at.is_scalar() && at.before().is_some();
        let row = at.parent().filter(|row| is_open && row.is_row())?;
        Some(
            Change::new(at.file, at.value.end..at.whole().len(), "\n")
                .on_its_lines()
                .or_value(row),
        )
    }),
    maker("a file cut in a quoted text", |at| {
        let is_quoted = at.written().starts_with('"') && at.is_row() && at.written().len() > 10;
        is_quoted.then(|| {
            let half =
                (at.value.start + 5..at.value.end).find(|byte| at.whole().is_char_boundary(*byte));
            half.map(|half| Change::new(at.file, half..at.whole().len(), "\n").on_its_lines())
        })?
    }),
    maker("a file cut in a key", |at| {
        let is_word = at.is_row() && at.path.len() > 2 && at.is_word() && at.name().len() > 3;
        is_word
            .then(|| Change::new(at.file, at.key.start + 2..at.whole().len(), "\n").on_its_lines())
    }),
    maker("an operation of which only the name is there", |at| {
        at.is_operation()
            .then(|| at.insert(at.lines().start, "  do_something_new:\n"))
    }),
    maker("an operation without a body of its own", |at| {
        at.is_operation()
            .then(|| at.insert(at.lines().start, "  do_something_new: {}\n"))
    }),
    maker("a field of which only the key is there", |at| {
        let body = at.parent().filter(|body| body.is_body() && at.is_row())?;
        (!body.flow).then(|| {
            at.insert(
                at.lines().start,
                format!("{}extra:\n", " ".repeat(at.indent())),
            )
        })
    }),
    maker("a field without a type", |at| {
        let body = at.parent().filter(|body| body.is_body() && at.is_row())?;
        let text = "extra: { zh: 另一个, en: Another }\n";
        (!body.flow).then(|| {
            at.insert(
                at.lines().start,
                format!("{}{text}", " ".repeat(at.indent())),
            )
        })
    }),
    maker("an enum value of which only the number is there", |at| {
        let values = at
            .parent()
            .filter(|values| values.is("values") && at.is_row())?;
        (!values.flow).then(|| {
            at.insert(
                at.lines().start,
                format!("{}99:\n", " ".repeat(at.indent())),
            )
        })
    }),
    maker("an item of which only the dash is there", |at| {
        let answers = at
            .parent()
            .filter(|answers| answers.is("answers") && at.form == Form::Map)?;
        let dash = at.line().start;
        (!answers.flow && at.whole()[dash..].trim_start().starts_with('-')).then(|| {
            at.insert(
                dash,
                format!("{}-\n", " ".repeat(at.value.start - dash - 2)),
            )
        })
    }),
    maker("a word on a line of its own", |at| {
        (at.is("since") && at.is_row()).then(|| {
            at.insert(
                at.lines().start,
                format!("{}asdf\n", " ".repeat(at.indent())),
            )
            .on_its_lines()
        })
    }),
    maker("something behind a row in brackets", |at| {
        let row = at.is_row() && at.written().starts_with('{') && !at.written().contains('\n');
        row.then(|| at.insert(at.value.end, " x").on_its_lines())
    }),
    maker("something behind a quoted text", |at| {
        let row = at.is_row() && at.written().starts_with('"') && at.is_scalar();
        row.then(|| at.insert(at.value.end, " x").on_its_lines())
    }),
    maker("a file without a word", |at| {
        let is_first = at.path.len() == 1 && at.before().is_none();
        (is_first && at.spec.files[at.file].0.contains("commands/"))
            .then(|| Change::new(at.file, 0..at.whole().len(), ""))
    }),
];
