//! Makers of keys that are misspelt, wrong, repeated or missing.

use super::{Maker, capital, maker, swapped};
use crate::slips_made::change::Change;
use crate::slips_made::place::{At, Form};

pub const MAKERS: &[Maker] = &[
    maker("two letters of a key swapped", |at| {
        let word = swapped(at.name()).filter(|_| at.is_word() && at.path.len() > 1)?;
        Some(at.rename(word))
    }),
    maker("two letters of a top key swapped", |at| {
        let word = swapped(at.name()).filter(|_| at.is_word() && at.path.len() == 1)?;
        Some(at.rename(word))
    }),
    maker("the last letter of a key missing", |at| {
        let name = at.name();
        (at.is_word() && name.len() > 3 && at.path.len() > 1)
            .then(|| at.rename(&name[..name.len() - 1]))
    }),
    maker("a key with a capital letter", |at| {
        let word = capital(at.name()).filter(|_| at.is_word() && at.path.len() > 1)?;
        Some(at.rename(word))
    }),
    maker("`responce`", |at| {
        at.is("response").then(|| at.rename("responce"))
    }),
    maker("`description` for `about`", |at| {
        (at.is("about") && at.parent().is_some_and(At::is_operation))
            .then(|| at.rename("description"))
    }),
    maker("`cn` for `zh`", |at| {
        (at.is("zh") && at.is_scalar()).then(|| at.rename("cn"))
    }),
    maker("`type` misspelt in a row", |at| {
        (at.is("type") && at.is_type() && at.flow).then(|| at.rename("tpye"))
    }),
    maker("a key of the language twice", |at| {
        (at.is_word() && at.is_row() && at.is_scalar())
            .then(|| twice(at))
            .flatten()
    }),
    maker("a wire key twice", |at| {
        at.parent().filter(|body| body.is_body() && at.is_row())?;
        twice(at)
    }),
    maker("`zh` missing in a row", |at| missing(at, "zh", true)),
    maker("`en` missing in a row", |at| missing(at, "en", true)),
    maker("`zh` missing in a block", |at| missing(at, "zh", false)),
    maker("`en` missing in a block", |at| missing(at, "en", false)),
    maker("`code` missing", |at| missing(at, "code", false)),
    maker("`effect` missing", |at| missing(at, "effect", false)),
    maker("`source` missing", |at| missing(at, "source", false)),
    maker("`type` missing in a row", |at| {
        at.is_type().then(|| missing(at, "type", true)).flatten()
    }),
    maker("`name` of an enum value missing", |at| {
        at.parent()?.parent().filter(|values| values.is("values"))?;
        missing(at, "name", true)
    }),
    maker("`values` missing", |at| missing(at, "values", false)),
    maker("`as` of an answer missing", |at| {
        let item = at
            .parent()
            .filter(|item| item.name().is_empty() && at.is("as"))?;
        Some(at.removed().or(item).or_value(item))
    }),
    maker("a key of another kind of operation", |at| {
        let effect = at.is("effect") && at.is_row() && at.is_scalar();
        effect.then(|| {
            at.insert(
                at.lines().end,
                format!("{}cadence: {{ every_ms: 1000 }}\n", " ".repeat(at.indent())),
            )
        })
    }),
    maker("a key nobody knows", |at| {
        (at.is("since") && at.is_row()).then(|| {
            at.insert(
                at.lines().end,
                format!("{}priority: high\n", " ".repeat(at.indent())),
            )
        })
    }),
];

/// Repeats the entry after itself.
fn twice(at: At<'_>) -> Option<Change> {
    let lines = at.lines();
    let text = &at.whole()[lines.clone()];
    text.ends_with('\n')
        .then(|| at.insert(lines.end, text).on_its_lines())
}

/// Removes a required key. The error may be at its parent, or where the key was.
fn missing(at: At<'_>, key: &str, flow: bool) -> Option<Change> {
    let parent = at.parent().filter(|_| at.is(key) && at.flow == flow)?;
    let optional = ["about", "note", "aliases", "deprecated"];
    let is_optional = optional.contains(&parent.name()) && key != "zh" && key != "en";
    let is_scalar = at.form != Form::List && !is_optional && parent.name() != "aliases";
    // The texts of a body's `data` have a default.
    let may_be_bare = parent.name() == "data" && parent.parent().is_some_and(At::is_body);
    // The first key of an item shares its line with the dash.
    let movable = at.flow || at.is_row();
    (is_scalar && !may_be_bare && movable).then(|| at.removed().or(parent).or_value(parent))
}
