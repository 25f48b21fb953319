//! `tables.rs`: the spec's tables of constants, each a function that answers its rows as typed values.

use super::context::Context;
use super::docs::Docs;
use super::messages::extra_name;
use super::names::{ident, integer, literal, pascal};
use super::source::Source;
use fc_spec::model::{
    EnumType, Field, Number, OneOf, Scalar, StructType, Table, Type, TypeShape, Value, WireForm,
};
use std::collections::BTreeSet;

/// The file.
pub fn file(context: &Context<'_>) -> String {
    let mut rows = Source::default();
    let mut used = Used::default();
    for table in &context.model.tables {
        rows.blank();
        table_function(&mut rows, &mut used, context, table);
    }

    let mut out = Source::default();
    let mut docs = Docs::default();
    docs.paragraph("规范公布的常量表。");
    docs.paragraph("Tables of constants that the spec publishes.");
    out.inner_docs(&docs);
    out.blank();
    out.import("super::messages", &used.types.iter().collect::<Vec<_>>());
    out.import("fc_runtime", &used.runtime.iter().collect::<Vec<_>>());
    out.blank();
    out.append(&rows);
    out.finish()
}

/// What the file has to import.
#[derive(Default)]
struct Used<'m> {
    types: BTreeSet<&'m str>,
    runtime: BTreeSet<&'static str>,
}

fn table_function<'m>(
    out: &mut Source,
    used: &mut Used<'m>,
    context: &Context<'m>,
    table: &'m Table,
) {
    let mut docs = Docs::of(&table.title);
    docs.text(&table.about);
    docs.paragraph(context.links(&table.location, "reference/tables.md"));
    out.docs(&docs);
    out.line("#[must_use]");
    used.types.insert(&table.row);
    out.block(
        format!("pub fn {}() -> Vec<{}>", ident(&table.id), table.row),
        |out| {
            let rows: Vec<Expression> = table
                .rows
                .iter()
                .map(|row| named(used, context, &table.row, row))
                .collect();
            Expression::List(rows).print(out, "", "");
        },
    );
}

/// A value as Rust, laid out when it is printed.
enum Expression {
    /// One token or a short call.
    Leaf(String),
    /// `vec![…]`.
    List(Vec<Expression>),
    /// `Name { field: value }`.
    Struct(String, Vec<(String, Expression)>),
    /// `Some(value)`, `Choice::Variant(value)`.
    Wrapped(String, Box<Expression>),
}

impl Expression {
    /// On one line, unless it holds a struct.
    fn flat(&self) -> Option<String> {
        match self {
            Self::Leaf(text) => Some(text.clone()),
            Self::List(items) if items.is_empty() => Some("Vec::new()".to_owned()),
            Self::List(items) => {
                let items: Option<Vec<String>> = items.iter().map(Self::flat).collect();
                let items = items?.join(", ");
                (items.len() <= 50).then(|| format!("vec![{items}]"))
            }
            Self::Struct(..) => None,
            Self::Wrapped(name, value) => Some(format!("{name}({})", value.flat()?)),
        }
    }

    fn print(&self, out: &mut Source, before: &str, after: &str) {
        if let Some(text) = self.flat() {
            out.line(format!("{before}{text}{after}"));
            return;
        }
        match self {
            Self::Leaf(_) => {}
            Self::List(items) => match items.as_slice() {
                [only] => only.print(out, &format!("{before}vec!["), &format!("]{after}")),
                items => out.enclose(&format!("{before}vec!["), &format!("]{after}"), |out| {
                    for item in items {
                        item.print(out, "", ",");
                    }
                }),
            },
            Self::Struct(name, fields) => {
                out.enclose(
                    &format!("{before}{name} {{"),
                    &format!("}}{after}"),
                    |out| {
                        for (name, value) in fields {
                            value.print(out, &format!("{name}: "), ",");
                        }
                    },
                );
            }
            Self::Wrapped(name, value) => {
                value.print(out, &format!("{before}{name}("), &format!("){after}"));
            }
        }
    }
}

fn named<'m>(
    used: &mut Used<'m>,
    context: &Context<'m>,
    name: &'m str,
    value: &'m Value,
) -> Expression {
    used.types.insert(name);
    match context.type_named(name).map(|ty| &ty.shape) {
        Some(TypeShape::Struct(shape)) => structure(used, context, name, shape, value),
        Some(TypeShape::Enum(shape)) => Expression::Leaf(enumeration(name, shape, value)),
        Some(TypeShape::OneOf(shape)) => choice(used, context, name, shape, value),
        None => Expression::Leaf(String::new()),
    }
}

