//! The message types of one group: structs, enums and choices, with their derives.

use super::calls;
use super::conditions;
use super::constants::{ConstantScope, extra_name, spelled};
use super::context::Context;
use super::enums::{enum_wire, enumeration};
use super::literal::{literal, number};
use super::process;
use super::source::Source;
use crate::package::about;
use crate::package::conditions::sentence;
use crate::package::docs::Docs;
use crate::package::expr::Expr;
use crate::package::facts;
use crate::package::items::{Call, Item, Module, Shape, Spelled};
use crate::package::joined::Joined;
use crate::package::marks::FieldMarks;
use fc_spec::model::{Argument, Exchange, Field, Kind, Operation, Type, TypeRef, Value, Variant};
use std::collections::BTreeSet;

/// Generates a module of message types.
pub fn module(context: &Context<'_>, module: &Module<'_>) -> String {
    let mut body = context.source();
    let mut used = Used::default();
    for item in &module.items {
        body.blank();
        declaration(&mut body, &mut used, context, item);
    }
    calls::methods(&mut body, context, module);

    let mut out = context.source();
    let mut docs = Docs::default();
    about::group(&mut docs, module.group);
    out.inner_docs(&docs);
    out.blank();
    out.import("crate::ids", &used.ids.iter().collect::<Vec<_>>());
    for (from, names) in context.imports(&module.id, used.types.iter().copied()) {
        out.import(
            &format!("super::{from}"),
            &names.into_iter().collect::<Vec<_>>(),
        );
    }
    out.import("fc_derive", &used.derives.iter().collect::<Vec<_>>());
    out.import("fc_runtime", &used.runtime.iter().collect::<Vec<_>>());
    out.blank();
    out.append(&body);
    out.finish()
}

/// Returns one type as its module declares it.
pub fn item(context: &Context<'_>, item: &Item<'_>) -> String {
    let mut out = context.source();
    declaration(&mut out, &mut Used::default(), context, item);
    out.finish()
}

fn declaration<'m>(
    out: &mut Source,
    used: &mut Used<'m>,
    context: &'m Context<'_>,
    item: &'m Item<'_>,
) {
    match &item.shape {
        Shape::Record(_, fields) => {
            structure(out, used, context, item, fields);
            errors(out, used, context, item);
        }
        Shape::Enum(shape, values) => {
            used.derives.insert("OpenEnum");
            enumeration(out, context, item, shape, values);
        }
        Shape::Choice(_, variants) => choice(out, used, context, item, variants),
    }
}

/// The imports of a module.
#[derive(Default)]
struct Used<'m> {
    derives: BTreeSet<&'static str>,
    runtime: BTreeSet<&'static str>,
    types: BTreeSet<&'m TypeRef>,
    ids: BTreeSet<String>,
}

impl<'m> Used<'m> {
    fn ty(&mut self, ty: &'m Type) {
        match ty {
            Type::Base64 => {
                self.runtime.insert("Bytes64");
            }
            Type::Json => {
                self.runtime.insert("Json");
            }
            Type::Array(item) => self.ty(item),
            Type::Named(_) => self.types.extend(ty.innermost()),
            _ => {}
        }
    }
}

fn structure<'m>(
    out: &mut Source,
    used: &mut Used<'m>,
    context: &'m Context<'_>,
    item: &'m Item<'_>,
    fields: &'m [Spelled<'_, Field>],
) {
    let call = context.package.opened_by(item);
    out.docs(&facts::item_docs(context, item));
    let sensitive = fields.iter().any(|field| field.sensitive);
    let defaults = fields
        .iter()
        .all(|field| field.optional || matches!(field.ty, Type::Array(_)));

    let mut derives = vec!["Clone"];
    derives.push(if sensitive { "RedactedDebug" } else { "Debug" });
    if defaults {
        derives.push("Default");
    }
    derives.extend(["PartialEq", "Message", "New"]);
    if fields.iter().any(|field| field.details().default.is_some()) {
        derives.push("Defaults");
    }
    derives.extend(call.map(|call| match call.operation.kind() {
        Kind::Report => "Report",
        Kind::Command | Kind::Stream => "Command",
    }));
    used.derives
        .extend(derives.iter().filter(|name| OWN_DERIVES.contains(name)));
    used.runtime.insert("Extra");
    out.list("#[derive(", &derives, ")]");
    if let Some(Call { operation, .. }) = call {
        used.types.extend(process::types(context, operation));
        operation_attribute(out, context, operation);
        accepted_in(out, used, context, operation);
    }
    let example = context.example(item);
    if example != "{}" {
        out.attribute(
            "#[fc(",
            &[["example = ", &literal(&example)].concat()],
            ")]",
        );
    }

    // The struct may gain an optional key.
    out.line("#[non_exhaustive]");
    out.block(format!("pub struct {}", item.ty.name), |out| {
        for field in fields {
            used.ty(&field.ty);
            used.ids
                .extend(context.package.id_of(field).map(|id| id.name.to_string()));
            let condition = sentence(&context.package, field, fields, conditions::spelled);
            out.docs(&facts::field_docs(context.style, field, condition));
            let name = &field.name;
            let marks = FieldMarks::build(field.of, fields);
            let mut attributes = field_attributes(field, &marks);
            let condition = marks.condition.as_ref();
            attributes.extend(condition.map(|it| conditions::attribute(&context.package, it)));
            if let Some(default) = &field.details().default {
                let default = context.package.held(field, &Value::from(default));
                attributes.push(format!("default = {}", constant(&default)));
            }
            if !attributes.is_empty() {
                out.attribute("#[fc(", &attributes, ")]");
            }
            let rust = context.field_type(field);
            out.line(if field.optional {
                ["pub ", name, ": Option<", &rust, ">,"].concat()
            } else {
                ["pub ", name, ": ", &rust, ","].concat()
            });
            out.blank();
        }
        out.template("extra", &[("extra", &extra_name(fields))]);
    });
}

