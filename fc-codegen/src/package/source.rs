//! Builds source text: indentation, blank lines, comments, and lists that break when they exceed a line.
//!
//! The layout matches the language's formatter, so the output needs no formatting pass.

use super::docs::{Docs, columns_of};
use super::style::{Comment, Style};
use crate::package::joined::Joined;
use fc_spec::model::Languages;

/// A file, or a part of one.
#[derive(Clone, Debug)]
pub struct Source {
    style: &'static Style,
    /// The languages of the comments.
    languages: Languages,
    text: String,
    level: usize,
    /// `true` if a block was just opened.
    opened: bool,
}

impl Source {
    /// Creates an empty file in this style, with comments in these languages.
    pub fn new(style: &'static Style, languages: Languages) -> Self {
        Self {
            style,
            languages,
            text: String::new(),
            level: 0,
            opened: true,
        }
    }

    /// Creates an empty part of this file.
    pub fn part(&self) -> Self {
        Self::new(self.style, self.languages)
    }

    /// Returns the languages of the comments.
    pub fn languages(&self) -> Languages {
        self.languages
    }

    /// Returns the text written so far.
    pub fn finish(self) -> String {
        self.text
    }

    /// Appends another part, which was written at the level of a file.
    pub fn append(&mut self, part: &Self) {
        self.text.push_str(&part.text);
        self.opened &= part.text.is_empty();
    }

    /// Writes one line, or several laid out in advance, each at the current level.
    pub fn line(&mut self, text: impl AsRef<str>) {
        let mut rest = text.as_ref();
        while !rest.is_empty() {
            let (line, behind) = rest.split_once('\n').unwrap_or((rest, ""));
            if !line.is_empty() {
                self.indent();
                self.text.push_str(line);
            }
            self.text.push('\n');
            rest = behind;
            self.opened = false;
        }
    }

    /// Writes an empty line, except at the start of a file or block, or after another empty line.
    pub fn blank(&mut self) {
        if !(self.opened || self.text.ends_with("\n\n")) {
            self.text.push('\n');
        }
    }

    /// Writes a documentation comment on the next item.
    pub fn docs(&mut self, docs: &Docs<'_>) {
        self.comment(&self.style.comment, docs);
    }

    /// Writes a documentation comment on the enclosing item.
    pub fn inner_docs(&mut self, docs: &Docs<'_>) {
        let comment = self.style.comment;
        let mark = comment.inner_mark;
        self.comment(&Comment { mark, ..comment }, docs);
    }

    /// Writes an empty line, and a documentation comment on the next item.
    pub fn documented(&mut self, docs: &Docs<'_>) {
        self.blank();
        self.docs(docs);
    }

    /// Writes a comment of this kind.
    pub fn comment(&mut self, comment: &Comment, docs: &Docs<'_>) {
        let width = self.room().saturating_sub(comment.mark.len() + 1);
        if comment.open.is_empty() {
            let languages = self.languages;
            return docs.lines(languages, comment, width, |line| {
                self.marked(comment.mark, line);
            });
        }
        let mut lines = Vec::new();
        docs.lines(self.languages, comment, width, |line| {
            lines.push(line.to_owned());
        });
        let gap = if comment.begins_at_once { "" } else { " " };
        let close = comment.close.trim_start();
        match lines.as_slice() {
            [] => {}
            [only] if self.has_room([comment.open, gap, only, gap, close]) => {
                self.line([comment.open, gap, only, gap, close].concat());
            }
            [first, further @ ..] if comment.begins_at_once => {
                self.line([comment.open, first].concat());
                for line in further {
                    self.marked(comment.mark, line);
                }
                self.line(comment.close);
            }
            lines => {
                self.line(comment.open);
                for line in lines {
                    self.marked(comment.mark, line);
                }
                self.line(comment.close);
            }
        }
    }

    /// Writes `head {`, the output of `body` one level deeper, and `}`.
    pub fn block(&mut self, head: impl AsRef<str>, body: impl FnOnce(&mut Self)) {
        self.enclose(&[head.as_ref(), " {"].concat(), "}", body);
    }

    /// Writes `open`, the output of `body` one level deeper, and `close`, which may be empty.
    pub fn enclose(&mut self, open: &str, close: &str, body: impl FnOnce(&mut Self)) {
        self.line(open);
        self.opened = true;
        self.deeper(1, body);
        self.line(close);
        self.opened = false;
    }

    /// Writes the output of `body` so many levels deeper.
    pub fn deeper(&mut self, levels: usize, body: impl FnOnce(&mut Self)) {
        self.level += levels;
        body(self);
        self.level -= levels;
    }

