//! Makers of text that is well formed but wrong.

use super::{Maker, maker, swapped};
use crate::slips_made::place::{At, Form};

pub const MAKERS: &[Maker] = &[
    maker("the code of another command", |at| {
        let is_code = at.is("code") && at.path[0] == "commands" && at.written().starts_with("0x");
        let mut others = at.spec.each().filter(|other| {
            other.is("code")
                && other.path[0] == "commands"
                && other.file != at.file
                && other.written().starts_with("0x")
        });
        let other = others.next().filter(|_| is_code)?;
        Some(at.set(other.written()).or_value(other))
    }),
    maker("a code of no range", |at| {
        let is_code = at.is("code") && at.path.len() == 3 && at.written().starts_with("0x");
        is_code.then(|| at.set("0x0F01"))
    }),
    maker("an unknown report in `sets_off`", |at| {
        at.parent().filter(|list| list.is("sets_off"))?;
        Some(at.set(swapped(at.written())?))
    }),
    maker("an unknown entity", |at| {
        at.is("refers")
            .then(|| Some(at.set(swapped(at.written())?)))
            .flatten()
    }),
    maker("an unknown store", |at| {
        at.is("kept")
            .then(|| Some(at.set(swapped(at.written())?)))
            .flatten()
    }),
    maker("a result code that does not exist", |at| {
        (at.is("effect") && at.is_row()).then(|| {
            at.insert(
                at.lines().end,
                format!("{}errors: [987]\n", " ".repeat(at.indent())),
            )
        })
    }),
    maker("an example that is no value of the enum", |at| {
        let field = at.parent().filter(|_| at.is("example") && at.is_scalar())?;
        let ty = field.child("type")?.written();
        let declared = at
            .spec
            .each()
            .find(|other| other.is_in("types") && other.name() == ty)?;
        declared
            .child("enum")
            .filter(|repr| repr.written() == "u8")?;
        Some(at.set("77"))
    }),
    maker("an example beyond its type", |at| {
        let field = at.parent().filter(|_| at.is("example") && at.is_scalar())?;
        let ty = field.child("type")?.written();
        ["i32", "u8", "u16"]
            .contains(&ty)
            .then(|| at.set("99999999999"))
    }),
    maker("the smallest above the largest", |at| {
        let max = at.parent()?.child("max").filter(|_| at.is("min"))?;
        Some(
            at.set(format!("{}", max.written().parse::<i64>().ok()? + 1))
                .or_value(max),
        )
    }),
    maker("an example outside its bounds", |at| {
        let max = at.parent()?.child("max").filter(|_| at.is("example"))?;
        Some(at.set(format!("{}0", max.written())).or_value(max))
    }),
    maker("a name in camelCase", |at| {
        let (first, rest) = at.name().split_once('_').filter(|_| at.is_operation())?;
        let name = first.to_owned() + &super::capital(rest)?;
        Some(at.rename(name))
    }),
    maker("a number of an enum twice", |at| {
        let before = at.before().filter(|_| value(at) && at.parent().is_some())?;
        Some(at.rename(before.name()).or(before))
    }),
    maker("a name of an enum twice", |at| {
        let value = at
            .parent()
            .filter(|value| at.is("name") && self::value(*value))?;
        let before = value.before()?.child("name")?;
        // A `then` with the old name would be a second error.
        let is_led_to = value
            .parent()?
            .children()
            .any(|other| other.child("then").is_some());
        (!is_led_to).then(|| at.set(before.written()).or_value(before))
    }),
    maker("an unknown name in `then`", |at| {
        at.parent().filter(|list| list.is("then"))?;
        Some(at.set(swapped(at.written())?))
    }),
    maker("an unknown field in `when`", |at| {
        at.parent()
            .filter(|when| when.is("when") || when.is("unless"))?;
        Some(at.rename(swapped(at.name())?))
    }),
    maker("a unit on a text", |at| {
        let field = at
            .parent()
            .filter(|_| at.is("type") && at.is_type() && at.written() == "string")?;
        (at.flow && field.child("unit").is_none())
            .then(|| at.insert(at.value.end, ", min: 1").or(field))
    }),
    maker("a default on a required field", |at| {
        let is_required = at.is("type") && at.is_type() && at.flow && at.form == Form::Plain;
        (is_required && at.written() == "i64").then(|| at.insert(at.value.end, ", default: 1"))
    }),
    maker("a conflict that nobody declared", |at| {
        at.parent()
            .filter(|ids| ids.is("ids") && ids.children().count() == 1)?;
        let others = at
            .spec
            .each()
            .filter(|other| other.parent().is_some_and(|ids| ids.is("ids")));
        // If this is its only answer, the conflict has none, which is another error.
        (others
            .filter(|other| other.written() == at.written())
            .count()
            > 1)
        .then(|| at.set("C999"))
    }),
    maker("an answer gone", |at| {
        let answers = at
            .parent()
            .filter(|answers| answers.is("answers") && at.form == Form::Map)?;
        let ids = at
            .child("ids")
            .filter(|_| answers.children().count() > 1 && !at.flow)?;
        let line = at.line();
        let is_item = at.whole()[line.clone()].trim_start().starts_with("- ");
        let id = ids
            .children()
            .next()
            .filter(|_| is_item && ids.children().count() == 1)?;
        let mut others = at
            .spec
            .each()
            .filter(|other| other.parent().is_some_and(|ids| ids.is("ids")));
        let is_alone =
            !others.any(|other| other.index != id.index && other.written() == id.written());
        let conflict = at
            .spec
            .each()
            .find(|other| other.is_in("conflicts") && other.name() == id.written())?;
        is_alone.then(|| at.removed().or(conflict))
    }),
    maker("a section of the source twice lost", |at| {
        let sections = at.spec.each().find(|other| other.path == ["sections"])?;
        let one = at
            .parent()
            .filter(|list| list.is("sections") && list.path.len() > 1)?;
        let first = sections
            .children()
            .next()
            .filter(|_| one.form == Form::List)?;
        Some(
            sections
                .insert(
                    first.line().start,
                    format!("  {}: {{ zh: 丢失, en: Lost }}\n", at.written()),
                )
                .or_value(at),
        )
    }),
];

/// Returns `true` for a value of an enum.
fn value(at: At<'_>) -> bool {
    at.parent().is_some_and(|values| values.is("values"))
}
