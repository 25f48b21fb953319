//! The sources of the group headers: the fields of each message and the values of each enum.

use super::groups::{self, NamedGroup};
use super::layout::{float, integer, literal, raw};
use super::process;
use super::tables::spelled_in;
use super::types::{Header, namespace};
use crate::package::conditions::Asked;
use crate::package::context::Context;
use crate::package::items::{Item, Shape, Spelled};
use crate::package::joined::Joined;
use crate::package::marks::FieldMarks;
use crate::package::process::has_states;
use crate::package::source::Source;
use fc_spec::model::{Argument, EnumRepr, EnumType, EnumValue, Field, Number, Scalar, Type, Value};

/// Generates the source of a header.
pub fn source(
    context: &Context<'_>,
    header: &Header<'_, '_>,
    groups: &[&NamedGroup<'_, '_>],
) -> String {
    let space = &namespace(context);
    let mut out = context.source();
    out.line(format!("#include \"{space}/groups/{}.hpp\"", header.id));
    out.blank();
    out.line("#include <ostream>");
    out.blank();
    if groups.iter().any(|group| !group.commands.is_empty()) {
        out.line(format!("#include \"{space}/protocol.hpp\""));
    }
    out.line("#include \"fc_runtime/codec.hpp\"");
    out.line("#include \"fc_runtime/process.hpp\"");
    out.blank();
    out.line("// Tables of fields, a line for each.");
    out.line("// clang-format off");
    out.blank();
    if !header.items.is_empty() {
        types(&mut out, context, header);
    }
    groups::define(&mut out, context, groups);
    out.finish()
}

/// Writes the codecs and functions of a header's message types, and of their operations.
fn types(out: &mut Source, context: &Context<'_>, header: &Header<'_, '_>) {
    let space = &namespace(context);
    out.namespace("fc_runtime", |out| {
        for item in &header.items {
            out.blank();
            match &item.shape {
                Shape::Record(_, fields) => record(out, context, item, fields),
                Shape::Enum(shape, values) => enumeration(out, space, item, shape, values),
                Shape::Choice(..) => {}
            }
        }
    });
    out.blank();
    out.namespace(space, |out| {
        for item in &header.items {
            out.blank();
            functions(out, item);
            errors(out, context, item);
        }
    });
    out.blank();
    out.namespace("fc_runtime", |out| {
        for item in &header.items {
            if let Some(call) = context.package.opened_by(item) {
                process::define_call(out, context, &call);
            }
        }
        header.codecs(out, space, "template");
    });
}

