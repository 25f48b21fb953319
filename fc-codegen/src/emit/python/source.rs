//! Source text in the layout of `ruff format`: docstrings, imports, and brackets that break if they exceed a line.

use super::literal::literal;
use crate::package::docs::Docs;
use crate::package::source::{Source, join};
use crate::package::style::{Comment, Style};
use crate::package::template::{Templates, templates};
use std::borrow::Cow;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::sync::LazyLock;

static TEMPLATES: Templates = LazyLock::new(|| templates(include_str!("templates.py.in")));

/// The style of the package's formatter.
pub static PYTHON: Style = Style {
    width: 120,
    indent: "    ",
    comment: Comment {
        open: "\"\"\"",
        mark: "",
        inner_mark: "",
        close: "\"\"\"",
        begins_at_once: true,
        prose: |line| Cow::Borrowed(line),
        code: |line| Cow::Borrowed(line),
        fence: |language| language,
    },
    link: |name| format!("`{name}`"),
    integer: crate::package::digits::grouped,
    redacted: "Never shown by `repr()`.",
    templates: &TEMPLATES,
};

/// The columns of a docstring's first line that its quotes take.
const QUOTES: usize = 4;

/// An expression or a statement, whose brackets break if it exceeds a line.
#[derive(Clone, Debug)]
pub enum Code {
    /// Text without brackets, or with brackets that never break.
    Text(String),
    /// A keyword and its value: `min=`.
    Named(String, Box<Code>),
    /// A call, parameters or a subscript. After a break, its content stays on one line if it fits.
    Call(String, Vec<Code>, &'static str),
    /// A list, tuple or dict. After a break, each item has a separate line.
    List(&'static str, Vec<Code>, &'static str),
    /// `A | B`.
    Union(Vec<String>),
}

impl Code {
    /// Returns `function(…)`.
    pub fn call(function: &str, arguments: impl IntoIterator<Item: Into<Self>>) -> Self {
        let arguments = arguments.into_iter().map(Into::into);
        Self::Call(format!("{function}("), arguments.collect(), ")")
    }

    /// Returns `name=value`.
    pub fn named(name: &str, value: impl Into<Self>) -> Self {
        Self::Named(format!("{name}="), Box::new(value.into()))
    }

    /// Returns a tuple.
    pub fn tuple(items: Vec<Self>) -> Self {
        Self::List("(", items, ")")
    }

    /// Returns the code on one line.
    pub fn flat(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Named(name, value) => [name, &*value.flat()].concat(),
            Self::Call(open, items, close) => [open, &*flat_items(items), close].concat(),
            Self::List("(", items, ")") if items.len() == 1 => format!("({},)", flat_items(items)),
            Self::List(open, items, close) => [open, &*flat_items(items), close].concat(),
            Self::Union(members) => members.join(" | "),
        }
    }

    /// Writes the code between `before` and `behind`.
    pub fn write(&self, out: &mut Source, before: &str, behind: &str) {
        let flat = self.flat();
        if out.has_room([before, &flat, behind]) {
            return out.line([before, &flat, behind].concat());
        }
        let (open, items, close, may_share) = match self {
            Self::Named(name, value) => {
                return value.write(out, &[before, name].concat(), behind);
            }
            Self::Call(open, items, close) if !items.is_empty() => {
                (open.as_str(), items, close, true)
            }
            Self::List(open, items, close) if !items.is_empty() => (*open, items, close, false),
            Self::Union(members) => {
                let mut members = members.clone();
                if let Some(last) = members.last_mut() {
                    last.push_str(behind);
                }
                return out.line([before, &members.join("\n| ")].concat());
            }
            _ => return out.line([before, &flat, behind].concat()),
        };
        let close = [close, behind].concat();
        out.enclose(&[before, open].concat(), &close, |out| {
            let shared = flat_items(items);
            if may_share && out.has_room([&shared]) {
                return out.line(shared);
            }
            for item in items {
                // A lone star or a comprehension also gets a comma.
                item.write(out, "", ",");
            }
        });
    }
}

fn flat_items(items: &[Code]) -> String {
    join(&items.iter().map(Code::flat).collect::<Vec<_>>())
}

