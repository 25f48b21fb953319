//! Enums, and the attributes of their values.

use super::context::Context;
use super::literal::{literal, number};
use super::source::Source;
use crate::package::about;
use crate::package::facts;
use crate::package::items::{Item, Spelled};
use crate::package::joined::Joined;
use crate::package::name::free;
use crate::package::process::next_values;
use fc_spec::model::{EnumRepr, EnumType, EnumValue, Scalar};

/// Writes an enum and its values.
pub fn enumeration(
    out: &mut Source,
    context: &Context<'_>,
    item: &Item<'_>,
    shape: &EnumType,
    values: &[Spelled<'_, EnumValue>],
) {
    out.docs(&about::enumeration(context, item.ty.of, |_| ()));
    let (repr, rust) = match shape.repr {
        EnumRepr::Int(kind) => (kind.name(), kind.name()),
        EnumRepr::String => ("str", "String"),
    };
    let copy = shape.closed || shape.repr != EnumRepr::String;
    let mut derives = vec!["Clone"];
    derives.extend(copy.then_some("Copy"));
    derives.extend(["Debug", "PartialEq", "Eq", "Hash", "OpenEnum"]);
    out.list("#[derive(", &derives, ")]");
    match shape.order {
        Some(order) => out.line(format!(
            "#[fc(repr = {repr}, order = {})]",
            literal(order.name())
        )),
        None => out.line(format!("#[fc(repr = {repr})]")),
    }
    out.block(format!("pub enum {}", item.ty.name), |out| {
        for value in values {
            let docs = facts::value_docs(value);
            out.documented(&docs);
            out.attribute("#[fc(", &value_attributes(value, values), ")]");
            out.line(format!("{},", value.name));
        }
        if !shape.closed {
            let other = other_name(|name| values.iter().any(|value| value.name == name));
            other_variant(out, &other, ["值", "value"], rust);
        }
    });
}

/// Returns the name of the variant for other values, which is not taken.
pub fn other_name(is_taken: impl Fn(&str) -> bool) -> String {
    free(&["Unknown", "Other", "Unlisted"], is_taken)
}

/// Writes the variant for other values. `zh` and `en` are the word for a value.
pub fn other_variant(out: &mut Source, name: &str, [zh, en]: [&str; 2], repr: &str) {
    let values = [("zh", zh), ("en", en), ("other", name), ("repr", repr)];
    out.template("other", &values);
}

/// Returns the derive attributes of a value.
fn value_attributes(
    value: &Spelled<'_, EnumValue>,
    values: &[Spelled<'_, EnumValue>],
) -> Vec<String> {
    let mut items = vec![format!("value = {}", enum_wire(&value.wire))];
    let then = next_values(value, values)
        .map(|next| &next.name)
        .joined(", ");
    if !then.is_empty() {
        items.push(format!("then({then})"));
    }
    items.extend(value.is_final.then(|| "final".to_owned()));
    items.extend(value.is_error.then(|| "error".to_owned()));
    items
}

/// Returns an enum value in the syntax of attributes.
pub fn enum_wire(wire: &Scalar) -> String {
    match wire {
        Scalar::Number(value) => number(value),
        Scalar::String(text) => literal(text),
        Scalar::Bool(value) => value.to_string(),
    }
}
