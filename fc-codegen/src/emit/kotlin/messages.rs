//! Message types: messages, enums and choices.

use super::expr;
use super::text::{STYLE, codec, field_type, literal, plain_codec, scalar};
use crate::package::about;
use crate::package::conditions::sentence;
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::expr::Expr;
use crate::package::facts;
use crate::package::items::{Item, Shape, Spelled};
use crate::package::marks::FieldMarks;
use crate::package::process::{has_states, next_values};
use crate::package::source::Source;
use fc_spec::model::{
    EnumRepr, EnumType, EnumValue, Field, StateOrder, Text, Type, Value, Variant,
};

/// Writes message types.
pub fn types(out: &mut Source, context: &Context<'_>, items: &[Item<'_>]) {
    for item in items {
        out.blank();
        match &item.shape {
            Shape::Record(_, fields) => message(out, context, item, fields),
            Shape::Enum(shape, values) => enumeration(out, context, item, shape, values),
            Shape::Choice(_, variants) => choice(out, context, item, variants),
        }
    }
}

/// Returns the name of a field's constant. It avoids the names of the package's types.
fn constant(context: &Context<'_>, field: &Field) -> String {
    let name = field.name.to_uppercase();
    let is_type = context
        .package
        .items()
        .any(|it| it.ty.name == name.as_str());
    if is_type { name + "_" } else { name }
}

fn message(
    out: &mut Source,
    context: &Context<'_>,
    item: &Item<'_>,
    fields: &[Spelled<'_, Field>],
) {
    out.docs(&facts::item_docs(context, item));
    let name = &item.ty.name;
    let mut supers = vec!["Message(content)".to_owned()];
    supers.extend(choices_of(context, item));
    let head = format!("public class {name} private constructor(content: Content)");
    out.block(heading(out, &head, &supers), |out| {
        for field in fields {
            let condition = sentence(&context.package, field, fields, spelled);
            out.documented(&facts::field_docs(&STYLE, field, condition));
            property(out, context, field);
            if let Some(default) = &field.details().default {
                let default = context.package.held(field, &Value::from(default));
                let default = expr::expression(&default, &field.ty);
                let ty = field_type(context, field);
                out.template(
                    "or_default",
                    &[
                        ("property", &field.name),
                        ("ty", &ty),
                        ("default", &default),
                    ],
                );
            }
        }
        out.template("message_type", &[("name", name)]);
        builder(out, context, name, fields);
        out.blank();
        companion(out, context, item, fields);
    });
}

/// Returns a class and its supertypes, on two lines if they exceed one.
fn heading(out: &Source, head: &str, supers: &[String]) -> String {
    let supers = supers.join(", ");
    if out.has_room([head, " : ", &supers, " {"]) {
        format!("{head} : {supers}")
    } else {
        format!("{head} :\n    {supers}")
    }
}

/// Returns the choices that have a message as a variant.
fn choices_of(context: &Context<'_>, item: &Item<'_>) -> Vec<String> {
    let mut names = Vec::new();
    for other in context.package.items() {
        let Shape::Choice(_, variants) = &other.shape else {
            continue;
        };
        let is_form = |it: &Spelled<'_, Variant>| *context.name_of(&it.ty) == item.ty.name;
        if variants.iter().any(is_form) {
            names.push(other.ty.name.to_string());
        }
    }
    names
}

/// Returns a value as comments write it.
fn spelled(value: &Expr<'_>) -> String {
    expr::expression(value, &Type::Json)
}

fn property(out: &mut Source, context: &Context<'_>, field: &Spelled<'_, Field>) {
    let (name, constant) = (&field.name, constant(context, field));
    let mark = if field.optional { "?" } else { "" };
    let ty = field_type(context, field);
    out.line(format!(
        "public val {name}: {ty}{mark} get() = get({constant})"
    ));
}

fn builder(out: &mut Source, context: &Context<'_>, name: &str, fields: &[Spelled<'_, Field>]) {
    out.template("builder", &[("name", name)]);
    let head = "public class Builder internal constructor(from: ";
    let supers = [format!("MessageBuilder<{name}, Builder>({name}, from)")];
    let head = heading(out, &format!("{head}{name}?)"), &supers);
    if fields.is_empty() {
        out.line(head);
        return;
    }
    out.block(head, |out| {
        for field in fields {
            let (property, constant) = (&field.name, constant(context, field));
            let mark = if field.optional { "?" } else { "" };
            let ty = field_type(context, field);
            out.documented(&Docs::linked(format!("[{name}.{property}]")));
            let head = format!("public fun {property}({property}: {ty}{mark}): Builder =");
            let put = format!("put({constant}, {property})");
            out.line_or([&head, " ", &put], |out| {
                out.enclose(&head, "", |out| out.line(&put));
            });
        }
    });
}