fn structure<'m>(
    used: &mut Used<'m>,
    context: &Context<'m>,
    name: &str,
    shape: &'m StructType,
    value: &'m Value,
) -> Expression {
    let mut fields: Vec<(String, Expression)> = shape
        .fields
        .iter()
        .map(|field| {
            let expression = match value.get(&field.wire) {
                Some(value) => {
                    let expression = typed(used, context, field, &field.ty, value);
                    if field.optional {
                        Expression::Wrapped("Some".to_owned(), Box::new(expression))
                    } else {
                        expression
                    }
                }
                None => Expression::Leaf("None".to_owned()),
            };
            (ident(&field.name), expression)
        })
        .collect();
    used.runtime.insert("Extra");
    fields.push((
        extra_name(shape),
        Expression::Leaf("Extra::new()".to_owned()),
    ));
    Expression::Struct(name.to_owned(), fields)
}

fn choice<'m>(
    used: &mut Used<'m>,
    context: &Context<'m>,
    name: &str,
    shape: &'m OneOf,
    value: &'m Value,
) -> Expression {
    let fits = |ty: &str| match context.type_named(ty).map(|ty| &ty.shape) {
        Some(TypeShape::Struct(shape)) => shape
            .fields
            .iter()
            .filter(|field| !field.optional)
            .all(|field| value.get(&field.wire).is_some()),
        _ => false,
    };
    match shape.variants.iter().find(|variant| fits(&variant.ty)) {
        Some(variant) => Expression::Wrapped(
            format!("{name}::{}", pascal(&variant.name)),
            Box::new(named(used, context, &variant.ty, value)),
        ),
        None => Expression::Leaf(String::new()),
    }
}

fn enumeration(name: &str, shape: &EnumType, value: &Value) -> String {
    let known = shape
        .values
        .iter()
        .find(|known| match (&known.wire, value) {
            (Scalar::Number(known), Value::Number(value)) => known == value,
            (Scalar::String(known), Value::String(value)) => known == value,
            _ => false,
        });
    match known {
        Some(known) => format!("{name}::{}", pascal(&known.name)),
        None => format!("{name}::from({})", leaf(value)),
    }
}

fn typed<'m>(
    used: &mut Used<'m>,
    context: &Context<'m>,
    field: &Field,
    ty: &'m Type,
    value: &'m Value,
) -> Expression {
    match (ty, value) {
        (Type::Named(name), value) => named(used, context, name, value),
        (Type::Array(item), Value::Array(values)) => Expression::List(
            values
                .iter()
                .map(|value| typed(used, context, field, item, value))
                .collect(),
        ),
        (Type::Float(_), Value::Number(Number::Int(value))) => {
            Expression::Leaf(format!("{}.0", integer(*value)))
        }
        (Type::String, Value::String(text)) if text.is_empty() => {
            Expression::Leaf("String::new()".to_owned())
        }
        (Type::String, Value::String(text)) => {
            Expression::Leaf(format!("{}.to_owned()", literal(text)))
        }
        // A number or a bool that travels inside a string.
        (ty, Value::String(text)) if field.wire_form == WireForm::String => {
            let whole = text
                .bytes()
                .all(|byte| byte == b'-' || byte.is_ascii_digit());
            let point = if matches!(ty, Type::Float(_)) && whole {
                ".0"
            } else {
                ""
            };
            Expression::Leaf(format!("{text}{point}"))
        }
        (Type::Base64, Value::String(text)) => {
            used.runtime.insert("Bytes64");
            let bytes = decode_base64(text).into_iter();
            let bytes = bytes
                .map(|byte| Expression::Leaf(byte.to_string()))
                .collect();
            Expression::Wrapped("Bytes64".to_owned(), Box::new(Expression::List(bytes)))
        }
        (Type::Json, value) => {
            used.runtime.insert("Json");
            let text = literal(&value.to_string());
            Expression::Leaf(format!(
                "Json::new({text}).unwrap_or_else(|_| Json::null())"
            ))
        }
        (_, value) => Expression::Leaf(leaf(value)),
    }
}

fn leaf(value: &Value) -> String {
    match value {
        Value::Number(Number::Int(value)) => integer(*value),
        Value::String(text) => literal(text),
        other => other.to_string(),
    }
}

/// The bytes of a checked base64 text.
fn decode_base64(text: &str) -> Vec<u8> {
    const ALPHABET: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0u32, 0);
    for byte in text.bytes() {
        let Some(digit) = ALPHABET.iter().position(|&letter| letter == byte) else {
            break;
        };
        bits = bits << 6 | u32::try_from(digit).unwrap_or_default();
        count += 6;
        if count >= 8 {
            count -= 8;
            out.extend(u8::try_from(bits >> count & 0xFF));
        }
    }
    out
}
