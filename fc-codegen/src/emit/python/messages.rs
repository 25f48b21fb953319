//! Message types: dataclasses, enums and choices.

use super::enums::{enumeration, is_state};
use super::literal::{constant, literal, number, regex};
use super::modules::Used;
use super::source::{Code, Python, assign_text};
use crate::package::about;
use crate::package::conditions::sentence;
use crate::package::context::Context;
use crate::package::facts;
use crate::package::items::{Item, Package, Shape, Spelled};
use crate::package::language::Case;
use crate::package::marks::FieldMarks;
use crate::package::name::free;
use crate::package::source::Source;
use crate::package::types::in_lists;
use fc_spec::model::{Argument, EnumRepr, Field, Scalar, Text, Type, TypeShape, Value, Variant};

/// Writes message types. Enums come first, and choices last.
pub fn types<'m>(
    out: &mut Source,
    used: &mut Used<'m>,
    context: &'m Context<'_>,
    items: &[&'m Item<'_>],
) {
    // Python evaluates annotations of fields late, but constants of classes at once. A constant may be a value of an
    // enum.
    for item in items {
        if let Shape::Enum(shape, values) = &item.shape {
            if !is_state(context, shape, item.ty.of) {
                used.library("enum", "Enum");
            }
            out.gap();
            enumeration(out, context, item, shape, values);
        }
    }
    for item in items {
        if let Shape::Record(_, fields) = &item.shape {
            out.gap();
            structure(out, used, context, item, fields);
            errors(out, context, item);
        }
    }
    // A choice refers to its structs at once.
    for item in items {
        if let Shape::Choice(_, variants) = &item.shape {
            out.gap();
            choice(out, used, context, item, variants);
        }
    }
}

/// Returns the names of message types, each with the enum of its declared errors.
pub fn names<'n>(context: &'n Context<'_>, items: &[&'n Item<'_>]) -> Vec<&'n str> {
    let errors = |item: &Item<'n>| Some(context.package.declared_by(item)?.1);
    let names = items.iter();
    let names = names.flat_map(|item| std::iter::once(&*item.ty.name).chain(errors(item)));
    names.collect()
}

fn structure<'m>(
    out: &mut Source,
    used: &mut Used<'m>,
    context: &'m Context<'_>,
    item: &'m Item<'_>,
    fields: &'m [Spelled<'_, Field>],
) {
    used.library("dataclasses", "dataclass");
    used.library("dataclasses", "field");
    out.line("@dataclass(slots=True, kw_only=True)");
    let head = format!("class {}(rt.Message)", item.ty.name);
    out.suite(&head, |out| {
        out.docstring(&facts::item_docs(context, item));
        out.blank();
        let example = context.example(item);
        if example != "{}" {
            used.library("typing", "ClassVar");
            assign_text(out, "__example__: ClassVar[str]", &example);
            out.blank();
        }
        let defaults = defaults(context, fields);
        for Default {
            name,
            constant,
            ty,
            value,
            ..
        } in &defaults
        {
            used.library("typing", "ClassVar");
            let ty = ty.strip_suffix(" | rt.Unknown[int]").unwrap_or(ty);
            out.line(format!("{constant}: ClassVar[{ty}] = {value}"));
            out.template("default", &[("name", name)]);
            out.blank();
        }
        for field in fields {
            used.library("typing", "Annotated");
            used.all_in(&field.ty);
            if let Some(id) = context.package.id_of(field) {
                used.id(&id.name);
            }
            let mut marks = vec![Code::from(field_annotation(context, field, field.optional))];
            marks.push(key(field, fields, &context.package));
            let absent = match (field.optional, field.sensitive) {
                (true, true) => " = field(default=None, repr=False)",
                (true, false) => " = None",
                (false, true) => " = field(repr=False)",
                (false, false) => "",
            };
            let ty = Code::Call("Annotated[".to_owned(), marks, "]");
            ty.write(out, &format!("{}: ", field.name), absent);
            let condition = sentence(&context.package, field, fields, |it| constant(it).flat());
            out.docstring(&facts::field_docs(context.style, field, condition));
            out.blank();
        }
        extra(out);
        for Default {
            name,
            constant,
            accessor,
            ty,
            ..
        } in &defaults
        {
            out.blank();
            out.line("@property");
            out.suite(&format!("def {accessor}(self) -> {ty}"), |out| {
                out.template("or_default", &[("name", name), ("constant", constant)]);
            });
        }
    });
}

/// Writes the field that keeps unknown keys.
pub fn extra(out: &mut Source) {
    out.template("extra", &[]);
}

/// Returns the type of a field. An id field has its id type, if one exists.
fn field_annotation(context: &Context<'_>, field: &Field, optional: bool) -> String {
    let Some(id) = context.package.id_of(field) else {
        return annotation(context, &field.ty, optional);
    };
    let ty = in_lists(&field.ty, &id.name, |item| format!("list[{item}]"));
    if optional { ty + " | None" } else { ty }
}

