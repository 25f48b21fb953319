//! The headers of groups: message types, the codes of requests, and the groups' parts of both stubs.
//!
//! Message types are structs, enums and choices.

use super::groups::{self, NamedGroup};
use super::ids;
use super::layout::{CPP, Includes, integer, literal};
use super::process;
use super::tables;
use super::types::{Header, field_type, integer_type, namespace};
use crate::package::about;
use crate::package::conditions::sentence;
use crate::package::context::Context;
use crate::package::expr::Expr;
use crate::package::facts;
use crate::package::items::{Call, Item, Shape, Spelled};
use crate::package::language::Case;
use crate::package::process::has_states;
use crate::package::source::Source;
use fc_spec::model::{
    EnumRepr, EnumType, EnumValue, Field, Kind, Number, Scalar, Text, Type, Value, Variant,
};

/// Generates a header, with the groups whose operations are in it.
pub fn header(
    context: &Context<'_>,
    header: &Header<'_, '_>,
    groups: &[&NamedGroup<'_, '_>],
) -> String {
    let space = &namespace(context);
    let mut body = context.source();
    let mut includes = Includes::default();
    includes.add(&["iosfwd"], &["message"]);
    for id in &header.needs {
        includes.own(format!("{space}/groups/{id}.hpp"));
    }
    if !header.items.is_empty() {
        types(&mut body, &mut includes, context, header);
    }
    groups::declare(&mut body, &mut includes, context, groups);
    let mut out = context.source();
    out.line("#pragma once");
    out.blank();
    includes.lines(&mut out);
    out.blank();
    out.append(&body);
    out.finish()
}

/// Writes the message types of a header, and their operations.
fn types(
    body: &mut Source,
    includes: &mut Includes,
    context: &Context<'_>,
    header: &Header<'_, '_>,
) {
    let space = &namespace(context);
    body.namespace(space, |out| {
        for item in &header.items {
            out.blank();
            match &item.shape {
                Shape::Record(_, fields) => {
                    structure(out, includes, context, item, fields);
                }
                Shape::Enum(shape, values) => {
                    enumeration(out, includes, context, item, shape, values);
                }
                Shape::Choice(_, variants) => {
                    choice(out, includes, context, item, variants);
                }
            }
        }
    });
    let calls: Vec<Call<'_>> = header
        .items
        .iter()
        .filter_map(|it| context.package.opened_by(it))
        .collect();
    body.blank();
    body.namespace("fc_runtime", |out| {
        for call in &calls {
            includes.add(&["cstdint"], &["operation"]);
            operation(out, context, call);
            out.blank();
            process::declare_set_off(out, context, call);
        }
        header.codecs(out, space, "extern template");
    });
}