    /// Returns the style of the language.
    pub fn style(&self) -> &'static Style {
        self.style
    }

    /// Writes `open a, b close` on one line if it fits, otherwise every item on a separate line.
    pub fn list<S: AsRef<str>>(&mut self, open: &str, items: &[S], close: &str) {
        let joined = join(items);
        self.line_or([open, &joined, close], |out| out.lines(open, items, close));
    }

    /// Writes `open`, every item on a separate line with a comma, and `close`.
    pub fn lines<S: AsRef<str>>(&mut self, open: &str, items: &[S], close: &str) {
        self.enclose(open, close, |out| {
            for item in items {
                out.line([item.as_ref(), ","].concat());
            }
        });
    }

    /// Writes items with commas, as many to a line as fit. `last` follows the last item.
    pub fn fill<S: AsRef<str>>(&mut self, items: &[S], last: &str) {
        // Reserves one column for the comma after an item.
        let room = self.room() - 1;
        let mut line = String::new();
        for item in items.iter().map(AsRef::as_ref) {
            if !line.is_empty() && line.len() + ", ".len() + item.len() + 1 > room {
                line.push(',');
                self.line(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push_str(", ");
            }
            line.push_str(item);
        }
        self.line([&line, last].concat());
    }

    /// Returns the number of columns of a line at the current level.
    pub fn room(&self) -> usize {
        let indent = self.level * self.style.indent.len();
        self.style.width.saturating_sub(indent)
    }

    /// Writes the parts on one line if they fit. Otherwise calls `broken`.
    pub fn line_or<const N: usize>(&mut self, parts: [&str; N], broken: impl FnOnce(&mut Self)) {
        if self.has_room(parts) {
            self.line(parts.concat());
        } else {
            broken(self);
        }
    }

    /// Returns `true` if these parts fit on one line at the current level.
    pub fn has_room<const N: usize>(&self, parts: [&str; N]) -> bool {
        let columns: usize = parts.into_iter().map(columns_of).sum();
        columns <= self.room()
    }

    fn marked(&mut self, mark: &str, line: &str) {
        if mark.is_empty() && line.is_empty() {
            self.text.push('\n');
            return;
        }
        self.indent();
        self.text.push_str(mark);
        if !(line.is_empty() || mark.is_empty()) {
            self.text.push(' ');
        }
        self.text.push_str(line);
        self.text.push('\n');
        self.opened = false;
    }

    fn indent(&mut self) {
        let indents = std::iter::repeat_n(self.style.indent, self.level);
        self.text.extend(indents);
    }
}

/// Joins items for one line.
pub fn join<S: AsRef<str>>(items: &[S]) -> String {
    items.iter().joined(", ")
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::package::template::Templates;
    use std::borrow::Cow;
    use std::collections::HashMap;
    use std::sync::LazyLock;

    static TEMPLATES: Templates = LazyLock::new(HashMap::new);

    /// A style with the comments of Java.
    pub static BRACES: Style = Style {
        width: 40,
        indent: "    ",
        comment: Comment {
            open: "/**",
            mark: " *",
            inner_mark: " *",
            close: " */",
            begins_at_once: false,
            prose: |line| Cow::Borrowed(line),
            code: |line| Cow::Borrowed(line),
            fence: |language| language,
        },
        link: str::to_owned,
        integer: |value| value.to_string(),
        redacted: "",
        templates: &TEMPLATES,
    };

    /// A style with the comments of Python.
    static INDENTED: Style = Style {
        comment: Comment {
            open: "\"\"\"",
            mark: "",
            inner_mark: "",
            close: "\"\"\"",
            begins_at_once: true,
            ..BRACES.comment
        },
        ..BRACES
    };

    fn docs(paragraphs: &[&'static str]) -> Docs<'static> {
        let mut docs = Docs::default();
        for paragraph in paragraphs {
            docs.paragraph(*paragraph);
        }
        docs
    }

    #[test]
    fn lists_break_when_they_are_too_long() {
        let mut out = Source::new(&BRACES, Languages::All);
        out.list("short(", &["a", "b"], ")");
        let long = ["a".repeat(20), "b".repeat(20)];
        out.list("long(", &long, ")");
        let expected = format!(
            "short(a, b)\nlong(\n    {},\n    {},\n)\n",
            long[0], long[1]
        );
        assert_eq!(out.finish(), expected);
    }

    #[test]
    fn blank_lines_do_not_repeat() {
        let mut out = Source::new(&BRACES, Languages::All);
        out.blank();
        out.block("mod a", |out| {
            out.blank();
            out.line("x");
            out.blank();
            out.blank();
            out.line("y");
        });
        out.blank();
        out.line("z");
        assert_eq!(out.finish(), "mod a {\n    x\n\n    y\n}\n\nz\n");
    }

    #[test]
    fn comments_open_and_close() {
        let mut out = Source::new(&BRACES, Languages::All);
        out.docs(&docs(&[]));
        out.docs(&docs(&["one"]));
        out.block("a", |out| out.docs(&docs(&["one two", "three"])));
        let expected =
            "/** one */\na {\n    /**\n     * one two\n     *\n     * three\n     */\n}\n";
        assert_eq!(out.finish(), expected);

        let mut out = Source::new(&INDENTED, Languages::All);
        out.enclose("class A:", "", |out| {
            out.docs(&docs(&["one"]));
            out.docs(&docs(&["one", "two"]));
        });
        let expected = "class A:\n    \"\"\"one\"\"\"\n    \"\"\"one\n\n    two\n    \"\"\"\n";
        assert_eq!(out.finish(), expected);
    }
}