impl From<String> for Code {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&str> for Code {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

/// A file of Python under construction.
pub trait Python {
    /// Writes the docstring of the item above, or of the enclosing item.
    fn docstring(&mut self, docs: &Docs<'_>);
    /// Writes `head:` and an indented body.
    fn suite(&mut self, head: &str, body: impl FnOnce(&mut Self));
    /// Writes the two empty lines between items at the level of a file.
    fn gap(&mut self);
    /// Writes `from module import a, b`, with each name once and in the linter's order.
    fn import_from(&mut self, module: &str, names: &[&str]);
    /// Writes an import with a line for each name. A new name therefore changes no other line.
    fn import_each(&mut self, module: &str, names: &[&str]);
}

impl Python for Source {
    fn docstring(&mut self, docs: &Docs<'_>) {
        let comment = &PYTHON.comment;
        let width = self.room().saturating_sub(QUOTES);
        let mut lines = Vec::new();
        docs.lines(self.languages(), comment, width, |line| {
            lines.push(line.trim_end().to_owned());
        });
        let text = lines.join("\n");
        // Triple quotes would end the docstring. A raw string keeps backslashes.
        let text = text.replace("\"\"\"", "'''");
        let open = if text.contains('\\') {
            "r\"\"\""
        } else {
            "\"\"\""
        };
        let pad = if text.starts_with('"') { " " } else { "" };
        let lines: Vec<&str> = text.lines().collect();
        match lines.as_slice() {
            [] => {}
            [only] if !only.ends_with('\\') => {
                let end = if only.ends_with('"') { " " } else { "" };
                self.line([open, pad, only, end, "\"\"\""].concat());
            }
            lines => {
                self.line([open, pad, &lines.join("\n")].concat());
                self.line("\"\"\"");
            }
        }
    }

    fn suite(&mut self, head: &str, body: impl FnOnce(&mut Self)) {
        self.enclose(&[head, ":"].concat(), "", body);
    }

    fn gap(&mut self) {
        self.blank();
        self.line("\n");
    }

    fn import_from(&mut self, module: &str, names: &[&str]) {
        let joined = join(&sorted(names, str::to_lowercase));
        let line = format!("from {module} import {joined}");
        match names {
            [] => {}
            _ if self.has_room([&line]) => self.line(line),
            _ => self.import_each(module, names),
        }
    }

    fn import_each(&mut self, module: &str, names: &[&str]) {
        let names = sorted(names, str::to_lowercase);
        self.lines(&format!("from {module} import ("), &names, ")");
    }
}

impl Code {
    /// Writes a union after `before`, in parentheses if it exceeds a line.
    pub fn write_in_parentheses(&self, out: &mut Source, before: &str) {
        let flat = self.flat();
        out.line_or([before, &flat], |out| {
            out.enclose(&[before, "("].concat(), ")", |out| self.write(out, "", ""));
        });
    }
}

/// Writes `before = "text"`. A long text has parentheses and several lines.
pub fn assign_text(out: &mut Source, before: &str, text: &str) {
    let flat = literal(text);
    if out.has_room([before, " = ", &flat]) {
        return out.line([before, " = ", &flat].concat());
    }
    out.enclose(&[before, " = ("].concat(), ")", |out| {
        let mut rest = text;
        while !rest.is_empty() {
            let (line, further) = rest.split_at(end_of_line(out, rest));
            out.line(literal(line));
            rest = further;
        }
    });
}

/// Returns the length of the text that fits on a line. The line ends at a comma, if it has one.
fn end_of_line(out: &Source, text: &str) -> usize {
    let mut fitting = 0;
    let mut comma = None;
    for (index, character) in text.char_indices() {
        let end = index + character.len_utf8();
        let (line, _) = text.split_at(end);
        if !out.has_room([&literal(line)]) {
            break;
        }
        fitting = end;
        if character == ',' {
            comma = Some(end);
        }
    }
    if fitting == text.len() {
        return fitting;
    }
    comma.unwrap_or(fitting).max(1)
}

/// Writes a function. `open` is the start of its first line: `async def name(`.
pub fn method(
    out: &mut Source,
    open: &str,
    parameters: &[&str],
    returns: &str,
    body: impl FnOnce(&mut Source),
) {
    let parameters = parameters.iter().map(|it| Code::from(*it));
    let signature = Code::Call(open.to_owned(), parameters.collect(), ")");
    signature.write(out, "", &format!(" -> {returns}:"));
    out.enclose("", "", body);
}

/// Writes `before(a, b)behind`, with each item on a separate line. A new item therefore changes no other line.
///
/// The formatter never breaks the brackets of a single item.
pub fn tuple(out: &mut Source, before: &str, items: &[String], behind: &str) {
    match items {
        [] => out.line([before, "()", behind].concat()),
        [only] => out.line([before, "(", only, ",)", behind].concat()),
        items => out.lines(&[before, "("].concat(), items, &[")", behind].concat()),
    }
}

/// Writes `__all__`, in the linter's order.
pub fn exported(out: &mut Source, names: &[&str]) {
    let names = sorted(names, str::to_owned);
    let names = names.iter().map(|name| format!("\"{name}\""));
    out.lines("__all__ = [", &names.collect::<Vec<_>>(), "]");
}

/// Sorts names like the linter: constants, then classes, then other names.
///
/// Numbers in names compare by value.
pub fn sorted<'n>(names: &[&'n str], folded: fn(&str) -> String) -> Vec<&'n str> {
    let keyed = names.iter().map(|name| ((kind(name), folded(name)), *name));
    let keyed: BTreeMap<(u8, String), &str> = keyed.collect();
    let mut keyed: Vec<_> = keyed.into_iter().collect();
    keyed.sort_by(|((kind, one), _), ((other_kind, other), _)| {
        kind.cmp(other_kind).then_with(|| natural(one, other))
    });
    keyed.into_iter().map(|(_, name)| name).collect()
}

