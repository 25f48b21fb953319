//! The message types of one group, and its methods on both sides as interfaces.
//!
//! The types are interfaces, choices, and enums with constants for their values. The file does not import the schemas,
//! because the schemas read the constants of enums when they load.

use super::constants::wire;
use super::context::{Context, field_type, imported, own, page_of, repr_is_large};
use super::group::Group;
use super::source::{Source, alternatives, literal, named, property, tag_text};
use super::{client, robot};
use crate::package::about;
use crate::package::conditions::sentence;
use crate::package::docs::Docs;
use crate::package::expr::Expr;
use crate::package::facts;
use crate::package::items::{Item, Shape, Spelled};
use crate::package::types::parts;
use crate::sample::Samples;
use fc_spec::model::{
    Deprecation, Direction, EnumRepr, EnumType, EnumValue, Field, Operation, Type, Variant,
};

pub const ABOUT: [&str; 2] = [
    "每组指令的消息，以及各组在 app 和机器人两侧的方法。",
    "The messages of each group, and its methods on the side of the app and of the robot.",
];

/// Generates `messages.ts` of a group: its message types, and its parts of the stubs.
pub fn file(context: &Context<'_>, _: &Samples<'_>, group: &Group<'_, '_>) -> String {
    let mut out = context.source();
    let mut docs = Docs::default();
    about::group(&mut docs, group.of);
    docs.raw("@module");
    out.docs(&docs);
    out.blank();
    let items = group.items();
    let mut names: Vec<&str> = Vec::new();
    let is_record = |item: &Item<'_>| matches!(item.shape, Shape::Record(..));
    let is_json = |field: &Spelled<'_, Field>| *field.ty.item() == Type::Json;
    let is_choice = |item: &Item<'_>| matches!(item.shape, Shape::Choice(..));
    names.extend(items.iter().any(is_record).then_some("Extra"));
    let mut fields = items.iter().flat_map(Item::fields);
    names.extend(fields.any(is_json).then_some("JsonText"));
    names.extend(items.iter().any(is_choice).then_some("Tagged"));
    names.extend(client::runtime_types(context, group));
    names.extend(robot::runtime_types(group));
    let names = names.iter().map(|name| imported(context, name));
    named(&mut out, "import type", names, "../../../src/runtime.ts");
    let types = items.iter().flat_map(parts).chain(group.bodies(context));
    for (from, names) in context.imports(group.id, types) {
        named(
            &mut out,
            "import type",
            names,
            &format!("../{from}/messages.ts"),
        );
    }
    let fields = items.iter().flat_map(Item::fields);
    let ids = fields.filter_map(|field| context.package.id_of(field));
    named(
        &mut out,
        "import type",
        ids.map(|id| &id.name),
        "../../ids.ts",
    );
    for item in items {
        out.blank();
        match &item.shape {
            Shape::Record(_, fields) => {
                structure(&mut out, context, item, fields);
                if let Some((command, Direction::Request)) = item.body_of() {
                    errors(&mut out, context, command);
                }
            }
            Shape::Enum(shape, values) => enumeration(&mut out, context, item, shape, values),
            Shape::Choice(_, variants) => choice(&mut out, context, item, variants),
        }
    }
    client::group(&mut out, context, group);
    robot::group(&mut out, context, group);
    out.finish()
}

/// Adds the deprecation for editors and compilers. It must be the last part of a comment.
pub fn deprecated(docs: &mut Docs<'_>, deprecation: Option<&Deprecation>) {
    if let Some(deprecation) = deprecation {
        let note = facts::withdrawn_note(deprecation);
        docs.raw(format!("@deprecated {}", tag_text(&note)));
    }
}

/// Ends the comment on an operation with its links and its deprecation.
pub fn end(docs: &mut Docs<'_>, context: &Context<'_>, operation: &Operation) {
    docs.paragraph(context.links(&operation.location, &page_of(operation)));
    deprecated(docs, operation.deprecated.as_ref());
}