fn companion(
    out: &mut Source,
    context: &Context<'_>,
    item: &Item<'_>,
    fields: &[Spelled<'_, Field>],
) {
    let name = &item.ty.name;
    let mut arguments = vec![literal(name)];
    let example = context.example(item);
    if example != "{}" {
        arguments.push(literal(&example));
    }
    out.template("type", &[]);
    let joined = arguments.join(", ");
    let head = format!("public companion object : MessageType<{name}>(");
    let head = if out.has_room([&head, &joined, ") {"]) {
        format!("{head}{joined})")
    } else {
        let lines = arguments.join(",\n    ");
        format!("{head}\n    {lines},\n)")
    };
    out.block(head, |out| {
        for field in fields {
            let marks = FieldMarks::build(field.of, fields);
            let how = if field.optional {
                "optional"
            } else {
                "required"
            };
            let wire = literal(&field.wire);
            let mut made = format!("{how}({wire}, {})", codec(context, field, &marks));
            for key in marks.also {
                made.extend([".also(", &literal(key), ")"]);
            }
            if marks.empty_is_absent {
                made.push_str(".emptyIsAbsent()");
            }
            if field.sensitive {
                made.push_str(".sensitive()");
            }
            out.line(format!("private val {} = {made}", constant(context, field)));
        }
        conditions(out, context, fields);
        out.template("build", &[("name", name)]);
    });
}

/// Writes the conditions after all fields, because a condition may test a later field.
fn conditions(out: &mut Source, context: &Context<'_>, fields: &[Spelled<'_, Field>]) {
    let lines = fields.iter().filter_map(|field| {
        let condition = FieldMarks::build(field.of, fields).condition?;
        let asked = condition.fields.iter().map(|(other, values)| {
            let values: Vec<String> = values.iter().map(scalar).collect();
            let (word, other) = (condition.word, constant(context, other));
            format!(".{word}Is({other}, {})", values.join(", "))
        });
        let asked: Vec<String> = asked.collect();
        Some(constant(context, field) + &asked.concat())
    });
    let lines: Vec<String> = lines.collect();
    if lines.is_empty() {
        return;
    }
    out.blank();
    out.block("init", |out| out.line(lines.join("\n")));
}

fn enumeration(
    out: &mut Source,
    context: &Context<'_>,
    item: &Item<'_>,
    shape: &EnumType,
    values: &[Spelled<'_, EnumValue>],
) {
    let name = &item.ty.name;
    let docs = about::enumeration(context, item.ty.of, |_| ());
    let (wire, base, kind) = match shape.repr {
        EnumRepr::Int(kind) => ("Long", "Int", Some(plain_codec(&Type::Int(kind)))),
        EnumRepr::String => ("String", "Text", None),
    };
    let mut arguments = vec![literal(name)];
    arguments.extend(kind);
    if shape.closed {
        arguments.push("isClosed = true".to_owned());
    }
    let arguments = arguments.join(", ");
    let is_state = has_states(shape);
    let mut supers = vec![format!("{base}Value(wire)")];
    supers.extend(is_state.then(|| "State".to_owned()));
    out.docs(&docs);
    let head = format!("public class {name} private constructor(wire: {wire})");
    let head = heading(out, &head, &supers);
    out.block(head, |out| {
        out.line(format!(
            "override val enumType: EnumType<{name}> get() = {name}"
        ));
        if is_state {
            out.template("state", &[("name", name)]);
        }
        out.template("values", &[]);
        let head = format!("public companion object : {base}EnumType<{name}>({arguments})");
        out.block(head, |out| {
            for value in values {
                out.documented(&facts::value_docs(value));
                let wire = scalar(&value.wire);
                out.template(
                    "value",
                    &[("value", &value.name), ("name", name), ("wire", &wire)],
                );
            }
            if is_state {
                out.blank();
                steps(out, shape, values);
            }
            out.template("of_wire", &[("name", name), ("wire", wire)]);
        });
    });
}

/// Writes the rules for the values as states.
fn steps(out: &mut Source, shape: &EnumType, values: &[Spelled<'_, EnumValue>]) {
    let order = match shape.order {
        None => "UNSAID",
        Some(StateOrder::Normal) => "NORMAL",
        Some(StateOrder::Complete) => "COMPLETE",
    };
    out.line(format!(
        "private val steps = Steps(this, StateOrder.{order})"
    ));
    let wire = |value: &Spelled<'_, EnumValue>| format!("{}.wire", value.name);
    let mut call = |name: &str, values: Vec<String>, least: usize| {
        if values.len() >= least {
            out.line(format!("    .{name}({})", values.join(", ")));
        }
    };
    for value in values {
        let next = next_values(value, values).map(wire);
        call("then", [wire(value)].into_iter().chain(next).collect(), 2);
    }
    let finals = values.iter().filter(|value| value.is_final);
    call("finals", finals.map(wire).collect(), 1);
    let errors = values.iter().filter(|value| value.is_error);
    call("errors", errors.map(wire).collect(), 1);
}

fn choice(
    out: &mut Source,
    context: &Context<'_>,
    item: &Item<'_>,
    variants: &[Spelled<'_, Variant>],
) {
    let name = &item.ty.name;
    let mut docs = facts::type_docs(context, item);
    for variant in variants {
        let ty = context.name_of(&variant.ty);
        let Text { zh, en } = &variant.text;
        docs.raw_joined([
            format!("- [{ty}]：{zh}"),
            format!("- [{ty}]: {en}"),
            format!("- [{ty}]：{zh}\n  {en}"),
        ]);
        facts::variant_end(&mut docs, variant);
    }
    out.docs(&docs);
    out.template("choice", &[("name", name)]);
    out.deeper(2, |out| {
        let forms: Vec<&str> = variants.iter().map(|it| context.name_of(&it.ty)).collect();
        let open = "override val forms: List<MessageType<*>> get() = listOf(";
        out.list(open, &forms, ")");
    });
    out.line("    }\n}");
}