/// Returns a type, optional or not.
pub fn annotation(context: &Context<'_>, ty: &Type, optional: bool) -> String {
    let ty = match ty {
        Type::Bool => "bool".to_owned(),
        Type::Int(kind) => ["rt.", &kind.name().to_uppercase()].concat(),
        Type::Float(kind) => ["rt.", &kind.name().to_uppercase()].concat(),
        Type::String => "str".to_owned(),
        Type::TimestampMs => "rt.TimestampMs".to_owned(),
        Type::TimestampS => "rt.TimestampS".to_owned(),
        Type::Base64 => "bytes".to_owned(),
        Type::Json => "rt.Json".to_owned(),
        Type::Array(item) => format!("list[{}]", annotation(context, item, false)),
        Type::Named(named) => {
            let item = context.package.item(named);
            match &item.ty.shape {
                TypeShape::Enum(shape) if !shape.closed => {
                    let held = match shape.repr {
                        EnumRepr::Int(_) => "int",
                        EnumRepr::String => "str",
                    };
                    format!("{} | rt.Unknown[{held}]", item.ty.name)
                }
                _ => item.ty.name.to_string(),
            }
        }
    };
    if optional {
        [&ty, " | None"].concat()
    } else {
        ty
    }
}

/// Returns the wire form and the constraints of a field.
fn key(field: &Spelled<'_, Field>, fields: &[Spelled<'_, Field>], package: &Package<'_>) -> Code {
    let marks = FieldMarks::build(field.of, fields);
    let values = |ty: &Type, values: &[Scalar]| {
        let values = values.iter();
        let values = values.map(|wire| constant(&package.value(ty, &Value::from(wire))));
        Code::tuple(values.collect())
    };
    let mut items = vec![Code::from(literal(&field.wire))];
    let mut set = |name: &str, value: Code| items.push(Code::named(name, value));
    if !marks.also.is_empty() {
        let keys = marks.also.iter().map(|key| literal(key).into());
        set("also", Code::tuple(keys.collect()));
    }
    for (name, argument) in &marks.constraints {
        let value = match argument {
            Argument::Number(value) => number(value).into(),
            Argument::Range(least, most) => format!("({least}, {most})").into(),
            Argument::Pattern(pattern) => regex(pattern.portable()).into(),
            Argument::Values(taken) => values(field.ty.item(), taken),
        };
        set(name, value);
    }
    if let Some(form) = marks.form {
        let form = Case::Screaming.apply(form);
        set("form", format!("rt.Form.{form}").into());
    }
    for quirk in marks.quirks {
        set(quirk, "True".into());
    }
    if let Some(condition) = marks.condition {
        let asked = condition.fields.iter().map(|(other, wires)| {
            let name = format!("{}: ", literal(&other.wire));
            Code::Named(name, Box::new(values(&other.ty, wires)))
        });
        set(condition.word, Code::List("{", asked.collect(), "}"));
    }
    Code::call("rt.Key", items)
}

/// The default of a field, which is the meaning of its absence.
struct Default {
    name: String,
    constant: String,
    accessor: String,
    ty: String,
    value: String,
}

/// Returns the defaults of a message's fields.
fn defaults(context: &Context<'_>, fields: &[Spelled<'_, Field>]) -> Vec<Default> {
    let defaults = fields.iter().filter_map(|field| {
        let default = Value::from(field.details().default.as_ref()?);
        let word = field.name.trim_end_matches('_');
        let taken = |name: &str| fields.iter().any(|it| it.name == name);
        let ty = match &field.ty {
            _ if context.package.id_of(field).is_some() => field_annotation(context, field, false),
            Type::Int(_) | Type::TimestampMs | Type::TimestampS => "int".to_owned(),
            Type::Float(_) => "float".to_owned(),
            ty => annotation(context, ty, false),
        };
        Some(Default {
            name: field.name.to_string(),
            constant: format!("DEFAULT_{}", word.to_uppercase()),
            accessor: free(&[&format!("{word}_or_default")], taken),
            ty,
            value: constant(&context.package.held(field, &default)).flat(),
        })
    });
    defaults.collect()
}

/// Writes the enum of the errors that a command declares, next to its request.
fn errors(out: &mut Source, context: &Context<'_>, item: &Item<'_>) {
    let package = &context.package;
    let Some((command, name)) = package.declared_by(item) else {
        return;
    };
    out.gap();
    out.suite(&format!("class {name}(rt.Result)"), |out| {
        let docs = about::errors(context, command);
        out.docstring(&docs);
        for (error, result) in package.errors(command) {
            let text = literal(&result.text.zh);
            out.blank();
            out.line(format!("{} = {}, {text}", result.name, result.code));
            out.docstring(&about::error(error, result.of));
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
    used.library("typing", "Annotated");
    used.library("typing", "TypeAlias");
    let names = variants.iter().map(|it| literal(&it.of.name).into());
    let names = Code::call("rt.Variants", [Code::tuple(names.collect())]);
    let types = variants.iter().map(|variant| {
        used.named(&variant.of.ty);
        context.name_of(&variant.of.ty).to_owned()
    });
    let union = Code::Union(types.collect());
    let name = &item.ty.name;
    let alias = Code::Call("Annotated[".to_owned(), vec![union, names], "]");
    alias.write(out, &format!("{name}: TypeAlias = "), "");
    let mut docs = facts::type_docs(context, item);
    for variant in variants {
        let ty = context.name_of(&variant.of.ty);
        let Text { zh, en } = &variant.text;
        docs.both([format!("`{ty}`：{zh}"), format!("`{ty}`: {en}")]);
        facts::variant_end(&mut docs, variant);
    }
    out.docstring(&docs);
}
