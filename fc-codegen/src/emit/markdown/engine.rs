//! The template engine, set up for Markdown.
//!
//! `t(zh, en, …)` in a template is a fixed phrase in both languages. `{0}` and `{1}` are its further arguments. Output
//! without a filter is escaped for a table cell, the strictest place, and does not count as a sentence of the spec.
//! Printing nothing, a list or an object is an error of the template.

use super::escape::{self, Slot};
use super::links::Link;
use super::places::{Kept, Reference};
use super::terms::marked;
use fc_spec::model::Lang;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Rest, Serde, Value, ValueKind};
use minijinja::{AutoEscape, Environment, Error, ErrorKind, Output, State, UndefinedBehavior};
use std::borrow::Cow;

/// Lets a view contain these types.
macro_rules! shown {
    ($($ty:ty),*) => {
        $(impl From<$ty> for Value {
            fn from(shown: $ty) -> Self {
                Self::from(Serde(shown))
            }
        })*
    };
}

shown!(Kept, Link, Reference);

macro_rules! templates {
    ($($name:literal)*) => {
        &[$(($name, include_str!(concat!("templates/", $name)))),*]
    };
}

const TEMPLATES: &[(&str, &str)] = templates! {
    "parts.md.j2"
    "operation.md.j2"
    "index.md.j2"
    "wire.md.j2"
    "codes.md.j2"
    "types.md.j2"
    "results.md.j2"
    "tables.md.j2"
    "entities.md.j2"
    "places.md.j2"
    "glossary.md.j2"
    "changelog.md.j2"
    "open-questions.md.j2"
    "language.md.j2"
    "errors.md.j2"
};

/// Filters for sentences of the spec. They mark their output.
const SENTENCES: [(&str, Slot<'_>); 4] = [
    ("text", Slot::Line),
    ("cell", Slot::Cell),
    ("label", Slot::Label),
    ("prose", Slot::Prose),
];

/// Filters for names and values.
const NAMES: [(&str, Slot<'_>); 6] = [
    ("code", Slot::Code),
    ("code_cell", Slot::CodeCell),
    ("diagram", Slot::Diagram),
    ("yaml", Slot::FrontMatter),
    ("attribute", Slot::Attribute),
    ("target", Slot::Target),
];

pub(super) struct Engine {
    environment: Environment<'static>,
}

impl Engine {
    /// Sets up the parts that both languages share. Syntax and escaping come before the templates, because loading a
    /// template fixes them.
    pub(super) fn new() -> Result<Self, Error> {
        let mut environment = Environment::new();
        let mut syntax = SyntaxConfig::builder();
        syntax
            .trim_blocks(true)
            .lstrip_blocks(true)
            .keep_trailing_newline(true);
        environment.set_syntax(syntax.build()?);
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        environment.set_auto_escape_callback(|_| AutoEscape::Custom("markdown".into()));
        environment.set_formatter(print);
        for (name, slot) in SENTENCES {
            environment.add_filter(name, move |source: &str| {
                safe(marked(&escape::write(source, slot)))
            });
        }
        for (name, slot) in NAMES {
            environment.add_filter(name, move |source: &str| safe(escape::write(source, slot)));
        }
        // Markdown keeps only this space at the start of a cell.
        environment.add_filter("indent", |depth: usize| safe("\u{2003}".repeat(depth)));
        environment.add_filter("fence", |source: &str, language: &str| {
            safe(escape::write(source, Slot::Fence(language)))
        });
        for (name, source) in TEMPLATES {
            environment.add_template(name, source)?;
        }
        Ok(Self { environment })
    }

    /// Returns an engine for pages of one language.
    pub(super) fn speaking(&self, lang: Lang) -> Self {
        let mut environment = self.environment.clone();
        environment.add_function("t", move |zh: &str, en: &str, arguments: Rest<Value>| {
            phrase(lang.pick(zh, en), &arguments)
        });
        Self { environment }
    }

    /// Renders a page, before [`tidy`]. The spec's sentences are marked.
    pub(super) fn render(&self, template: &str, view: Value) -> Result<String, Error> {
        self.environment.get_template(template)?.render(view)
    }
}

/// Reduces several blank lines to one and removes those at the end. Code stays unchanged.
pub(super) fn tidy(page: &str) -> String {
    let mut out = String::with_capacity(page.len());
    let mut fence: Option<&str> = None;
    let mut blank = true;
    for line in page.lines() {
        let ticks = line.len() - line.trim_start_matches('`').len();
        match fence {
            Some(open) if line == open => fence = None,
            None if ticks >= 3 => fence = line.get(..ticks),
            _ => {}
        }
        let line = if fence.is_none() {
            line.trim_end()
        } else {
            line
        };
        if line.is_empty() && blank && fence.is_none() {
            continue;
        }
        blank = line.is_empty();
        out.push_str(line);
        out.push('\n');
    }
    out.truncate(out.trim_end().len());
    out.push('\n');
    out
}

fn safe(markdown: String) -> Value {
    Value::from_safe_string(markdown)
}

/// Returns a phrase with its arguments. Braces in an argument are not replaced.
fn phrase(pattern: &str, arguments: &[Value]) -> Result<Value, Error> {
    let mut out = String::with_capacity(pattern.len());
    let mut rest = pattern;
    while let Some((before, behind)) = rest.split_once('{') {
        out.push_str(before);
        let named = behind.split_once('}').and_then(|(index, rest)| {
            let index: usize = index.parse().ok()?;
            Some((arguments.get(index)?, rest))
        });
        rest = if let Some((argument, rest)) = named {
            out.push_str(&spelled(argument)?);
            rest
        } else {
            out.push('{');
            behind
        };
    }
    out.push_str(rest);
    Ok(safe(out))
}

fn print(out: &mut Output<'_>, _: &mut State<'_, '_>, value: &Value) -> Result<(), Error> {
    out.write_str(&spelled(value)?).map_err(Error::from)
}

/// Returns a value in the spelling of JSON and Rust. Strings are escaped unless they are Markdown already.
fn spelled(value: &Value) -> Result<Cow<'_, str>, Error> {
    match (value.kind(), value.as_str()) {
        (ValueKind::Bool, _) => Ok(if value.is_true() { "true" } else { "false" }.into()),
        (ValueKind::Number, _) => Ok(value.to_string().into()),
        (ValueKind::String, Some(source)) if value.is_safe() => Ok(source.into()),
        (ValueKind::String, Some(source)) => Ok(escape::write(source, Slot::Cell).into()),
        (kind, _) => {
            let message = format!("a template prints {kind}, which has no spelling in Markdown");
            Err(Error::new(ErrorKind::InvalidOperation, message))
        }
    }
}
