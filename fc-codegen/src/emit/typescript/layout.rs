//! Values in the layout of Biome: on one line if they fit, except tables.

use super::source::literal;
use crate::package::source::{Source, join};
use std::borrow::Cow;

/// A value before it is laid out.
#[derive(Clone, Debug)]
pub enum Layout {
    /// Text that stays on one line at any length.
    Atom(String),
    Number(String),
    /// A string literal, which may move to the next line.
    Text(String),
    /// `{ key: value }`.
    Object(Vec<(String, Layout)>),
    /// An object with each key on a separate line.
    Lines(Vec<(String, Layout)>),
    /// `[value]`.
    List(Vec<Layout>),
    /// A prefix and a suffix around another value: `new Uint8Array(`, `)`.
    Around(Cow<'static, str>, Box<Layout>, &'static str),
}

impl Layout {
    pub fn text(text: &str) -> Self {
        Self::Text(literal(text))
    }

    /// Returns a string literal, or `null`.
    pub fn text_or_null(text: Option<&str>) -> Self {
        text.map_or_else(|| Self::word("null"), Self::text)
    }

    pub fn number(number: impl Into<i128>) -> Self {
        Self::Number(number.into().to_string())
    }

    pub fn list(items: impl IntoIterator<Item = Self>) -> Self {
        Self::List(items.into_iter().collect())
    }

    pub fn object<K: Into<String>>(members: impl IntoIterator<Item = (K, Self)>) -> Self {
        let members = members.into_iter();
        Self::Object(members.map(|(key, value)| (key.into(), value)).collect())
    }

    /// Returns an object with each key on a separate line.
    pub fn lines<K: Into<String>>(members: impl IntoIterator<Item = (K, Self)>) -> Self {
        let members = members.into_iter();
        Self::Lines(members.map(|(key, value)| (key.into(), value)).collect())
    }

    /// Returns a word of the language, or a name.
    pub fn word(word: impl Into<String>) -> Self {
        Self::Atom(word.into())
    }

    /// Returns a name in a module, or in a constant of a module.
    pub fn path<const N: usize>(names: [&str; N]) -> Self {
        Self::Atom(names.join("."))
    }

    /// Returns `true` for a member that is omitted if it is `false`.
    pub fn flag(is: bool) -> Option<Self> {
        is.then(|| Self::word("true"))
    }

    pub fn texts<S: AsRef<str>>(texts: &[S]) -> Self {
        Self::List(texts.iter().map(|text| Self::text(text.as_ref())).collect())
    }

    /// Returns the number of members of an object, and the number of items of a list.
    fn parts(&self) -> (usize, usize) {
        match self {
            Self::Object(members) | Self::Lines(members) => (members.len(), 0),
            Self::List(items) => (0, items.len()),
            _ => (0, 0),
        }
    }

    /// Returns `true` if the value never fits one line.
    ///
    /// Lists of several objects, or of several lists, are tables.
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

    /// Returns the value on one line.
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

    /// Writes the value between `head` and `tail`.
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
            // At the start of a line, a break gives the text no more room.
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
                        for item in items {
                            item.write(out, "", ",");
                        }
                    }
                });
            }
            Self::Around(open, inner, close) => {
                inner.write(out, &[head, open].concat(), &[close, tail].concat());
            }
        }
    }
}

/// The members of an object, without the absent ones.
#[derive(Clone, Debug, Default)]
pub struct Members(Vec<(String, Layout)>);

impl Members {
    /// Adds a member, unless it is absent.
    pub fn with(mut self, key: &str, value: impl Into<Option<Layout>>) -> Self {
        self.0.extend(value.into().map(|it| (key.to_owned(), it)));
        self
    }

    pub fn object(self) -> Layout {
        Layout::Object(self.0)
    }

    /// Returns an object; `None` without members.
    pub fn some_object(self) -> Option<Layout> {
        (!self.0.is_empty()).then(|| self.object())
    }

    /// Returns an object with each key on a separate line.
    pub fn lines(self) -> Layout {
        Layout::Lines(self.0)
    }
}

/// Writes numbers with commas, as many to a line as fit.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emit::typescript::source::TYPESCRIPT;
    use fc_spec::model::Languages;

    #[test]
    fn values_break_as_biome_breaks_them() {
        let number = |value: i32| Layout::Number(value.to_string());
        let pair =
            |value| Layout::Object(vec![("a".into(), number(value)), ("b".into(), number(2))]);
        let mut out = Source::new(&TYPESCRIPT, Languages::All);
        Layout::List(vec![pair(1)]).write(&mut out, "const x = ", "");
        Layout::List(vec![pair(1), pair(3)]).write(&mut out, "const x = ", "");
        Layout::List((0..70).map(number).collect()).write(&mut out, "const x = ", "");
        let text = out.finish();
        let expected = "const x = [{ a: 1, b: 2 }]\nconst x = [\n  { a: 1, b: 2 },\n  { a: 3, b: 2 },\n]\nconst x = [\n  0, 1,";
        assert!(text.starts_with(expected), "{text}");
    }
}
