//! Types, numbers and strings in Kotlin.

use crate::package::context::Context;
use crate::package::digits::grouped;
use crate::package::docs::escape_links;
use crate::package::joined::Joined;
use crate::package::language::Case;
use crate::package::literal::quoted;
use crate::package::marks::FieldMarks;
use crate::package::style::{Comment, Style};
use crate::package::template::{Templates, templates};
use crate::package::types::in_lists;
use fc_spec::model::{Argument, Field, FloatKind, IntKind, Number, Scalar, Type, has_unprintable};
use std::borrow::Cow;
use std::fmt::Write as _;
use std::sync::LazyLock;

static TEMPLATES: Templates = LazyLock::new(|| templates(include_str!("templates.kt.in")));

/// The style of ktlint.
pub static STYLE: Style = Style {
    width: 120,
    indent: "    ",
    comment: Comment {
        open: "/**",
        mark: " *",
        inner_mark: " *",
        close: " */",
        begins_at_once: false,
        prose,
        code: closed,
        fence: |language| language,
    },
    link: |name| format!("[{name}]"),
    integer: grouped,
    redacted: "Never shown by `toString`.",
    templates: &TEMPLATES,
};

fn prose(line: &str) -> Cow<'_, str> {
    match escape_links(line) {
        Cow::Borrowed(line) => closed(line),
        Cow::Owned(line) => Cow::Owned(closed(&line).into_owned()),
    }
}

/// Breaks up the marks of nested comments in a line. Comments nest in Kotlin, so both marks matter.
fn closed(line: &str) -> Cow<'_, str> {
    if line.contains("/*") || line.contains("*/") {
        Cow::Owned(line.replace("/*", "/ *").replace("*/", "* /"))
    } else {
        Cow::Borrowed(line)
    }
}

/// Returns an integer for a `Long`, with digits in groups of three. Above `i64`, the `Long` has the same bits.
pub fn integer(value: i128) -> String {
    if value == i64::MIN.into() {
        return "Long.MIN_VALUE".to_owned();
    }
    if value > i64::MAX.into() {
        return format!("{}uL.toLong()", grouped(value));
    }
    grouped(value)
}

/// Returns an integer or a float.
pub fn number(number: &Number) -> String {
    match number {
        Number::Int(value) if *value > i64::MAX.into() => format!("BigInteger(\"{value}\")"),
        Number::Int(value) => integer(*value),
        Number::Float(value) => format!("{value:?}"),
    }
}

/// Returns a value in wire form as source text.
pub fn scalar(wire: &Scalar) -> String {
    match wire {
        Scalar::Number(Number::Int(value)) => integer(*value),
        Scalar::Number(value) => number(value),
        Scalar::String(text) => literal(text),
        Scalar::Bool(value) => value.to_string(),
    }
}

/// Returns a string literal. The literal is raw if that avoids escapes.
pub fn literal(text: &str) -> String {
    let is_plain = !has_unprintable(text) && !text.contains('$');
    if is_plain && text.contains(['"', '\\']) && !text.contains("\"\"\"") && !text.ends_with('"') {
        return format!("\"\"\"{text}\"\"\"");
    }
    quoted(text, '"', &['$'], |out, c| {
        for unit in c.encode_utf16(&mut [0; 2]) {
            // Writing to a `String` cannot fail.
            let _ = write!(out, "\\u{unit:04x}");
        }
    })
}

/// Returns the Kotlin type of a value.
pub fn type_of(context: &Context<'_>, ty: &Type) -> String {
    match ty {
        Type::Bool => "Boolean".to_owned(),
        Type::Int(IntKind::U64) => "BigInteger".to_owned(),
        Type::Int(IntKind::I64 | IntKind::U32) | Type::TimestampMs | Type::TimestampS => {
            "Long".to_owned()
        }
        Type::Int(_) => "Int".to_owned(),
        Type::Float(FloatKind::F32) => "Float".to_owned(),
        Type::Float(FloatKind::F64) => "Double".to_owned(),
        Type::String => "String".to_owned(),
        Type::Base64 => "Bytes".to_owned(),
        Type::Json => "Json".to_owned(),
        Type::Array(item) => format!("List<{}>", type_of(context, item)),
        Type::Named(named) => context.name_of(named).to_owned(),
    }
}

