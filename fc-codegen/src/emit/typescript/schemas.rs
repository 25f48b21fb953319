//! Schemas of one group's types: a constant for each, which the compiler checks against the type.

use super::constants::{constant, number};
use super::context::{Context, imported, is_large, is_safe, own};
use super::group::Group;
use super::layout::{Layout, Members};
use super::source::{head, named};
use crate::package::items::{Item, Shape, Spelled};
use crate::package::language::Case;
use crate::package::marks::FieldMarks;
use crate::package::types::parts;
use crate::sample::Samples;
use fc_spec::model::{Argument, EnumType, EnumValue, Field, Scalar, Type, Value};

pub const ABOUT: [&str; 2] = [
    "消息类型的描述，运行库据此读写；编译器检查它与类型一致。",
    "Schemas of the message types for the reader and the writer. The compiler checks each against its type.",
];

pub fn file(context: &Context<'_>, _: &Samples<'_>, group: &Group<'_, '_>) -> String {
    let mut out = head(context, ABOUT);
    let items = group.items();
    let kinds = items.iter().map(|item| imported(context, kind(item)));
    named(&mut out, "import type", kinds, "../../../src/schema.ts");
    out.line("import * as messages from '../../messages.ts'");
    for (from, names) in context.imports(group.id, items.iter().flat_map(parts)) {
        named(&mut out, "import", names, &format!("../{from}/schemas.ts"));
    }
    for item in items {
        out.blank();
        let name = &item.ty.name;
        out.line(format!("/** {{@link messages.{name}}} */"));
        let kind = own(context, kind(item));
        let head = format!("export const {name}: {kind}<messages.{name}> = ");
        schema(context, item).write(&mut out, &head, "");
    }
    out.finish()
}

/// Returns the runtime's name for the kind of schema.
fn kind(item: &Item<'_>) -> &'static str {
    match item.shape {
        Shape::Record(..) => "Struct",
        Shape::Enum(..) => "Enum",
        Shape::Choice(..) => "Choice",
    }
}

fn schema(context: &Context<'_>, item: &Item<'_>) -> Layout {
    let name = &*item.ty.name;
    let is = |word| {
        Members::default()
            .with("is", Layout::text(word))
            .with("name", Layout::text(name))
    };
    let members = match &item.shape {
        Shape::Record(_, fields) => {
            let schemas = fields.iter();
            let schemas = schemas.map(|it| (&*it.name, field(context, fields, it)));
            is("struct").with("fields", Layout::lines(schemas))
        }
        Shape::Enum(shape, values) => is("enum")
            .with("repr", Layout::text(shape.repr.name()))
            .with("closed", Layout::flag(shape.closed))
            .with("values", Layout::path(["messages", name]))
            .with("process", process(name, shape, values)),
        Shape::Choice(_, variants) => {
            let form = |ty| Layout::word(format!("() => {}", context.name_of(ty)));
            let forms = variants.iter().map(|it| (&*it.name, form(&it.of.ty)));
            is("choice").with("forms", Layout::lines(forms))
        }
    };
    members.object()
}

/// Returns the rules for an enum's values as states, if the spec has any.
fn process(ty: &str, shape: &EnumType, values: &[Spelled<'_, EnumValue>]) -> Option<Layout> {
    let name = |value: &Spelled<'_, EnumValue>| Layout::path(["messages", ty, &value.name]);
    let some = |list: Vec<Layout>| (!list.is_empty()).then_some(Layout::List(list));
    let those = |is: fn(&EnumValue) -> bool| {
        let values = values.iter().filter(|value| is(value.of));
        some(values.map(name).collect())
    };
    let next = values.iter().filter(|value| !value.then.is_empty());
    let next = next.map(|value| {
        let follow = values
            .iter()
            .filter(|other| value.then.contains(&other.of.name));
        Layout::List(vec![name(value), Layout::list(follow.map(name))])
    });
    Members::default()
        .with("order", shape.order.map(|it| Layout::text(it.name())))
        .with("next", some(next.collect()))
        .with("final", those(|it| it.is_final))
        .with("error", those(|it| it.is_error))
        .some_object()
}

fn field(
    context: &Context<'_>,
    fields: &[Spelled<'_, Field>],
    field: &Spelled<'_, Field>,
) -> Layout {
    let details = field.details();
    let marks = FieldMarks::build(field.of, fields);
    let large = is_large(context, field);
    let held = |field: &Field, wire: &Scalar| {
        let value = context.package.value(field.ty.item(), &Value::from(wire));
        constant(context, &value, is_large(context, field))
    };
    let mut members = Members::default()
        .with("key", Layout::text(&field.wire))
        .with("type", type_schema(context, &field.ty))
        .with("optional", Layout::flag(field.optional))
        .with("safe", Layout::flag(is_safe(context, field)));
    for quirk in marks.quirks_in_order() {
        members = members.with(&Case::Camel.apply(quirk), Layout::flag(true));
    }
    members = members
        .with("sensitive", Layout::flag(field.sensitive))
        .with(
            "also",
            (!marks.also.is_empty()).then(|| Layout::texts(marks.also)),
        )
        .with("form", marks.form.map(Layout::text));
    for (name, argument) in &marks.constraints {
        let value = match argument {
            Argument::Number(value) => number(value, large),
            Argument::Range(least, most) => Layout::list([*least, *most].map(Layout::number)),
            Argument::Pattern(pattern) => Layout::text(pattern.portable()),
            Argument::Values(taken) => Layout::list(taken.iter().map(|it| held(field, it))),
        };
        members = members.with(&Case::Camel.apply(name), value);
    }
    let default = details.default.as_ref().map(|it| held(field, it));
    members = members.with("default", default);
    if let Some(condition) = marks.condition {
        let asked = condition.fields.into_iter();
        let asked = asked.map(|(asked, values)| {
            let values = values.iter().map(|it| held(asked, it));
            (&*asked.name, Layout::list(values))
        });
        members = members.with(condition.word, Layout::object(asked));
    }
    members.object()
}

/// Returns a type as a schema describes it.
pub fn type_schema(context: &Context<'_>, ty: &Type) -> Layout {
    match ty {
        Type::Array(item) => Layout::object([("list", type_schema(context, item))]),
        Type::Named(named) => Layout::word(format!("() => {}", context.name_of(named))),
        Type::Bool => Layout::text("bool"),
        Type::Int(kind) => Layout::text(kind.name()),
        Type::Float(kind) => Layout::text(kind.name()),
        Type::String => Layout::text("string"),
        // Signed milliseconds or seconds.
        Type::TimestampMs | Type::TimestampS => Layout::text("i64"),
        Type::Base64 => Layout::text("base64"),
        Type::Json => Layout::text("json"),
    }
}
