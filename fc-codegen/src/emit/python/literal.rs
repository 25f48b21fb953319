//! Literals of Python, and constants built from them.

use super::source::Code;
use crate::package::digits::grouped;
use crate::package::expr::{Expr, Record};
use crate::package::items::Item;
use crate::package::literal::quoted;
use fc_spec::model::{Number, Scalar, has_unprintable, is_hidden};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Returns a string literal in the quotes that need fewer escapes. Double quotes are the default.
pub fn literal(text: &str) -> String {
    let count = |quote| text.matches(quote).count();
    let quote = if count('"') > count('\'') { '\'' } else { '"' };
    if !has_unprintable(text) && !text.contains(['\\', quote]) {
        return format!("{quote}{text}{quote}");
    }
    quoted(text, quote, &[], |out, c| {
        let code = u32::from(c);
        let _ = match code {
            0..0x100 => write!(out, "\\x{code:02x}"),
            0x100..0x1_0000 => write!(out, "\\u{code:04x}"),
            _ => write!(out, "\\U{code:08x}"),
        };
    })
}

/// Returns a regular expression as a literal, which is raw if that needs no escapes.
pub fn regex(text: &str) -> String {
    let plain = |c: char| !(c.is_control() || is_hidden(c) || c == '"');
    if text.contains('\\') && text.chars().all(plain) {
        format!("r\"{text}\"")
    } else {
        literal(text)
    }
}

/// Returns a literal of bytes: `b"\xfc\xaa"`.
pub fn bytes(bytes: &[u8]) -> String {
    let has = |quote| bytes.contains(&quote);
    let quote = if has(b'"') && !has(b'\'') { '\'' } else { '"' };
    let mut out = format!("b{quote}");
    for &byte in bytes {
        let character = char::from(byte);
        let _ = match byte {
            b'\\' => write!(out, "\\\\"),
            _ if character == quote => write!(out, "\\x{byte:02x}"),
            0x20..0x7F => write!(out, "{character}"),
            _ => write!(out, "\\x{byte:02x}"),
        };
    }
    out.push(quote);
    out
}

pub fn number(number: &Number) -> String {
    match number {
        Number::Int(value) => grouped(*value),
        Number::Float(value) => float(*value),
    }
}

fn float(value: f64) -> String {
    format!("{value:?}")
}

/// Returns an enum value in its wire form.
pub fn wire(wire: &Scalar) -> String {
    match wire {
        Scalar::Number(value) => number(value),
        Scalar::String(text) => literal(text),
        Scalar::Bool(value) => boolean(*value).to_owned(),
    }
}

pub fn boolean(value: bool) -> &'static str {
    if value { "True" } else { "False" }
}

/// Builds constants of the spec, and collects the types that they name.
#[derive(Debug, Default)]
pub struct Constants {
    /// The types named so far.
    pub types: BTreeSet<String>,
    /// `true` if a constant names anything of the runtime.
    pub runtime: bool,
}

impl Constants {
    /// Returns a constant.
    pub fn value(&mut self, expr: &Expr<'_>) -> Code {
        self.runtime |= matches!(expr, Expr::Json(_) | Expr::Unlisted(..));
        Code::Text(match expr {
            Expr::Bool(value) => boolean(*value).to_owned(),
            Expr::Int(value) => grouped(*value),
            Expr::Float(value) => float(*value),
            Expr::Text(text) => literal(text),
            Expr::Bytes(value) => bytes(value),
            Expr::Json(text) => return Code::call("rt.Json", [literal(text)]),
            Expr::Value(item, value) => format!("{}.{}", self.named(item), value.name),
            Expr::Unlisted(_, value) => return Code::call("rt.Unknown", [self.value(value)]),
            Expr::Id(ty, value) => {
                self.types.insert((*ty).to_owned());
                return Code::call(ty, [self.value(value)]);
            }
            Expr::List(items) => {
                let items = items.iter().map(|item| self.value(item));
                return Code::List("[", items.collect(), "]");
            }
            Expr::Choice(_, _, held) | Expr::Record(held) => return self.record(held),
        })
    }

    /// Returns a message with a constant in each of its fields.
    pub fn record(&mut self, record: &Record<'_>) -> Code {
        let members = record.members.iter();
        let members = members.filter_map(|(field, value)| {
            let value = self.value(value.as_ref()?);
            Some(Code::named(&field.name, value))
        });
        let members: Vec<Code> = members.collect();
        Code::call(&self.named(record.item), members)
    }

    fn named(&mut self, item: &Item<'_>) -> String {
        let name = item.ty.name.to_string();
        self.types.insert(name.clone());
        name
    }
}

/// Returns a constant that names only types of its module.
pub fn constant(expr: &Expr<'_>) -> Code {
    Constants::default().value(expr)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts() {
        for (text, expected) in [
            ("站点", "\"站点\""),
            (r#"{"a":1}"#, r#"'{"a":1}'"#),
            (r#"it's "so""#, r#"'it\'s "so"'"#),
            ("a'b\"", r#""a'b\"""#),
            ("a\nb\u{202e}\u{7f}", r#""a\nb\u202e\x7f""#),
        ] {
            assert_eq!(literal(text), expected);
        }
        assert_eq!(regex(r"\d+"), r#"r"\d+""#);
        assert_eq!(regex(r#"\d""#), r#"'\\d"'"#);
        assert_eq!(bytes(b"\xfc\xaaa\"\\"), r#"b'\xfc\xaaa"\\'"#);
    }
}
