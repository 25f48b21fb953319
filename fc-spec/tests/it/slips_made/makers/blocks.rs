//! Makers of blocks in the wrong place, or without their first line.

use super::{Maker, maker};
use crate::slips_made::change::Change;
use crate::slips_made::place::{At, Form};

pub const MAKERS: &[Maker] = &[
    maker("a command pasted below `types`", |at| {
        let types = at
            .spec
            .each()
            .find(|other| other.is("types") && other.file == at.file)?;
        at.is_in("commands")
            .then(|| paste(at, "get_more", types))
            .flatten()
    }),
    maker("a type pasted below `commands`", |at| {
        let commands = at
            .spec
            .each()
            .find(|other| other.is("commands") && other.file == at.file)?;
        at.is_in("types")
            .then(|| paste(at, "MoreOfIt", commands))
            .flatten()
    }),
    maker("a report pasted below `commands`", |at| {
        let commands = at
            .spec
            .each()
            .find(|other| other.is("commands") && other.file == at.file)?;
        at.is_in("reports")
            .then(|| paste(at, "something_new", commands))
            .flatten()
    }),
    maker("a field beside the keys of a field", |at| {
        let type_ = at.is("type") && at.is_type() && at.is_row();
        let field = "extra: { type: i64, example: 1, zh: 另一个, en: Another }\n";
        type_.then(|| {
            at.insert(
                at.lines().end,
                format!("{}{field}", " ".repeat(at.indent())),
            )
        })
    }),
    maker("a field directly below an operation", |at| {
        let body = at.is("request") || at.is("response");
        let field = "extra: { type: i64, example: 1, zh: 另一个, en: Another }\n";
        (body && at.is_row() && at.parent().is_some_and(At::is_operation)).then(|| {
            at.insert(
                at.lines().start,
                format!("{}{field}", " ".repeat(at.indent())),
            )
        })
    }),
    maker("`types:` gone", |at| header(at, "types")),
    maker("`commands:` gone", |at| header(at, "commands")),
    maker("`reports:` gone", |at| header(at, "reports")),
    maker("`group` gone", |at| {
        let next = at
            .behind()
            .filter(|_| at.is("group") && at.path.len() == 1)?;
        Some(at.removed().or(next))
    }),
    maker("`commands` in a file of types", |at| {
        let is_types = at.is("types") && !at.spec.files[at.file].0.contains("commands/");
        let command = "commands:\n  get_more:\n    code: unassigned\n    zh: 更多\n    en: More\n    effect: read\n    source: { sections: [] }\n\n";
        is_types.then(|| at.insert(at.lines().start, command))
    }),
    maker("`limits` in a second file", |at| {
        let limits = at.spec.each().find(|other| other.path == ["limits"])?;
        let text = limits.whole()[limits.lines()].to_owned();
        (at.is("types") && at.file != limits.file)
            .then(|| at.insert(at.lines().start, format!("{text}\n")).or(limits))
    }),
    maker("the name of an operation gone", |at| {
        (at.is_operation() && at.before().is_some())
            .then(|| {
                let line = at.line();
                Change::new(at.file, line.start..line.end + 1, "")
                    .or(at.children().next()?)
                    .into()
            })
            .flatten()
    }),
    maker("the name of a type gone", |at| {
        let first = at
            .children()
            .next()
            .filter(|_| at.is_in("types") && at.before().is_some())?;
        let line = at.line();
        let users = at
            .spec
            .each()
            .filter(|other| other.is_type() && other.written().contains(at.name()));
        Some(users.fold(
            Change::new(at.file, line.start..line.end + 1, "").or(first),
            Change::or_value,
        ))
    }),
    maker("the key of a field gone", |at| {
        let first = at.children().next().filter(|first| first.is_row())?;
        at.parent()
            .filter(|body| body.is_body() && at.before().is_some() && at.form == Form::Map)?;
        let line = at.line();
        Some(Change::new(at.file, line.start..line.end + 1, "").or(first))
    }),
    maker("`values:` gone", |at| {
        let first = at
            .children()
            .next()
            .filter(|_| at.is("values") && at.is_row())?;
        let line = at.line();
        Some(Change::new(at.file, line.start..line.end + 1, "").or(first))
    }),
    maker("`response:` gone", |at| {
        let first = at
            .children()
            .next()
            .filter(|_| at.is("response") && at.is_row() && at.path[0] == "commands")?;
        // After a `request` block, the keys would become part of the request.
        at.before().filter(|before| before.form != Form::Map)?;
        let line = at.line();
        Some(Change::new(at.file, line.start..line.end + 1, "").or(first))
    }),
];

/// Inserts a copy of the entry at the start of a section, with another name and without its code.
fn paste(at: At<'_>, name: &str, section: At<'_>) -> Option<Change> {
    let first = section.children().next()?;
    let text = &at.whole()[at.lines()];
    let line = text.find('\n')?;
    let code = at.child("code").map_or("", At::written);
    let body = text[line..].trim_end().replace(code.trim(), "unassigned");
    let body = if code.is_empty() {
        text[line..].trim_end().to_owned()
    } else {
        body
    };
    Some(at_section(section, first, format!("  {name}:{body}\n\n")))
}

fn at_section(section: At<'_>, first: At<'_>, text: String) -> Change {
    section.insert(first.line().start, text)
}

/// Removes the line of a top-level key.
fn header(at: At<'_>, name: &str) -> Option<Change> {
    let first = at
        .children()
        .next()
        .filter(|_| at.is(name) && at.path.len() == 1 && at.before().is_some())?;
    let line = at.line();
    Some(Change::new(at.file, line.start..line.end + 1, "").or(first))
}