/// Returns a scalar as a constant expression. A string stays a literal.
pub fn constant(value: &Expr<'_>) -> String {
    match value {
        Expr::Text(text) => literal(text),
        value => spelled(value, ConstantScope::Package, 0),
    }
}

/// The derives that come from `fc_derive`.
const OWN_DERIVES: &[&str] = &[
    "Command",
    "Defaults",
    "Message",
    "New",
    "RedactedDebug",
    "Report",
];

/// Writes the attribute that ties a request to its code.
fn operation_attribute(out: &mut Source, context: &Context<'_>, operation: &Operation) {
    let mut items = vec![
        format!("code = {}", operation.code.spelling),
        format!("name = {}", literal(&operation.name)),
    ];
    match &operation.exchange {
        Exchange::Command {
            effect, messages, ..
        } => {
            items.push(format!("effect = \"{}\"", effect.name()));
            let response = context.name_of(&messages.response.ty);
            items.push(format!("response = {response}"));
            let error = context.package.error_type(operation);
            items.extend(error.map(|error| format!("error = {error}")));
            items.extend(process::sets_off(context, operation));
        }
        Exchange::Report { ack, .. } => {
            items.push(format!(
                "ack(timeout_ms = {}, retries = {})",
                ack.timeout_ms, ack.retries
            ));
            items.extend(process::stage(context, operation));
        }
        Exchange::Stream(_) => {}
    }
    out.attribute("#[fc(", &items, ")]");
}

/// Writes the derive attribute with the states in which a command is accepted.
fn accepted_in<'m>(
    out: &mut Source,
    used: &mut Used<'m>,
    context: &'m Context<'_>,
    command: &'m Operation,
) {
    let states = context.accepted_states(command);
    used.types.extend(states.iter().map(|states| states.ty));
    let sets = states.iter().map(|states| {
        let names = states.values.iter().map(|value| &*value.name);
        (&*states.item.ty.name, names.collect())
    });
    let sets: Vec<(&str, Vec<&str>)> = sets.collect();
    match sets.as_slice() {
        [] => {}
        [(ty, names)] => {
            out.attribute_words(&format!("#[fc(accepted_in({ty}("), names, ")))]");
        }
        sets => {
            let sets = sets.iter();
            let sets = sets.map(|(ty, names)| format!("{ty}({})", names.join(", ")));
            out.attribute("#[fc(accepted_in(", &sets.collect::<Vec<_>>(), "))]");
        }
    }
}

/// Returns the derive attributes of a field.
fn field_attributes(field: &Spelled<'_, Field>, marks: &FieldMarks<'_, '_>) -> Vec<String> {
    let mut items = Vec::new();
    if field.wire != field.name {
        items.push(["key = ", &literal(&field.wire)].concat());
    }
    items.extend(marks.form.map(|form| format!("wire = {}", literal(form))));
    let constraints = marks.constraints.iter();
    items.extend(constraints.map(|(name, argument)| match argument {
        Argument::Number(value) => format!("{name} = {}", number(value)),
        Argument::Range(least, most) if least == most => format!("{name} = {least}"),
        Argument::Range(least, most) => format!("{name} = {least}..={most}"),
        Argument::Pattern(pattern) => format!("{name} = {}", literal(pattern.portable())),
        Argument::Values(taken) => format!("{name}({})", taken.iter().map(enum_wire).joined(", ")),
    }));
    items.extend(marks.quirks.iter().map(|quirk| {
        let lenient = quirk.strip_prefix("lenient_");
        lenient.map_or_else(|| (*quirk).to_owned(), |of| format!("lenient({of})"))
    }));
    if !marks.also.is_empty() {
        let keys = marks.also.iter().map(|key| literal(key)).joined(", ");
        items.push(format!("also({keys})"));
    }
    if field.sensitive {
        items.push("sensitive".to_owned());
    }
    items
}

/// Writes the enum of the errors that a command declares, next to its request.
fn errors(out: &mut Source, used: &mut Used<'_>, context: &Context<'_>, item: &Item<'_>) {
    let package = &context.package;
    let Some((command, name)) = package.declared_by(item) else {
        return;
    };
    used.derives.insert("DeclaredError");
    let docs = about::errors(context, command);
    out.documented(&docs);
    out.line("#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, DeclaredError)]");
    out.block(format!("pub enum {name}"), |out| {
        for (error, result) in package.errors(command) {
            let text = literal(&result.text.zh);
            out.documented(&about::error(error, result.of));
            let items = [format!("code = {}", result.code), format!("text = {text}")];
            out.attribute("#[fc(", &items, ")]");
            out.line(format!("{},", result.name));
        }
    });
}

fn choice<'m>(
    out: &mut Source,
    used: &mut Used<'m>,
    context: &Context<'_>,
    item: &Item<'m>,
    variants: &'m [Spelled<'_, Variant>],
) {
    used.derives.insert("OneOf");
    out.docs(&facts::type_docs(context, item));
    out.line("#[derive(Clone, Debug, PartialEq, OneOf)]");
    out.block(format!("pub enum {}", item.ty.name), |out| {
        for variant in variants {
            used.types.insert(&*variant.of.ty);
            out.blank();
            let mut docs = Docs::titled(&variant.text);
            facts::variant_end(&mut docs, variant);
            out.docs(&docs);
            let ty = context.name_of(&variant.of.ty);
            out.line(format!("{}({ty}),", variant.name));
        }
    });
}