fn structure(
    out: &mut Source,
    context: &Context<'_>,
    item: &Item<'_>,
    fields: &[Spelled<'_, Field>],
) {
    let mut docs = facts::item_docs(context, item);
    if let Some((operation, Direction::Request)) = item.body_of() {
        deprecated(&mut docs, operation.deprecated.as_ref());
    }
    out.docs(&docs);
    out.block(format!("export interface {}", item.ty.name), |out| {
        for field in fields {
            let condition = sentence(&context.package, field, fields, spelled);
            let mut docs = facts::field_docs(context.style, field, condition);
            deprecated(&mut docs, field.details().deprecated.as_ref());
            out.docs(&docs);
            let ty = field_type(context, field);
            out.line(property(&field.name, &ty, field.optional));
            out.blank();
        }
        out.template("extra", &[]);
        out.line(property("extra", &own(context, "Extra"), true));
    });
}

/// Returns a value as comments write it.
fn spelled(value: &Expr<'_>) -> String {
    match value {
        Expr::Value(item, value) => format!("{}.{}", item.ty.name, value.name),
        Expr::Bool(value) => value.to_string(),
        Expr::Int(value) => value.to_string(),
        Expr::Text(text) => literal(text),
        Expr::Unlisted(_, value) => spelled(value),
        _ => String::new(),
    }
}

fn enumeration(
    out: &mut Source,
    context: &Context<'_>,
    item: &Item<'_>,
    shape: &EnumType,
    values: &[Spelled<'_, EnumValue>],
) {
    let name = &item.ty.name;
    let mut docs = facts::type_docs(context, item);
    if !shape.closed {
        docs.raw_lines(["其他值原样保留。", "Any other value is kept unchanged."]);
    }
    out.docs(&docs);
    let open = match shape.repr {
        _ if shape.closed => None,
        EnumRepr::String => Some("(string & {})"),
        repr if repr_is_large(repr) => Some("(bigint & {})"),
        EnumRepr::Int(_) => Some("(number & {})"),
    };
    let known = values
        .iter()
        .map(|value| wire(&value.wire, shape.repr).flat());
    let known: Vec<String> = known.chain(open.map(str::to_owned)).collect();
    union(out, name, &known);
    out.blank();
    out.template("values", &[("name", name)]);
    out.enclose(&format!("export const {name} = {{"), "} as const", |out| {
        for value in values {
            let docs = facts::value_docs(value);
            out.blank();
            out.docs(&docs);
            wire(&value.wire, shape.repr).write(out, &format!("{}: ", value.name), ",");
        }
    });
}

/// Writes `export type Name = A | B`, on one line if it fits.
pub fn union(out: &mut Source, name: &str, alternatives: &[String]) {
    let head = format!("export type {name} =");
    let flat = alternatives.join(" | ");
    out.line_or([&head, " ", &flat], |out| {
        out.enclose(&head, "", |out| {
            for alternative in alternatives {
                out.line(["| ", alternative].concat());
            }
        });
    });
}

/// Writes the union of the errors that a command declares, next to its request.
fn errors(out: &mut Source, context: &Context<'_>, command: &Operation) {
    let package = &context.package;
    let Some(name) = package.error_type(command) else {
        return;
    };
    let docs = about::errors(context, command);
    out.blank();
    out.docs(&docs);
    let errors = package
        .errors(command)
        .map(|(error, result)| (about::error(error, result.of), literal(&result.name)));
    alternatives(out, name, &errors.collect::<Vec<_>>());
}

fn choice(
    out: &mut Source,
    context: &Context<'_>,
    item: &Item<'_>,
    variants: &[Spelled<'_, Variant>],
) {
    let mut docs = facts::type_docs(context, item);
    docs.raw_lines([
        "`case` 是形式的名称，`value` 是它的内容。",
        "`case` is the name of the form, and `value` its content.",
    ]);
    out.docs(&docs);
    let tagged = own(context, "Tagged");
    let variants = variants.iter().map(|variant| {
        let mut docs = Docs::titled(&variant.text);
        facts::variant_end(&mut docs, variant);
        deprecated(&mut docs, variant.deprecated.as_ref());
        let (case, ty) = (literal(&variant.name), context.name_of(&variant.of.ty));
        (docs, format!("{tagged}<{case}, {ty}>"))
    });
    alternatives(out, &item.ty.name, &variants.collect::<Vec<_>>());
}
