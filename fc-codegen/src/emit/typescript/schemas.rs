//! What the runtime has to know of the types of one group: a constant for each, held to the type by the compiler.

use super::constants::{constant, number};
use super::context::{Context, imports, is_large, is_safe};
use super::source::{Layout, file, import, import_types};
use crate::emit::stub::docs::Docs;
use crate::sample::Samples;
use crate::surface::expr::Expressions;
use crate::surface::package::{Item, Module, Shape, Spelled};
use fc_spec::model::{
    Asked, Condition, Constraint, EnumRepr, EnumType, EnumValue, Field, Quirk, Scalar, Type, Value,
    WireForm,
};

/// A module of schemas.
pub fn module(context: &Context<'_>, samples: &Samples<'_>, module: &Module<'_>) -> String {
    let mut out = file();
    let mut docs = Docs::default();
    docs.raw("消息类型的描述，运行库据此读写；编译器检查它与类型一致。");
    docs.raw(
        "What reader and writer know of the message types; the compiler holds each to its type.",
    );
    docs.raw("@module");
    out.docs(&docs);
    out.blank();
    let mut kinds: Vec<&str> = module.items.iter().map(kind).collect();
    kinds.dedup();
    import_types(&mut out, &kinds, "../../src/schema.ts");
    out.line("import * as messages from '../messages/index.ts'");
    for (from, names) in imports(context, module) {
        import(
            &mut out,
            &names.into_iter().collect::<Vec<_>>(),
            &format!("./{from}.ts"),
        );
    }
    let expressions = Expressions::new(&context.package, samples);
    for item in &module.items {
        out.blank();
        let name = &item.ty.name;
        let head = format!("export const {name}: {}<messages.{name}> = ", kind(item));
        schema(context, &expressions, item).write(&mut out, &head, "");
    }
    out.finish()
}

/// What the runtime calls its schema.
fn kind(item: &Item<'_>) -> &'static str {
    match item.shape {
        Shape::Record(..) => "Struct",
        Shape::Enum(..) => "Enum",
        Shape::Choice(..) => "Choice",
    }
}

fn schema(context: &Context<'_>, expressions: &Expressions<'_, '_, '_>, item: &Item<'_>) -> Layout {
    let name = &item.ty.name;
    let mut members = vec![("name".to_owned(), Layout::text(name))];
    let mut add = |key: &str, value| members.push((key.to_owned(), value));
    let is = match &item.shape {
        Shape::Record(_, fields) => {
            let schemas = fields.iter();
            let schemas =
                schemas.map(|it| (it.name.to_string(), field(context, expressions, fields, it)));
            add("fields", Layout::Lines(schemas.collect()));
            "struct"
        }
        Shape::Enum(shape, values) => {
            add("repr", Layout::text(repr(shape.repr)));
            if shape.closed {
                add("closed", Layout::word(true));
            }
            add("values", Layout::word(format!("messages.{name}")));
            if let Some(process) = process(name, shape, values) {
                add("process", process);
            }
            "enum"
        }
        Shape::Choice(_, variants) => {
            let forms = variants.iter();
            let form = |ty| Layout::word(format!("() => {}", context.name_of(ty)));
            let forms = forms.map(|it| (it.name.to_string(), form(&it.of.ty)));
            add("forms", Layout::Lines(forms.collect()));
            "choice"
        }
    };
    members.insert(0, ("is".to_owned(), Layout::text(is)));
    Layout::Object(members)
}

fn repr(repr: EnumRepr) -> &'static str {
    match repr {
        EnumRepr::Int(kind) => kind.name(),
        EnumRepr::String => "string",
    }
}

/// What the spec says of an enum's values as states, if it says any of it.
fn process(ty: &str, shape: &EnumType, values: &[Spelled<'_, EnumValue>]) -> Option<Layout> {
    let name =
        |value: &Spelled<'_, EnumValue>| Layout::word(format!("messages.{ty}.{}", value.name));
    let those = |is: fn(&EnumValue) -> bool| -> Vec<Layout> {
        values
            .iter()
            .filter(|value| is(value.of))
            .map(name)
            .collect()
    };
    let mut members = Vec::new();
    let mut add = |key: &str, value| members.push((key.to_owned(), value));
    if let Some(order) = shape.order {
        add("order", Layout::text(order.name()));
    }
    let next = values.iter().filter(|value| !value.then.is_empty());
    let next: Vec<Layout> = next
        .map(|value| {
            let follow = values
                .iter()
                .filter(|other| value.then.contains(&other.of.name));
            Layout::List(vec![name(value), Layout::List(follow.map(name).collect())])
        })
        .collect();
    for (key, list) in [
        ("next", next),
        ("final", those(|it| it.is_final)),
        ("error", those(|it| it.is_error)),
    ] {
        if !list.is_empty() {
            add(key, Layout::List(list));
        }
    }
    (!members.is_empty()).then_some(Layout::Object(members))
}

fn field(
    context: &Context<'_>,
    expressions: &Expressions<'_, '_, '_>,
    beside: &[Spelled<'_, Field>],
    field: &Spelled<'_, Field>,
) -> Layout {
    let details = field.details();
    let large = is_large(context, field);
    let held = |field: &Field, wire: &Scalar| {
        let value = expressions.value(field.ty.item(), &Value::from(wire));
        constant(context, &value, is_large(context, field))
    };
    let mut members = vec![("key".to_owned(), Layout::text(&field.wire))];
    let mut add = |key: &str, value| members.push((key.to_owned(), value));
    add("type", type_schema(context, &field.ty));
    let mut flag = |key, is: bool| {
        if is {
            add(key, Layout::word(true));
        }
    };
    let has = |quirk| details.quirks.contains(&quirk);
    flag("optional", field.optional);
    flag("safe", is_safe(field));
    flag("emptyIsAbsent", has(Quirk::EmptyIsAbsent));
    flag("lenientNumber", has(Quirk::LenientNumber));
    flag("lenientBool", has(Quirk::LenientBool));
    flag("sensitive", field.sensitive);
    if !details.also.is_empty() {
        add("also", Layout::texts(&details.also));
    }
    if field.wire_form != WireForm::Plain {
        add("form", Layout::text(field.wire_form.name()));
    }
    for constraint in details.constraints() {
        match constraint {
            Constraint::Min(min) => add("min", number(min, large)),
            Constraint::Max(max) => add("max", number(max, large)),
            Constraint::Length(least, most) => {
                let bounds = [least, most].map(|it| Layout::Number(it.to_string()));
                add("length", Layout::List(bounds.into()));
            }
            Constraint::Pattern(pattern) => add("pattern", Layout::text(pattern)),
            Constraint::Only(taken) => {
                add(
                    "only",
                    Layout::List(taken.iter().map(|it| held(field, it)).collect()),
                );
            }
        }
    }
    if let Some(default) = &details.default {
        add("default", held(field, default));
    }
    if let Some(condition) = details.condition.as_ref().filter(|_| field.optional) {
        let key = match condition {
            Condition::When(_) => "when",
            Condition::Unless(_) => "unless",
        };
        let asked = condition
            .asked()
            .iter()
            .filter_map(|Asked { wire, values }| {
                let asked = beside.iter().find(|it| it.wire == *wire)?;
                let values = values.iter().map(|it| held(asked, it));
                Some((asked.name.to_string(), Layout::List(values.collect())))
            });
        add(key, Layout::Object(asked.collect()));
    }
    Layout::Object(members)
}

pub fn type_schema(context: &Context<'_>, ty: &Type) -> Layout {
    match ty {
        Type::Array(item) => Layout::Object(vec![("list".to_owned(), type_schema(context, item))]),
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
