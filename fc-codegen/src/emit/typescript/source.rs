//! TypeScript as prettier lays it out: comments, literals, values that break where they are too long for a line.

use crate::emit::stub::docs::{Docs, escape_links, turns_text_around};
use crate::emit::stub::source::join;
use crate::emit::stub::style::{Comment, Style};
use std::borrow::Cow;

pub use crate::emit::stub::source::Source;

/// TypeScript as this package is written.
pub static TYPESCRIPT: Style = Style {
    width: 120,
    indent: "  ",
    comment: Comment {
        open: "/**",
        mark: " *",
        close: " */",
        begins_at_once: false,
        prose,
        code: in_comment,
        fence: |language| language,
    },
    link: |name| format!("{{@link {name}}}"),
    elsewhere: |item| format!("messages.{}", item.ty.name),
    integer: |value| value.to_string(),
    redacted: "Left out of texts for people.",
};

/// Prose in which nothing ends the comment, links or is a tag by accident.
fn prose(line: &str) -> Cow<'_, str> {
    let line = escape_links(line);
    if !line.contains(['@', '*', '{']) {
        return line;
    }
    let mut out = String::with_capacity(line.len() + 4);
    let mut is_code = false;
    let mut before = ' ';
    for character in line.chars() {
        is_code ^= character == '`';
        let is_tag = character == '@' && !before.is_alphanumeric();
        out.push_str(match character {
            '/' if before == '*' => "\\",
            '@' if is_tag && !is_code => "\\",
            _ => "",
        });
        out.push(character);
        before = character;
    }
    Cow::Owned(out)
}

/// Code that does not end the comment.
fn in_comment(line: &str) -> Cow<'_, str> {
    if line.contains("*/") {
        Cow::Owned(line.replace("*/", "*\\/"))
    } else {
        Cow::Borrowed(line)
    }
}

/// The text of a block tag, on its one line.
pub fn tag_text(text: &str) -> String {
    let lines = text.lines().map(|line| prose(line.trim()));
    lines.collect::<Vec<_>>().join(" ")
}

/// A text as a literal, in those quotes that spare escapes.
pub fn literal(text: &str) -> String {
    let count = |quote| text.matches(quote).count();
    let quote = if count('\'') > count('"') { '"' } else { '\'' };
    let mut out = String::with_capacity(text.len() + 2);
    out.push(quote);
    for character in text.chars() {
        match character {
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            '\\' => out.push_str("\\\\"),
            c if c == quote => out.extend(['\\', c]),
            c if c.is_control() || turns_text_around(c) || matches!(c, '\u{2028}' | '\u{2029}') => {
                out.push_str(&format!("\\u{{{:x}}}", u32::from(c)));
            }
            c => out.push(c),
        }
    }
    out.push(quote);
    out
}

