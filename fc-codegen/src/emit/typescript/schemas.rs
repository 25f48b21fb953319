//! What the runtime has to know of the types of one group: a constant for each, held to the type by the compiler.

use super::constants::{constant, number};
use super::context::{Context, imported, imports, is_large, is_safe, own, parts};
use super::group::Group;
use super::layout::Layout;
use super::source::{head, import, import_types};
use crate::package::expr::Expressions;
use crate::package::items::{Item, Shape, Spelled};
use crate::package::language::Case;
use crate::package::marks::{Bound, FieldMarks};
use crate::sample::Samples;
use fc_spec::model::{EnumRepr, EnumType, EnumValue, Field, Scalar, Type, Value};
use std::borrow::Cow;

/// What the files of schemas say of themselves.
pub const ABOUT: [&str; 2] = [
    "消息类型的描述，运行库据此读写；编译器检查它与类型一致。",
    "Schemas of the message types for the reader and the writer. The compiler checks each against its type.",
];

/// The schemas of a group.
pub fn file(context: &Context<'_>, _: &Samples<'_>, group: &Group<'_, '_>) -> String {
    let mut out = head(ABOUT);
    let items = group.items();
    let kinds = items.iter().map(|item| imported(context, kind(item)));
    let kinds: Vec<String> = kinds.collect();
    import_types(&mut out, &kinds, "../../../src/schema.ts");
    out.line("import * as messages from '../../messages.ts'");
    for (from, names) in imports(context, group.id, items.iter().flat_map(parts)) {
        import(
            &mut out,
            &names.into_iter().collect::<Vec<_>>(),
            &format!("../{from}/schemas.ts"),
        );
    }
    let expressions = Expressions::new(&context.package);
    for item in items {
        out.blank();
        let name = &item.ty.name;
        out.line(format!("/** {{@link messages.{name}}} */"));
        let kind = own(context, kind(item));
        let head = format!("export const {name}: {kind}<messages.{name}> = ");
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

fn schema(context: &Context<'_>, expressions: &Expressions<'_, '_>, item: &Item<'_>) -> Layout {
    let name = &item.ty.name;
    let (is, members) = match &item.shape {
        Shape::Record(_, fields) => {
            let schemas = fields.iter();
            let schemas = schemas.map(|it| (&*it.name, field(context, expressions, fields, it)));
            ("struct", vec![("fields", Layout::lines(schemas))])
        }
        Shape::Enum(shape, values) => {
            let mut members = vec![("repr", Layout::text(repr(shape.repr)))];
            members.extend(Layout::flag("closed", shape.closed));
            members.push(("values", Layout::word(format!("messages.{name}"))));
            members.extend(process(name, shape, values).map(|process| ("process", process)));
            ("enum", members)
        }
        Shape::Choice(_, variants) => {
            let form = |ty| Layout::word(format!("() => {}", context.name_of(ty)));
            let forms = variants.iter().map(|it| (&*it.name, form(&it.of.ty)));
            ("choice", vec![("forms", Layout::lines(forms))])
        }
    };
    let named = [("is", Layout::text(is)), ("name", Layout::text(name))];
    Layout::object(named.into_iter().chain(members))
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
    let next = values.iter().filter(|value| !value.then.is_empty());
    let next = next.map(|value| {
        let follow = values
            .iter()
            .filter(|other| value.then.contains(&other.of.name));
        Layout::List(vec![name(value), Layout::list(follow.map(name))])
    });
    let order = shape
        .order
        .map(|order| ("order", Layout::text(order.name())));
    let lists = [
        ("next", next.collect()),
        ("final", those(|it| it.is_final)),
        ("error", those(|it| it.is_error)),
    ];
    let lists = lists
        .into_iter()
        .filter(|(_, list): &(_, Vec<Layout>)| !list.is_empty());
    let members = order
        .into_iter()
        .chain(lists.map(|(key, list)| (key, Layout::List(list))));
    let members: Vec<_> = members.collect();
    (!members.is_empty()).then(|| Layout::object(members))
}

fn field(
    context: &Context<'_>,
    expressions: &Expressions<'_, '_>,
    fields: &[Spelled<'_, Field>],
    field: &Spelled<'_, Field>,
) -> Layout {
    let details = field.details();
    let marks = FieldMarks::build(field.of, fields);
    let large = is_large(context, field);
    let held = |field: &Field, wire: &Scalar| {
        let value = expressions.value(field.ty.item(), &Value::from(wire));
        constant(context, &value, is_large(context, field))
    };
    let mut members: Vec<(Cow<'_, str>, Layout)> = vec![
        ("key".into(), Layout::text(&field.wire)),
        ("type".into(), type_schema(context, &field.ty)),
    ];
    let mut flag = |key, is| members.extend(Layout::flag(key, is));
    flag("optional".into(), field.optional);
    flag("safe".into(), is_safe(field));
    for quirk in marks.quirks_in_order() {
        flag(Case::Camel.apply(quirk), true);
    }
    flag("sensitive".into(), field.sensitive);
    if !marks.also.is_empty() {
        members.push(("also".into(), Layout::texts(marks.also)));
    }
    members.extend(marks.form.map(|form| ("form".into(), Layout::text(form))));
    members.extend(marks.constraints.iter().map(|(name, bound)| {
        let value = match bound {
            Bound::Number(value) => number(value, large),
            Bound::Range(least, most) => Layout::list([*least, *most].map(Layout::number)),
            Bound::Pattern(pattern) => Layout::text(pattern),
            Bound::Values(taken) => Layout::list(taken.iter().map(|it| held(field, it))),
        };
        (Case::Camel.apply(name), value)
    }));
    let default = details.default.as_ref();
    members.extend(default.map(|default| ("default".into(), held(field, default))));
    members.extend(marks.condition.map(|condition| {
        let asked = condition.fields.into_iter();
        let asked = asked.map(|(asked, values)| {
            let values = values.iter().map(|it| held(asked, it));
            (&*asked.name, Layout::list(values))
        });
        (condition.word.into(), Layout::object(asked))
    }));
    Layout::object(members)
}

/// What a type is in a schema.
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
