//! Makers of failed merges, and of YAML features that the spec language does not have.

use super::{Maker, maker};
use crate::slips_made::change::Change;
use crate::slips_made::place::At;

pub const MAKERS: &[Maker] = &[
    maker("a conflict of two sides", |at| {
        around(at, "<<<<<<< HEAD\n", |text| {
            format!("=======\n{text}>>>>>>> feature\n")
        })
    }),
    maker("a conflict around an operation", |at| {
        let text = at.is_operation().then(|| &at.whole()[at.lines()])?;
        Some(Change::new(
            at.file,
            at.lines(),
            format!("<<<<<<< HEAD\n{text}=======\n>>>>>>> feature\n"),
        ))
    }),
    maker("the beginning of a conflict left", |at| {
        around(at, "<<<<<<< HEAD\n", |_| String::new())
    }),
    maker("the middle of a conflict left", |at| {
        around(at, "=======\n", |_| String::new())
    }),
    maker("the end of a conflict left", |at| {
        around(at, "", |_| ">>>>>>> feature\n".into())
    }),
    maker("one side of a conflict and its end left", |at| {
        around(at, "", |text| format!("=======\n{text}>>>>>>> feature\n"))
    }),
    maker("both sides kept", |at| around(at, "", ToOwned::to_owned)),
    maker("an operation twice", |at| {
        let text = at.is_operation().then(|| &at.whole()[at.lines()])?;
        Some(at.insert(at.lines().end, text.to_owned()))
    }),
    maker("a type twice", |at| {
        let text = at.is_in("types").then(|| &at.whole()[at.lines()])?;
        text.ends_with('\n')
            .then(|| at.insert(at.lines().end, text.to_owned()))
    }),
    maker("a type declared in another file too", |at| {
        let other = at
            .spec
            .each()
            .find(|other| other.is("types") && other.file != at.file)?;
        let first = other.children().next()?;
        let text = "    zh: 另一个\n    en: Another one\n    fields: {}\n";
        at.is_in("types").then(|| {
            other
                .insert(first.line().start, format!("  {}:\n{text}", at.name()))
                .or(at)
        })
    }),
    maker("an operation under another name with its code", |at| {
        let code = at
            .child("code")
            .filter(|code| at.is_in("commands") && code.written().starts_with("0x0A"))?;
        let indent = "    ";
        let new = format!(
            "  do_something_new:\n{indent}code: {}\n{indent}zh: 新的\n{indent}en: New one\n{indent}effect: read\n{indent}source: {{ sections: [] }}\n\n",
            code.written()
        );
        Some(at.insert(at.lines().start, new).or_value(code))
    }),
    maker("a patch pasted with its marks", |at| {
        let line = at.line();
        (at.is("effect") && at.is_row())
            .then(|| Change::new(at.file, line.start..line.start + 1, "+").on_its_lines())
    }),
    maker("a second document in the middle", |at| {
        (at.path.len() == 1 && at.before().is_some()).then(|| at.insert(at.line().start, "---\n"))
    }),
    maker("a second document between operations", |at| {
        (at.is_operation() && at.before().is_some())
            .then(|| at.insert(at.line().start, "---\n").or(at))
    }),
    maker("the end of a document in the middle", |at| {
        (at.path.len() == 1 && at.before().is_some())
            .then(|| at.insert(at.line().start, "...\n").or(at))
    }),
    maker("an anchor", |at| {
        (at.is("source") && at.is_row()).then(|| at.insert(at.value.start, "&source "))
    }),
    maker("an alias left", |at| {
        (at.is("source") && at.is_row()).then(|| at.set("*source"))
    }),
    maker("an alias left in brackets", |at| {
        (at.is_type() && at.flow && at.is_word()).then(|| at.set("*id"))
    }),
    maker("a merge key", |at| {
        at.parent()
            .filter(|operation| operation.is_operation() && at.is("effect"))?;
        Some(
            at.insert(
                at.line().start,
                format!("{}<<: *common\n", " ".repeat(at.indent())),
            )
            .on_its_lines(),
        )
    }),
    maker("a tag", |at| {
        (at.is("since") && at.is_row()).then(|| at.insert(at.value.start, "!!str "))
    }),
    maker("a directive", |at| {
        (at.path.len() == 1 && at.before().is_none()).then(|| at.insert(0, "%YAML 1.2\n---\n"))
    }),
];

/// Puts text before and after a line of an operation.
fn around(at: At<'_>, before: &str, behind: impl Fn(&str) -> String) -> Option<Change> {
    let row = at.is("effect") && at.is_row() && at.is_scalar();
    row.then(|| {
        let text = &at.whole()[at.lines()];
        Change::new(
            at.file,
            at.lines(),
            format!("{before}{text}{}", behind(text)),
        )
    })
}
