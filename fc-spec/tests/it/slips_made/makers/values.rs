//! Makers of values that are misspelt or of another kind.

use super::{Maker, maker, swapped};
use crate::slips_made::change::Change;
use crate::slips_made::place::{At, Form};

pub const MAKERS: &[Maker] = &[
    maker("an effect misspelt", |at| word(at, "effect", swapped)),
    maker("an effect that does not exist", |at| {
        word(at, "effect", |_| Some("write".into()))
    }),
    maker("`as` misspelt", |at| word(at, "as", swapped)),
    maker("`state` misspelt", |at| word(at, "state", swapped)),
    maker("a severity that does not exist", |at| {
        word(at, "severity", |_| Some("urgent".into()))
    }),
    maker("a role misspelt", |at| word(at, "role", swapped)),
    maker("a quirk misspelt", |at| {
        at.parent().filter(|list| list.is("quirk"))?;
        Some(at.set(swapped(at.written())?))
    }),
    maker("a unit misspelt", |at| {
        word(at, "unit", |unit| Some(format!("{unit}x")))
    }),
    maker("a unit written out", |at| {
        word(at, "unit", |unit| (unit == "m").then(|| "meter".into()))
    }),
    maker("an effect with a capital letter", |at| {
        word(at, "effect", super::capital)
    }),
    maker("a code without 0x", |at| {
        code(at, |code| code.replace("0x", ""))
    }),
    maker("a code in decimal", |at| {
        code(at, |code| {
            u16::from_str_radix(&code[2..], 16)
                .expect("a code")
                .to_string()
        })
    }),
    maker("a code with a letter that is no digit", |at| {
        code(at, |code| format!("{}G", &code[..5]))
    }),
    maker("a code in lower case", |at| {
        code(at, str::to_lowercase)
            .filter(|_| at.written().contains(['A', 'B', 'C', 'D', 'E', 'F']))
    }),
    maker("a code with three digits", |at| {
        code(at, |code| format!("0x{}", &code[3..]))
    }),
    maker("a code in quotes", |at| {
        code(at, |code| format!("\"{code}\""))
    }),
    maker("a code in octal", |at| code(at, |_| "0417".into())),
    maker("a date with slashes", |at| {
        date(at, |date| date.replace('-', "/"))
    }),
    maker("a month that does not exist", |at| {
        date(at, |_| "2023-13".into())
    }),
    maker("a date that begins with its month", |at| {
        date(at, |_| "05-2023".into())
    }),
    maker("an id of a conflict cut short", |at| {
        id(at, |id| format!("C{}", &id[2..]))
    }),
    maker("an id of a conflict in lower case", |at| {
        id(at, str::to_lowercase)
    }),
    maker("`yes` for `true`", |at| truth(at, "yes")),
    maker("`on` for `true`", |at| truth(at, "on")),
    maker("`True` for `true`", |at| truth(at, "True")),
    maker("`true` in quotes", |at| truth(at, "\"true\"")),
    maker("an octal number as example", |at| {
        number(at, |_| "017".into())
    }),
    maker("a number with an underscore", |at| {
        number(at, |_| "1_000".into())
    }),
    maker("a number in quotes as example", |at| {
        number(at, |number| format!("\"{number}\""))
    }),
    maker("a word for a number as example", |at| {
        number(at, |_| "abc".into())
    }),
    maker("a fraction for an integer as example", |at| {
        number(at, |_| "1.5".into())
    }),
    maker("a number for a text as example", |at| {
        example(at, "string").filter(|()| at.form == Form::Plain)?;
        Some(at.set("12"))
    }),
    maker("`on` for a text as example", |at| {
        example(at, "string").filter(|()| at.form == Form::Plain)?;
        Some(at.set("on"))
    }),
    maker("a number for a text", |at| text(at).then(|| at.set("123"))),
    maker("`yes` for a text", |at| text(at).then(|| at.set("yes"))),
    maker("an empty text", |at| text(at).then(|| at.set("\"\""))),
    maker("a list of one without its brackets", |at| {
        let one = at
            .children()
            .next()
            .filter(|_| at.form == Form::List && at.children().count() == 1)?;
        let words = at.is("ids") || at.is("sections") || at.is("lost") || at.is("sets_off");
        (words && at.written().starts_with('[')).then(|| at.set(one.written()))
    }),
    maker("brackets around a word", |at| {
        word(at, "effect", |effect| Some(format!("[{effect}]")))
    }),
    maker("a text where a mapping stands", |at| {
        (at.is("source") && at.form == Form::Map).then(|| at.set("section 3"))
    }),
    maker("`~` for a value", |at| {
        (at.is_word()
            && at.is_scalar()
            && ["code", "zh", "en", "effect", "as"].contains(&at.name()))
        .then(|| at.set("~").or(at))
    }),
];

fn word(at: At<'_>, key: &str, make: impl Fn(&str) -> Option<String>) -> Option<Change> {
    let is_plain = at.is(key) && at.form == Form::Plain;
    let new = is_plain.then(|| make(at.written())).flatten()?;
    Some(at.set(new))
}

fn code(at: At<'_>, make: impl Fn(&str) -> String) -> Option<Change> {
    let is_code = at.is("code") && at.is_scalar() && at.written().starts_with("0x");
    is_code.then(|| at.set(make(at.written())))
}

fn date(at: At<'_>, make: impl Fn(&str) -> String) -> Option<Change> {
    ((at.is("since") || at.is("date")) && at.is_scalar()).then(|| at.set(make(at.written())))
}

fn id(at: At<'_>, make: impl Fn(&str) -> String) -> Option<Change> {
    at.parent().filter(|ids| ids.is("ids"))?;
    // The conflict loses its answer, which is an error at its declaration.
    let conflict = at
        .spec
        .each()
        .find(|other| other.is_in("conflicts") && other.name() == at.written())?;
    Some(at.set(make(at.written())).or(conflict))
}

fn truth(at: At<'_>, new: &str) -> Option<Change> {
    (at.written() == "true" && at.is_word()).then(|| at.set(new))
}

/// Returns `Some` if the place is the example of a field of this type.
fn example(at: At<'_>, ty: &str) -> Option<()> {
    let field = at.parent().filter(|_| at.is("example") && at.is_scalar())?;
    let is_typed = field
        .child("type")
        .is_some_and(|found| found.written() == ty);
    (is_typed && field.child("wire").is_none()).then_some(())
}

fn number(at: At<'_>, make: impl Fn(&str) -> String) -> Option<Change> {
    ["i64", "i32", "u8", "u16", "u32"]
        .iter()
        .find_map(|ty| example(at, ty))?;
    Some(at.set(make(at.written())))
}

fn text(at: At<'_>) -> bool {
    (at.is("zh") || at.is("en")) && at.form == Form::Plain && at.is_scalar()
}