fn kind(name: &str) -> u8 {
    let is_upper = |c: char| c.is_ascii_uppercase();
    if name.len() > 1 && !name.contains(|c: char| c.is_ascii_lowercase()) {
        0
    } else if name.starts_with(is_upper) {
        1
    } else {
        2
    }
}

/// Compares strings by character, and numbers in them by value.
fn natural(one: &str, other: &str) -> Ordering {
    let (mut one, mut other) = (one, other);
    loop {
        let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let (mine, yours) = (digits(one), digits(other));
        let order = if mine > 0 && yours > 0 {
            let ((left, _), (right, _)) = (one.split_at(mine), other.split_at(yours));
            mine.cmp(&yours).then_with(|| left.cmp(right))
        } else {
            one.chars().next().cmp(&other.chars().next())
        };
        if order != Ordering::Equal || one.is_empty() {
            return order;
        }
        let step = |text: &str, digits: usize| match digits {
            0 => text.chars().next().map_or(0, char::len_utf8),
            digits => digits,
        };
        (one, other) = (
            one.split_at(step(one, mine)).1,
            other.split_at(step(other, yours)).1,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fc_spec::model::Languages;

    fn written(code: &Code, before: &str, behind: &str) -> String {
        let mut out = Source::new(&PYTHON, Languages::All);
        code.write(&mut out, before, behind);
        out.finish()
    }

    #[test]
    fn brackets_open_when_they_have_to() {
        let call = |words: &[usize]| {
            let words = words.iter().map(|length| "a".repeat(*length));
            Code::call("f", words)
        };
        assert_eq!(written(&call(&[2, 3]), "x = ", ""), "x = f(aa, aaa)\n");
        let (fifty, sixty) = ("a".repeat(50), "a".repeat(60));
        assert_eq!(
            written(&call(&[50, 60]), "x = ", ".y"),
            format!("x = f(\n    {fifty}, {sixty}\n).y\n")
        );
        assert_eq!(
            written(&call(&[60, 60]), "", ""),
            format!("f(\n    {sixty},\n    {sixty},\n)\n")
        );
        let list = Code::List("[", vec![fifty.as_str().into(), sixty.as_str().into()], "]");
        assert_eq!(
            written(&list, "long = ", "  # so"),
            format!("long = [\n    {fifty},\n    {sixty},\n]  # so\n")
        );
        assert_eq!(written(&Code::tuple(vec!["a".into()]), "", ""), "(a,)\n");
    }

    #[test]
    fn names_are_in_the_order_of_the_linter() {
        let names = ["b", "Zebra10", "Zebra9", "alpha", "MAX", "Ape", "MAX"];
        let expected = ["MAX", "Ape", "Zebra9", "Zebra10", "alpha", "b"];
        assert_eq!(sorted(&names, str::to_owned), expected);
    }

    #[test]
    fn a_docstring_contains_the_text_of_the_spec() {
        let shown = |text: &'static str| {
            let mut docs = Docs::default();
            docs.paragraph(text);
            let mut out = Source::new(&PYTHON, Languages::All);
            out.docstring(&docs);
            out.finish()
        };
        for (text, expected) in [
            ("one", "\"\"\"one\"\"\"\n"),
            ("one\ntwo", "\"\"\"one\ntwo\n\"\"\"\n"),
            ("a \"word\"", "\"\"\"a \"word\" \"\"\"\n"),
            ("\"word\" a", "\"\"\" \"word\" a\"\"\"\n"),
            (r"\d", "r\"\"\"\\d\"\"\"\n"),
            ("a\"\"\"b", "\"\"\"a'''b\"\"\"\n"),
            (r"ends in \", "r\"\"\"ends in \\\n\"\"\"\n"),
        ] {
            assert_eq!(shown(text), expected);
        }
    }
}