/// A float as a literal.
pub fn float(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A value before it is laid out.
#[derive(Clone, Debug)]
pub enum Layout {
    /// What stands on one line however long it is.
    Atom(String),
    /// A number.
    Number(String),
    /// A text, which may begin a line of its own.
    Text(String),
    /// `{ key: value }`.
    Object(Vec<(String, Layout)>),
    /// The same with each key on a line of its own.
    Lines(Vec<(String, Layout)>),
    /// `[value]`.
    List(Vec<Layout>),
    /// Around another: `new Uint8Array(`, `)`.
    Around(&'static str, Box<Layout>, &'static str),
}

impl Layout {
    /// A text.
    pub fn text(text: &str) -> Self {
        Self::Text(literal(text))
    }

    /// A number or a word.
    pub fn word(word: impl ToString) -> Self {
        Self::Atom(word.to_string())
    }

    /// Texts.
    pub fn texts<S: AsRef<str>>(texts: &[S]) -> Self {
        Self::List(texts.iter().map(|text| Self::text(text.as_ref())).collect())
    }

    /// How many parts it has, if it is an object, or else a list.
    fn parts(&self) -> (usize, usize) {
        match self {
            Self::Object(members) | Self::Lines(members) => (members.len(), 0),
            Self::List(items) => (0, items.len()),
            _ => (0, 0),
        }
    }

    /// Whether it is never on one line: lists of several objects, or of several lists, are tables.
    fn breaks(&self) -> bool {
        match self {
            Self::Atom(_) | Self::Number(_) | Self::Text(_) => false,
            Self::Lines(members) => !members.is_empty(),
            Self::Object(members) => members.iter().any(|(_, value)| value.breaks()),
            Self::List(items) => {
                let all = |parts: fn((usize, usize)) -> usize| {
                    items.len() > 1 && items.iter().all(|item| parts(item.parts()) > 1)
                };
                all(|parts| parts.0) || all(|parts| parts.1) || items.iter().any(Self::breaks)
            }
            Self::Around(_, inner, _) => inner.breaks(),
        }
    }

    /// On one line.
    pub fn flat(&self) -> String {
        match self {
            Self::Atom(text) | Self::Number(text) | Self::Text(text) => text.clone(),
            Self::Object(members) | Self::Lines(members) if members.is_empty() => "{}".to_owned(),
            Self::Object(members) | Self::Lines(members) => {
                let members = members.iter();
                let members: Vec<String> = members
                    .map(|(key, value)| [key, ": ", &value.flat()].concat())
                    .collect();
                ["{ ", &join(&members), " }"].concat()
            }
            Self::List(items) => {
                let items: Vec<String> = items.iter().map(Self::flat).collect();
                ["[", &join(&items), "]"].concat()
            }
            Self::Around(open, inner, close) => [open, &*inner.flat(), close].concat(),
        }
    }

    /// Writes it between `head` and `tail`.
    pub fn write(&self, out: &mut Source, head: &str, tail: &str) {
        if !self.breaks() {
            let flat = self.flat();
            let is_one = matches!(self, Self::Atom(_) | Self::Number(_));
            if is_one || out.has_room([head, &flat, tail]) {
                return out.line([head, &flat, tail].concat());
            }
        }
        match self {
            Self::Atom(_) | Self::Number(_) => {}
            // At the start of a line it has no better place.
            Self::Text(text) if head.is_empty() => out.line([text, tail].concat()),
            Self::Text(text) => {
                out.enclose(head.trim_end(), "", |out| out.line([text, tail].concat()));
            }
            Self::Object(members) | Self::Lines(members) => {
                out.enclose(&[head, "{"].concat(), &["}", tail].concat(), |out| {
                    for (key, value) in members {
                        value.write(out, &[key, ": "].concat(), ",");
                    }
                });
            }
            Self::List(items) => {
                out.enclose(&[head, "["].concat(), &["]", tail].concat(), |out| {
                    let are_numbers = items.iter().all(|item| matches!(item, Self::Number(_)));
                    if are_numbers {
                        fill(out, items);
                    } else {
                        items.iter().for_each(|item| item.write(out, "", ","));
                    }
                });
            }
            Self::Around(open, inner, close) => {
                inner.write(out, &[head, open].concat(), &[close, tail].concat());
            }
        }
    }
}

/// Numbers with commas, as many to a line as fit.
fn fill(out: &mut Source, items: &[Layout]) {
    let mut line = String::new();
    for item in items {
        let item = [&item.flat(), ","].concat();
        if !line.is_empty() && !out.has_room([&line, " ", &item]) {
            out.line(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(&item);
    }
    out.line(line);
}

/// `export type Name =` with each alternative and its comment on lines of their own. One alone has no bar.
pub fn alternatives(out: &mut Source, name: &str, all: &[(Docs<'_>, String)]) {
    let bar = if all.len() > 1 { "| " } else { "" };
    out.enclose(&format!("export type {name} ="), "", |out| {
        for (docs, alternative) in all {
            out.docs(docs);
            out.line([bar, alternative].concat());
        }
    });
}

/// A file of TypeScript.
pub fn file() -> Source {
    Source::new(&TYPESCRIPT)
}

/// `import type { a, b } from 'path'`, sorted.
pub fn import_types<S: AsRef<str>>(out: &mut Source, names: &[S], path: &str) {
    named(out, "import type", names, path);
}

/// `import { a, b } from 'path'`, sorted.
pub fn import<S: AsRef<str>>(out: &mut Source, names: &[S], path: &str) {
    named(out, "import", names, path);
}

/// `word { a, b } from 'path'`, sorted.
pub fn named<S: AsRef<str>>(out: &mut Source, word: &str, names: &[S], path: &str) {
    let mut names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    names.sort_unstable();
    names.dedup();
    let line = format!("{word} {{ {} }} from '{path}'", join(&names));
    match names.as_slice() {
        [] => {}
        // One alone is not broken.
        [_] => out.line(line),
        _ if out.has_room([&line]) => out.line(line),
        names => out.lines(&format!("{word} {{"), names, &format!("}} from '{path}'")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_have_the_quotes_that_spare_escapes() {
        for (text, expected) in [
            ("a", "'a'"),
            ("it's", "\"it's\""),
            ("\"it's\"", "'\"it\\'s\"'"),
            ("\\d\n\u{1}\u{202e}", "'\\\\d\\n\\u{1}\\u{202e}'"),
        ] {
            assert_eq!(literal(text), expected);
        }
    }

    #[test]
    fn comments_stay_comments() {
        for (text, expected) in [
            ("a */ b", "a *\\/ b"),
            ("@param `@x` a@b.c {@link}", "\\@param `@x` a@b.c {\\@link}"),
        ] {
            assert_eq!(prose(text), expected);
        }
    }

    #[test]
    fn values_break_as_prettier_breaks_them() {
        let number = |value: i32| Layout::Number(value.to_string());
        let pair =
            |value| Layout::Object(vec![("a".into(), number(value)), ("b".into(), number(2))]);
        let mut out = file();
        Layout::List(vec![pair(1)]).write(&mut out, "const x = ", "");
        Layout::List(vec![pair(1), pair(3)]).write(&mut out, "const x = ", "");
        Layout::List((0..70).map(number).collect()).write(&mut out, "const x = ", "");
        let text = out.finish();
        let expected = "const x = [{ a: 1, b: 2 }]\nconst x = [\n  { a: 1, b: 2 },\n  { a: 3, b: 2 },\n]\nconst x = [\n  0, 1,";
        assert!(text.starts_with(expected), "{text}");
    }
}
