//! Constants of the spec as Kotlin expressions.

use super::text::{integer, literal};
use crate::package::expr::{Expr, Record};
use crate::package::items::Spelled;
use crate::package::joined::Joined;
use crate::package::source::Source;
use fc_spec::model::{Field, FloatKind, IntKind, Type};

/// The form of a message in source text.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// `Thing.builder().size(1).build()`: a single expression, so that long lists compile to small byte code.
    Chain,
    /// `Thing { size(1) }`: the form of handwritten code.
    Block,
}

/// Returns a constant of a type on one line.
pub fn expression(value: &Expr<'_>, ty: &Type) -> String {
    flat(value, ty, Form::Chain)
}

fn flat(value: &Expr<'_>, ty: &Type, form: Form) -> String {
    match value {
        Expr::Bool(value) => value.to_string(),
        Expr::Int(value) if *ty == Type::Int(IntKind::U64) => {
            format!("BigInteger(\"{value}\")")
        }
        Expr::Int(value) => integer(*value),
        Expr::Float(value) if *ty == Type::Float(FloatKind::F32) => format!("{value:?}f"),
        Expr::Float(value) => format!("{value:?}"),
        Expr::Text(text) => literal(text),
        Expr::Bytes(value) => bytes(value),
        Expr::Json(text) => format!("Json.of({})", literal(text)),
        Expr::Id(id, value) => format!("{id}({})", flat(value, ty.item(), form)),
        Expr::List(items) => {
            let item = match ty {
                Type::Array(item) => item,
                other => other,
            };
            let items = items.iter().map(|it| flat(it, item, form)).joined(", ");
            format!("listOf({items})")
        }
        Expr::Record(made) | Expr::Choice(_, _, made) => record(made, form),
        Expr::Value(item, value) => format!("{}.{}", item.ty.name, value.name),
        Expr::Unlisted(item, value) => {
            format!("{}.of({})", item.ty.name, expression(value, &Type::Json))
        }
    }
}

/// Returns bytes on one line.
pub fn bytes(bytes: &[u8]) -> String {
    format!("Bytes.of(byteArrayOf({}))", signed(bytes).join(", "))
}

/// Converts bytes to the signed bytes of the JVM.
fn signed(bytes: &[u8]) -> Vec<String> {
    let bytes = bytes.iter();
    bytes.map(|byte| byte.cast_signed().to_string()).collect()
}

/// Returns a message on one line.
fn record(record: &Record<'_>, form: Form) -> String {
    let call = |(field, value): (&Spelled<'_, Field>, &Expr<'_>)| {
        format!("{}({})", field.name, flat(value, &field.ty, form))
    };
    let calls: Vec<String> = set(record).map(call).collect();
    let name = &record.item.ty.name;
    match form {
        Form::Chain => {
            let mut chain = vec![format!("{name}.builder()")];
            chain.extend(calls);
            chain.push("build()".to_owned());
            chain.join(".")
        }
        Form::Block if calls.is_empty() => format!("{name} {{}}"),
        Form::Block => format!("{name} {{ {} }}", calls.join("; ")),
    }
}

/// Returns the number of messages in a constant, itself included.
fn messages(value: &Expr<'_>) -> usize {
    match value {
        Expr::List(items) => items.iter().map(messages).sum(),
        Expr::Record(made) | Expr::Choice(_, _, made) => {
            1 + set(made).map(|(_, value)| messages(value)).sum::<usize>()
        }
        _ => 0,
    }
}

/// Returns `true` if the constant may be on one line.
fn is_flat(value: &Expr<'_>, form: Form) -> bool {
    messages(value) < 2 && (form == Form::Chain || has_short_blocks(value))
}

/// Returns `true` if no block has two statements. Each of two statements would need a separate line.
fn has_short_blocks(value: &Expr<'_>) -> bool {
    match value {
        Expr::List(items) => items.iter().all(has_short_blocks),
        Expr::Record(made) | Expr::Choice(_, _, made) => set(made).count() < 2,
        _ => true,
    }
}

/// Returns the fields of a message that have a value.
fn set<'r, 'v>(
    record: &'r Record<'v>,
) -> impl Iterator<Item = (&'v Spelled<'v, Field>, &'r Expr<'v>)> {
    let members = record.members.iter();
    members.filter_map(|(field, value)| Some((*field, value.as_ref()?)))
}

/// Writes a constant between `before` and `behind`. The constant has several lines if it exceeds one.
pub fn laid_out(
    out: &mut Source,
    before: &str,
    value: &Expr<'_>,
    ty: &Type,
    behind: &str,
    form: Form,
) {
    let text = flat(value, ty, form);
    if out.has_room([before, &text, behind]) && is_flat(value, form) {
        return out.line([before, &text, behind].concat());
    }
    match value {
        Expr::List(items) => {
            let item = match ty {
                Type::Array(item) => item,
                other => other,
            };
            out.enclose(
                &[before, "listOf("].concat(),
                &[")", behind].concat(),
                |out| {
                    if items.iter().all(|it| matches!(it, Expr::Int(_))) {
                        let items: Vec<String> =
                            items.iter().map(|it| flat(it, item, form)).collect();
                        return out.fill(&items, ",");
                    }
                    for value in items {
                        laid_out(out, "", value, item, ",", form);
                    }
                },
            );
        }
        Expr::Bytes(bytes) => {
            let open = [before, "Bytes.of(byteArrayOf("].concat();
            let close = ["))", behind].concat();
            out.enclose(&open, &close, |out| out.fill(&signed(bytes), ","));
        }
        Expr::Record(made) | Expr::Choice(_, _, made) => {
            record_laid_out(out, before, made, behind, form);
        }
        _ => out.line([before, &text, behind].concat()),
    }
}

/// Writes a message on several lines.
fn record_laid_out(out: &mut Source, before: &str, made: &Record<'_>, behind: &str, form: Form) {
    let name = &made.item.ty.name;
    let (open, dot, close) = match form {
        Form::Chain => (format!("{before}{name}.builder()"), ".", String::new()),
        Form::Block => (format!("{before}{name} {{"), "", ["}", behind].concat()),
    };
    out.enclose(&open, &close, |out| {
        for (field, value) in set(made) {
            let call = format!("{dot}{}(", field.name);
            laid_out(out, &call, value, &field.ty, ")", form);
        }
        if form == Form::Chain {
            out.line([".build()", behind].concat());
        }
    });
}