/// Returns the Kotlin type of a field. An id field has its id type, if one exists.
pub fn field_type(context: &Context<'_>, field: &Field) -> String {
    match context.package.id_of(field) {
        Some(id) => in_lists(&field.ty, &id.name, |item| format!("List<{item}>")),
        None => type_of(context, &field.ty),
    }
}

/// Returns the codec of a plain type.
pub fn plain_codec(ty: &Type) -> String {
    let name = match ty {
        Type::Bool => "BOOL",
        Type::Int(kind) => return format!("Types.{}", kind.name().to_uppercase()),
        Type::Float(kind) => return format!("Types.{}", kind.name().to_uppercase()),
        Type::TimestampMs | Type::TimestampS => "I64",
        Type::String => "STRING",
        Type::Base64 => "BASE64",
        Type::Json | Type::Array(_) | Type::Named(_) => "JSON",
    };
    format!("Types.{name}")
}

/// Returns the codec of a field, with its wire form and its constraints.
pub fn codec(context: &Context<'_>, field: &Field, marks: &FieldMarks<'_, '_>) -> String {
    let mut lists = 0;
    let mut inner = &field.ty;
    while let Type::Array(item) = inner {
        lists += 1;
        inner = item;
    }
    let mut out = match inner {
        Type::Named(named) => context.name_of(named).to_owned(),
        Type::Bool if marks.form == Some("number") => "Types.BOOL_AS_NUMBER".to_owned(),
        plain => plain_codec(plain),
    };
    if marks.form == Some("string") {
        out.push_str(".quoted()");
    }
    if marks.is_lenient {
        out.push_str(".lenient()");
    }
    let is_of_list = |argument: &Argument<'_>| matches!(argument, Argument::Range(..));
    let (of_list, of_items): (Vec<_>, Vec<_>) = marks
        .constraints
        .iter()
        .partition(|it| lists > 0 && is_of_list(&it.1));
    out.extend(of_items.into_iter().map(demand));
    if let Some(id) = context.package.id_of(field) {
        out = format!("Types.id({out}, ::{})", id.name);
    }
    for _ in 0..lists {
        out = format!("Types.list({out})");
    }
    out.extend(of_list.into_iter().map(demand));
    out
}

fn demand((name, argument): &(&str, Argument<'_>)) -> String {
    let value = match argument {
        Argument::Number(value) => number(value),
        Argument::Pattern(pattern) => literal(pattern.portable()),
        Argument::Values(taken) => taken.iter().map(scalar).joined(", "),
        Argument::Range(least, most) => match u32::try_from(*most) {
            Ok(most) if most < i32::MAX as u32 => format!("{least}, {most}"),
            _ => least.to_string(),
        },
    };
    format!(".{}({value})", Case::Camel.apply(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn string_literals() {
        for (text, expected) in [
            ("站点", "\"站点\""),
            ("a$b", "\"a\\$b\""),
            (r#"{"a":1}"#, r#""""{"a":1}""""#),
            (r#"{"$a":1}"#, r#""{\"\$a\":1}""#),
            ("ends with \"", r#""ends with \"""#),
            (r"\d", r#""""\d""""#),
            ("a\n\"b\"", r#""a\n\"b\"""#),
            ("a\u{202e}b", r#""a\u202eb""#),
        ] {
            assert_eq!(literal(text), expected);
        }
    }

    #[test]
    fn numbers_have_literals() {
        for (value, expected) in [
            (5656, "5656"),
            (-65_536, "-65_536"),
            (i64::MIN.into(), "Long.MIN_VALUE"),
            (u64::MAX.into(), "18_446_744_073_709_551_615uL.toLong()"),
        ] {
            assert_eq!(integer(value), expected);
        }
    }

    #[test]
    fn comment_text_cannot_end_the_comment() {
        assert_eq!(prose("a */ b /* [c]"), r"a * / b / * \[c\]");
        assert_eq!(closed("a */ b"), "a * / b");
    }
}