fn record(out: &mut Source, context: &Context<'_>, item: &Item<'_>, fields: &[Spelled<'_, Field>]) {
    let space = &namespace(context);
    let name = &item.ty.name;
    let marks = fields
        .iter()
        .map(|field| FieldMarks::build(field.of, fields));
    let marks: Vec<_> = fields.iter().zip(marks).collect();
    let example = context.example(item);
    out.line("template <>");
    out.enclose(&format!("struct Fields<{space}::{name}> {{"), "};", |out| {
        let spec_name = literal(&item.ty.of.name);
        out.line(format!(
            "static constexpr std::string_view name = {spec_name};"
        ));
        out.line(format!(
            "static constexpr std::string_view example = {};",
            raw(&example)
        ));
        for (field, marks) in &marks {
            lists(out, field, marks);
        }
        out.blank();
        let (visit, message) = match fields {
            [] => ("/*visit*/", "/*message*/"),
            _ => ("visit", "message"),
        };
        out.line("template <class Visitor, class Message>");
        let open = format!("static void each(Visitor& {visit}, Message& {message}) {{");
        out.enclose(&open, "}", |out| {
            for (field, marks) in &marks {
                let of = field_of(field, marks);
                out.line(format!("visit({of}, message.{});", field.name));
            }
        });
        let asked = marks
            .iter()
            .filter_map(|(field, marks)| Some(asks(context, field, marks.condition.as_ref()?)));
        let asked: Vec<String> = asked.collect();
        let (visit, message) = match asked.as_slice() {
            [] => ("/*asked*/", "/*message*/"),
            _ => ("asked", "message"),
        };
        let open = format!(
            "static void conditions(Conditions& {visit}, const {space}::{name}& {message}) {{"
        );
        out.enclose(&open, "}", |out| {
            for asks in &asked {
                out.line(asks);
            }
        });
    });
}

/// Writes the alternative keys of a field, and its list of accepted values.
fn lists(out: &mut Source, field: &Spelled<'_, Field>, marks: &FieldMarks<'_, '_>) {
    let mut list = |ty: &str, name: &str, items: Vec<String>| {
        let (field, items) = (&field.name, items.join(", "));
        out.line(format!(
            "static constexpr {ty} {name}_{field}[] = {{{items}}};"
        ));
    };
    if !marks.also.is_empty() {
        let keys = marks.also.iter().map(|key| literal(key));
        list("std::string_view", "also", keys.collect());
    }
    for (name, argument) in &marks.constraints {
        if let Argument::Values(values) = argument {
            let ty = match values.first() {
                Some(Scalar::String(_)) => "std::string_view",
                _ => "std::int64_t",
            };
            list(ty, name, values.iter().map(taken).collect());
        }
    }
}

/// Returns an accepted value as the runtime compares it: all integers are signed.
fn taken(value: &Scalar) -> String {
    match value {
        Scalar::Number(Number::Int(value)) if i64::try_from(*value).is_err() => {
            format!("static_cast<std::int64_t>({})", integer(*value))
        }
        value => scalar(value),
    }
}

/// Returns a value in wire form.
fn scalar(value: &Scalar) -> String {
    match value {
        Scalar::Number(value) => number(value),
        Scalar::String(text) => literal(text),
        Scalar::Bool(value) => value.to_string(),
    }
}

fn number(value: &Number) -> String {
    match value {
        Number::Int(value) => integer(*value),
        Number::Float(value) => float(*value),
    }
}

/// Returns the description of a field for a visitor.
fn field_of(field: &Spelled<'_, Field>, marks: &FieldMarks<'_, '_>) -> String {
    let mut out = format!("Field({})", literal(&field.wire));
    out.push_str(match marks.form {
        None => "",
        Some("string") => ".quoted()",
        Some(_) => ".numeric()",
    });
    for (name, argument) in &marks.constraints {
        let value = match argument {
            Argument::Number(value) => number(value),
            Argument::Range(least, most) => [*least, *most].map(|it| integer(it.into())).join(", "),
            Argument::Pattern(pattern) => raw(pattern.portable()),
            Argument::Values(_) => format!("{name}_{}", field.name),
        };
        out.extend([".", name, "(", &value, ")"]);
    }
    for quirk in &marks.quirks {
        out.extend([".", quirk, "()"]);
    }
    if !marks.also.is_empty() {
        out.extend([".also(also_", &field.name, ")"]);
    }
    if *field.of.ty.item() == Type::Base64 {
        out.push_str(".base64()");
    }
    if field.sensitive {
        out.push_str(".sensitive()");
    }
    out
}

/// Returns the check of a field's condition, which depends on other fields.
fn asks(context: &Context<'_>, field: &Spelled<'_, Field>, condition: &Asked<'_, '_>) -> String {
    let space = &format!("{}::", namespace(context));
    let holds = condition.fields.iter().map(|(other, values)| {
        let each = values.iter().map(|wire| {
            let value = context.package.held(other, &Value::from(wire));
            format!(
                "message.{} == {}",
                other.name,
                spelled_in(context, space, &value, "")
            )
        });
        let each: Vec<String> = each.collect();
        match each.as_slice() {
            [only] => only.clone(),
            each => format!("({})", each.join(" || ")),
        }
    });
    let holds = holds.joined(" && ");
    let holds = match condition.word {
        "unless" => format!("!({holds})"),
        _ => holds,
    };
    let said = condition.fields.iter().map(|(other, values)| {
        let values = values.iter().map(|it| Value::from(it).to_string());
        format!("`{}` is {}", other.wire, values.joined(" or "))
    });
    let said = literal(&format!("{} {}", condition.word, said.joined(" and ")));
    let (key, name) = (literal(&field.wire), &field.name);
    format!("asked.asks({key}, message.{name}, {holds}, {said});")
}

/// Returns the scope of an enum's values.
pub fn enumerators(item: &Item<'_>) -> String {
    match &item.shape {
        Shape::Enum(shape, _) if shape.repr == EnumRepr::String => {
            format!("{}::Value", item.ty.name)
        }
        _ => item.ty.name.to_string(),
    }
}

fn enumeration(
    out: &mut Source,
    space: &str,
    item: &Item<'_>,
    shape: &EnumType,
    values: &[Spelled<'_, EnumValue>],
) {
    let name = &item.ty.name;
    let is_text = shape.repr == EnumRepr::String;
    let wire_type = if is_text {
        "std::string_view".to_owned()
    } else {
        format!("{space}::{name}")
    };
    out.line("template <>");
    out.enclose(&format!("struct Values<{space}::{name}> {{"), "};", |out| {
        out.line(format!("static constexpr bool closed = {};", shape.closed));
        let open = format!("static constexpr EnumValue<{wire_type}> all[] = {{");
        out.enclose(&open, "};", |out| {
            for value in values {
                let wire = if is_text {
                    scalar(&value.wire)
                } else {
                    format!("{space}::{name}::{}", value.name)
                };
                out.line(format!(
                    "{{{wire}, {}, {}, {}}},",
                    literal(&value.name),
                    value.is_final,
                    value.is_error
                ));
            }
        });
    });
}

/// Writes the function that returns the refusal for each error that a command declares.
fn errors(out: &mut Source, context: &Context<'_>, item: &Item<'_>) {
    let Some((command, name)) = context.package.declared_by(item) else {
        return;
    };
    out.block(
        format!("fc_runtime::Refusal refusal({name} error)"),
        |out| {
            out.line("std::string text;");
            out.block("switch (error)", |out| {
                for (_, result) in context.package.errors(command) {
                    let (value, text) = (&result.name, literal(&result.text.zh));
                    out.line(format!("case {name}::{value}: text = {text}; break;"));
                }
            });
            out.line("return {static_cast<std::int64_t>(error), std::move(text)};");
        },
    );
}

/// Defines the functions that the header declares for a type.
fn functions(out: &mut Source, item: &Item<'_>) {
    let name = &item.ty.name;
    match &item.shape {
        Shape::Record(..) => {
            out.template("operators", &[("name", name)]);
        }
        Shape::Enum(shape, values) => of_enum(out, item, shape, values),
        Shape::Choice(..) => {}
    }
}

fn of_enum(out: &mut Source, item: &Item<'_>, shape: &EnumType, values: &[Spelled<'_, EnumValue>]) {
    let name = &item.ty.name;
    let is_text = shape.repr == EnumRepr::String;
    let by_value = if is_text {
        format!("const {name}&")
    } else {
        name.to_string()
    };
    if is_text {
        out.template("text_value", &[("name", name)]);
    }
    let found = "fc_runtime::detail::find_value(value)";
    out.line(format!(
        "bool is_known({by_value} value) noexcept {{ return {found} != nullptr; }}"
    ));
    if has_states(shape) {
        process::define(out, item, &by_value, shape, values);
    }
    out.line(format!(
        "std::ostream& operator<<(std::ostream& out, {by_value} value) {{ fc_runtime::EnumCodec<{name}>::print(out, value); return out; }}"
    ));
}
