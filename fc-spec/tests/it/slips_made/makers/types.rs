//! Makers of types that are misspelt, foreign or missing.

use super::{Maker, maker, swapped};
use crate::slips_made::change::Change;
use crate::slips_made::place::{At, Form};

/// The built-in types that the makers replace.
const BUILT_IN: &[&str] = &[
    "i64", "i32", "u8", "u16", "u32", "f64", "f32", "bool", "string",
];

pub const MAKERS: &[Maker] = &[
    maker("`uint8`", |at| foreign(at, "uint8")),
    maker("`int`", |at| foreign(at, "int")),
    maker("`str`", |at| foreign(at, "str")),
    maker("`boolean`", |at| foreign(at, "boolean")),
    maker("`float`", |at| foreign(at, "float")),
    maker("`long`", |at| foreign(at, "long")),
    maker("`uint8` of an enum", |at| {
        (at.is("enum") && at.written() == "u8").then(|| at.set("uint8"))
    }),
    maker("a built-in type in upper case", |at| {
        let base = base(at).filter(|base| BUILT_IN.contains(base))?;
        Some(at.set(at.written().replacen(base, &base.to_uppercase(), 1)))
    }),
    maker("a declared type in lower case", |at| {
        let base = declared(at)?;
        let lower = base[..1].to_lowercase() + &base[1..];
        Some(at.set(at.written().replacen(base, &lower, 1)))
    }),
    maker("a declared type misspelt", |at| {
        let base = declared(at)?;
        Some(at.set(at.written().replacen(base, &swapped(base)?, 1)))
    }),
    maker("a type that does not exist", |at| {
        let base = declared(at)?;
        let others = at
            .spec
            .each()
            .filter(|other| declared(*other) == Some(base));
        // An unused type is another error, so one use must remain.
        (others.count() > 1).then(|| at.set(at.written().replacen(base, "NoSuchThing", 1)))
    }),
    maker("`T[]` for a list", |at| {
        list(at, |item| format!("{item}[]"))
    }),
    maker("`list<T>`", |at| list(at, |item| format!("list<{item}>"))),
    maker("a `?` before the type", |at| {
        let base = base(at)?;
        (at.form == Form::Plain && at.written() == format!("{base}?"))
            .then(|| at.set(format!("\"?{base}\"")))
    }),
    maker("a blank before the `?`", |at| {
        let base = base(at)?;
        (at.form == Form::Plain && at.written() == format!("{base}?"))
            .then(|| at.set(format!("{base} ?")))
    }),
    maker("a type that is gone while it is used", |at| {
        let users = users(at)?;
        Some(users.into_iter().fold(at.removed(), Change::or_value))
    }),
    maker("a type that was renamed where it is declared", |at| {
        let users = users(at)?;
        let renamed = at.rename(format!("{}Kind", at.name()));
        Some(users.into_iter().fold(renamed, Change::or_value))
    }),
    maker("a type with a name in snake_case", |at| {
        let users = users(at)?;
        let renamed = at.rename(at.name().to_lowercase());
        Some(users.into_iter().fold(renamed, Change::or_value))
    }),
    maker("an enum without its type", |at| {
        let ty = at
            .parent()
            .filter(|ty| at.is("enum") && ty.is_in("types"))?;
        Some(at.removed().or(ty).or(at.behind()?))
    }),
];

/// Returns the name in a type, such as `string` in `string?`.
fn base(at: At<'_>) -> Option<&str> {
    let name = at.written().trim_matches(['"', '?', '[', ']']);
    (at.is_type() && name.chars().all(|c| c.is_ascii_alphanumeric())).then_some(name)
}

fn foreign(at: At<'_>, new: &str) -> Option<Change> {
    let base = base(at).filter(|base| BUILT_IN.contains(base))?;
    Some(at.set(at.written().replacen(base, new, 1)))
}

/// Returns the name of the declared type of a field.
fn declared(at: At<'_>) -> Option<&str> {
    base(at).filter(|base| base.starts_with(|first: char| first.is_ascii_uppercase()))
}

/// Returns the places that name a declared type.
fn users(at: At<'_>) -> Option<Vec<At<'_>>> {
    let name = at.is_in("types").then(|| at.name())?;
    let users: Vec<_> = at
        .spec
        .each()
        .filter(|other| {
            declared(*other) == Some(name) || (in_list(*other) && other.written() == name)
        })
        .collect();
    (!users.is_empty()).then_some(users)
}

fn in_list(at: At<'_>) -> bool {
    at.parent()
        .is_some_and(|list| list.is("type") && list.form == Form::List)
}

fn list(at: At<'_>, make: impl Fn(&str) -> String) -> Option<Change> {
    let item = at
        .children()
        .next()
        .filter(|_| at.is("type") && at.form == Form::List)?;
    Some(at.set(make(item.written())))
}