fn structure(
    out: &mut Source,
    includes: &mut Includes,
    context: &Context<'_>,
    item: &Item<'_>,
    fields: &[Spelled<'_, Field>],
) {
    out.docs(&facts::item_docs(context, item));
    includes.own("fc_runtime/json.hpp");
    let name = &item.ty.name;
    out.enclose(&format!("struct {name} {{"), "};", |out| {
        for field in fields {
            let condition = sentence(&context.package, field, fields, spelled);
            out.docs(&facts::field_docs(&CPP, field, condition));
            used(includes, &field.ty);
            let mut ty = field_type(context, field);
            if context.package.id_of(field).is_some() {
                includes.own(ids::path(context));
            }
            if field.optional {
                includes.standard("optional");
                ty = format!("std::optional<{ty}>");
            }
            if !field.optional && must_be_set(context, &field.ty) {
                ty = format!("fc_runtime::Required<{ty}>");
            }
            out.line(format!("{ty} {};", field.name));
        }
        out.template("extra", &[]);
        for field in fields {
            let Some(default) = field.details().default.as_ref().filter(|_| field.optional) else {
                continue;
            };
            let ty = field_type(context, field);
            let value = context.package.held(field, &Value::from(default));
            let value = tables::spelled_in(context, "", &value, &ty);
            let name = &field.name;
            out.template("or_default", &[("name", name)]);
            // A C++ name must not have two underscores in a row.
            let stem = name.trim_end_matches('_');
            let open = format!("[[nodiscard]] {ty} {stem}_or_default() const {{");
            let body = format!("return {name}.value_or({value});");
            out.line_or([&open, " ", &body, " }"], |out| {
                out.enclose(&open, "}", |out| out.line(&body));
            });
        }
    });
    out.blank();
    for operator in ["==", "!="] {
        let parameters = [
            format!("const {name}& left"),
            format!("const {name}& right"),
        ];
        out.parameters(&format!("bool operator{operator}("), &parameters, ");");
    }
    let parameters = [
        "std::ostream& out".to_owned(),
        format!("const {name}& message"),
    ];
    out.parameters("std::ostream& operator<<(", &parameters, ");");
    errors(out, includes, context, item);
}

/// Returns `true` for a required field that begins unset. A list begins empty. A struct or a choice begins with unset
/// fields.
fn must_be_set(context: &Context<'_>, ty: &Type) -> bool {
    match ty {
        Type::Array(_) => false,
        Type::Named(named) => matches!(context.package.item(named).shape, Shape::Enum(..)),
        _ => true,
    }
}

/// Adds the standard headers that the type of a field needs.
fn used(includes: &mut Includes, ty: &Type) {
    match ty {
        Type::Int(_) | Type::TimestampMs | Type::TimestampS => includes.standard("cstdint"),
        Type::String => includes.standard("string"),
        Type::Array(item) => {
            includes.standard("vector");
            used(includes, item);
        }
        Type::Bool | Type::Float(_) | Type::Base64 | Type::Json | Type::Named(_) => {}
    }
}

/// Returns a constant as comments write it.
pub fn spelled(value: &Expr<'_>) -> String {
    match value {
        Expr::Value(item, value) => format!("{}::{}", item.ty.name, value.name),
        Expr::Bool(value) => value.to_string(),
        Expr::Int(value) => value.to_string(),
        Expr::Text(text) => literal(text),
        _ => String::new(),
    }
}

/// Writes the enum of the errors that a command declares, next to its request.
fn errors(out: &mut Source, includes: &mut Includes, context: &Context<'_>, item: &Item<'_>) {
    let package = &context.package;
    let Some((command, name)) = package.declared_by(item) else {
        return;
    };
    includes.add(&["cstdint"], &["call"]);
    out.documented(&about::errors(context, command));
    let open = format!("enum class {name} : std::int64_t {{");
    out.enclose(&open, "};", |out| {
        for (error, result) in package.errors(command) {
            out.docs(&about::error(error, result.of));
            let code = integer(result.code.into());
            out.line(format!("{} = {code},", result.name));
        }
    });
    out.template("declare_error", &[("name", name)]);
}

fn enumeration(
    out: &mut Source,
    includes: &mut Includes,
    context: &Context<'_>,
    item: &Item<'_>,
    shape: &EnumType,
    values: &[Spelled<'_, EnumValue>],
) {
    let name = &item.ty.name;
    out.docs(&about::enumeration(context, item.ty.of, |docs| {
        if !shape.closed {
            docs.sentences(["其他值原样保留。", "Any other value is kept unchanged."]);
        }
    }));
    let each = |out: &mut Source| {
        for value in values {
            out.docs(&facts::value_docs(value));
            match &value.wire {
                Scalar::Number(Number::Int(wire)) => {
                    out.line(format!("{} = {},", value.name, integer(*wire)));
                }
                _ => out.line(format!("{},", value.name)),
            }
        }
    };
    let by_value = match shape.repr {
        EnumRepr::Int(kind) => {
            includes.standard("cstdint");
            let repr = integer_type(kind.name());
            out.enclose(&format!("enum class {name} : {repr} {{"), "};", each);
            name.to_string()
        }
        EnumRepr::String => {
            includes.add(&["optional", "string", "utility"], &[]);
            text_enum(out, name, each);
            format!("const {name}&")
        }
    };
    out.template("is_known", &[("by_value", &by_value)]);
    if has_states(shape) {
        process::declare(out, &by_value, shape);
    }
    let parameters = ["std::ostream& out".to_owned(), format!("{by_value} value")];
    out.parameters("std::ostream& operator<<(", &parameters, ");");
}

/// Writes an enum with string values. The enum keeps unknown values.
fn text_enum(out: &mut Source, name: &str, each: impl FnOnce(&mut Source)) {
    out.template("text_values", &[("name", name)]);
    out.deeper(1, |out| out.enclose("enum class Value {", "};", each));
    out.template("text_enum", &[("name", name)]);
    out.blank();
    out.deeper(1, |out| {
        for (operator, not) in [("==", ""), ("!=", "!")] {
            let parameters = [
                format!("const {name}& left"),
                format!("const {name}& right"),
            ];
            let equal = if not.is_empty() {
                "return left.wire_ == right.wire_;"
            } else {
                "return !(left == right);"
            };
            let open = format!("friend bool operator{operator}(");
            let whole = format!("{open}{}, {}) {{ {equal} }}", parameters[0], parameters[1]);
            out.line_or([&whole], |out| {
                out.parameters(&open, &parameters, ") {");
                out.line(format!("  {equal}\n}}"));
            });
        }
    });
    out.blank();
    out.line(" private:\n  std::string wire_;\n};");
}

fn choice(
    out: &mut Source,
    includes: &mut Includes,
    context: &Context<'_>,
    item: &Item<'_>,
    variants: &[Spelled<'_, Variant>],
) {
    includes.standard("variant");
    let mut docs = facts::type_docs(context, item);
    for variant in variants {
        let (ty, Text { zh, en }) = (context.name_of(&variant.ty), &variant.text);
        docs.joined([
            format!("- `{ty}`：{zh}"),
            format!("- `{ty}`: {en}"),
            format!("- `{ty}`：{zh} {en}"),
        ]);
        facts::variant_end(&mut docs, variant);
    }
    out.docs(&docs);
    let types: Vec<String> = variants
        .iter()
        .map(|variant| context.name_of(&variant.ty).to_owned())
        .collect();
    out.alias(&item.ty.name, "std::variant", &types);
}

/// Writes the specialization that ties a request or a report to its code.
fn operation(out: &mut Source, context: &Context<'_>, call: &Call<'_>) {
    let space = &namespace(context);
    let code = &call.operation.code.spelling;
    let is_command = call.operation.kind() == Kind::Command;
    let template = if is_command { "Command" } else { "Report" };
    out.line("template <>");
    let open = format!("struct {template}<{space}::{}> {{", call.request.ty.name);
    out.enclose(&open, "};", |out| {
        if is_command {
            out.line(format!(
                "using Response = {space}::{};",
                call.response.ty.name
            ));
        }
        out.line(format!("static constexpr std::uint16_t code = {code};"));
        let name = literal(&call.operation.name);
        out.line(format!("static constexpr const char* name = {name};"));
        if let Some(error) = context.package.error_type(call.operation) {
            let error = format!("{space}::{error}");
            out.line(format!("using Error = {error};"));
            let all: Vec<String> = context
                .package
                .errors(call.operation)
                .map(|(_, result)| format!("{error}::{}", result.name))
                .collect();
            out.parameters("static constexpr Error errors[] = {", &all, "};");
        }
        if let Some(effect) = call.operation.effect() {
            let effect = Case::Pascal.apply(effect.name());
            out.line(format!(
                "static constexpr Effect effect = Effect::{effect};"
            ));
        }
        process::declare_accepted(out, context, call.operation);
        if !is_command {
            let of = format!("const {space}::{}&", call.request.ty.name);
            for name in ["has_state", "is_end", "is_failure"] {
                out.line(format!("static bool {name}({of} report);"));
            }
            let parameters = [format!("{of} report"), format!("{of} previous")];
            out.parameters("static bool is_in_order(", &parameters, ");");
        }
    });
}
