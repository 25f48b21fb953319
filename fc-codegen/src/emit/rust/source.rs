//! Rust source text under construction: indentation, blank lines, and lists that break when they
//! are too long for a line. The layout is rustfmt's, so nothing has to format it afterwards.

use super::docs::{Docs, columns_of};

/// Columns of a line, as in rustfmt.
const WIDTH: usize = 100;

/// Columns of several arguments of an attribute on one line, as in rustfmt.
const ATTRIBUTE_WIDTH: usize = 70;

/// Columns of the items of an array on one line, as in rustfmt.
const ARRAY_WIDTH: usize = 60;

/// Columns of an item that does not need a line of its own in an array, as in rustfmt.
const SHORT_ITEM: usize = 10;

/// Columns of one level.
const INDENT: usize = 4;

/// A file, or a part of one.
#[derive(Clone, Debug, Default)]
pub struct Source {
    text: String,
    level: usize,
}

impl Source {
    /// The text written so far.
    pub fn finish(self) -> String {
        self.text
    }

    /// What stands in another part, which was written at the level of a file.
    pub fn append(&mut self, part: &Self) {
        self.text.push_str(&part.text);
    }

    /// One line, or several already laid out, each at the current level.
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
        }
    }

    /// An empty line, unless this is the start of the file or of a block or one stands here already.
    pub fn blank(&mut self) {
        let text = &self.text;
        if !(text.is_empty() || text.ends_with("\n\n") || text.ends_with("{\n")) {
            self.text.push('\n');
        }
    }

    /// A documentation comment on what follows.
    pub fn docs(&mut self, docs: &Docs<'_>) {
        self.comment("///", docs);
    }

    /// A documentation comment on what encloses it.
    pub fn inner_docs(&mut self, docs: &Docs<'_>) {
        self.comment("//!", docs);
    }

    /// `head {`, what `body` writes one level deeper, `}`.
    pub fn block(&mut self, head: impl AsRef<str>, body: impl FnOnce(&mut Self)) {
        self.enclose(&[head.as_ref(), " {"].concat(), "}", body);
    }

    /// `open`, what `body` writes one level deeper, `close`.
    pub fn enclose(&mut self, open: &str, close: &str, body: impl FnOnce(&mut Self)) {
        self.line(open);
        self.level += 1;
        body(self);
        self.level -= 1;
        self.line(close);
    }

    /// `open a, b close` on one line if it fits, else every item on a line of its own.
    pub fn list<S: AsRef<str>>(&mut self, open: &str, items: &[S], close: &str) {
        let joined = join(items);
        let columns = self.level * INDENT + open.len() + columns_of(&joined) + close.len();
        if columns <= WIDTH {
            self.line([open, &joined, close].concat());
        } else {
            self.enclose(open, close, |out| {
                for item in items {
                    out.line([item.as_ref(), ","].concat());
                }
            });
        }
    }

    /// `open a, b close` for an array: on one line if it is short, else as many items to a line as fit, or a line for
    /// each where one of them is long.
    pub fn array<S: AsRef<str>>(&mut self, open: &str, items: &[S], close: &str) {
        if columns_of(&join(items)) <= ARRAY_WIDTH {
            self.list(open, items, close);
        } else if items
            .iter()
            .all(|item| columns_of(item.as_ref()) <= SHORT_ITEM)
        {
            self.enclose(open, close, |out| out.fill(items, ","));
        } else {
            self.enclose(open, close, |out| {
                for item in items {
                    out.line([item.as_ref(), ","].concat());
                }
            });
        }
    }

    /// `open a, b close` for an attribute: on one line if it is short, else every argument on a line
    /// of its own, the last without a comma.
    pub fn attribute<S: AsRef<str>>(&mut self, open: &str, arguments: &[S], close: &str) {
        let joined = join(arguments);
        let columns = columns_of(&joined);
        let fits = match arguments {
            [_] => self.level * INDENT + open.len() + columns + close.len() <= WIDTH,
            _ => columns <= ATTRIBUTE_WIDTH,
        };
        if fits {
            self.line([open, &joined, close].concat());
        } else {
            self.enclose(open, close, |out| {
                let last = arguments.len().saturating_sub(1);
                for (index, argument) in arguments.iter().enumerate() {
                    let comma = if index < last { "," } else { "" };
                    out.line([argument.as_ref(), comma].concat());
                }
            });
        }
    }

    /// `open a, b close` for words in the parentheses of an attribute: on one line if they are short, else as many to a
    /// line as fit.
    pub fn attribute_words<S: AsRef<str>>(&mut self, open: &str, words: &[S], close: &str) {
        let joined = join(words);
        if columns_of(&joined) <= ATTRIBUTE_WIDTH {
            self.line([open, &joined, close].concat());
        } else {
            self.enclose(open, close, |out| out.fill(words, ""));
        }
    }

    /// `use path::{a, b};`, sorted, as many names to a line as fit.
    pub fn import<S: AsRef<str>>(&mut self, path: &str, names: &[S]) {
        let mut names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
        names.sort_unstable();
        names.dedup();
        match names.as_slice() {
            [] => {}
            [name] => self.line(format!("use {path}::{name};")),
            names => self.filled(&format!("use {path}::{{"), names, "};"),
        }
    }

    /// Like [`list`](Self::list), but as many items to a line as fit.
    pub fn filled<S: AsRef<str>>(&mut self, open: &str, items: &[S], close: &str) {
        let joined = join(items);
        // rustfmt keeps two columns free here.
        if self.level * INDENT + open.len() + columns_of(&joined) + close.len() <= WIDTH - 2 {
            self.line([open, &joined, close].concat());
            return;
        }
        self.enclose(open, close, |out| out.fill(items, ","));
    }

    /// Items with commas, as many to a line as fit; `last` stands behind the last.
    fn fill<S: AsRef<str>>(&mut self, items: &[S], last: &str) {
        // One column is kept free, for the comma after an item.
        let room = WIDTH - 1 - self.level * INDENT;
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

    fn comment(&mut self, mark: &str, docs: &Docs<'_>) {
        let width = WIDTH - self.level * INDENT - mark.len() - 1;
        docs.lines(width, |line| {
            self.indent();
            self.text.push_str(mark);
            if !line.is_empty() {
                self.text.push(' ');
                self.text.push_str(line);
            }
            self.text.push('\n');
        });
    }

    fn indent(&mut self) {
        self.text.extend(std::iter::repeat_n("    ", self.level));
    }
}

fn join<S: AsRef<str>>(items: &[S]) -> String {
    let mut out = String::new();
    for (index, item) in items.iter().enumerate() {
        if index > 0 {
            out.push_str(", ");
        }
        out.push_str(item.as_ref());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_break_when_they_are_too_long() {
        let mut out = Source::default();
        out.list("fn short(", &["a: u8", "b: u8"], ") {}");
        let long = ["a".repeat(50), "b".repeat(60)];
        out.list("fn long(", &long, ") {}");
        let expected = format!(
            "fn short(a: u8, b: u8) {{}}\nfn long(\n    {},\n    {},\n) {{}}\n",
            long[0], long[1]
        );
        assert_eq!(out.finish(), expected);
    }

    #[test]
    fn imports_are_sorted_and_filled() {
        let mut out = Source::default();
        out.import("a", &["B"]);
        out.import("a", &["C", "B", "C"]);
        let names: Vec<String> = (10..30).map(|n| format!("Name{n}")).collect();
        out.import("a", &names);
        let text = out.finish();
        assert!(
            text.starts_with("use a::B;\nuse a::{B, C};\nuse a::{\n    Name10, Name11"),
            "{text}"
        );
        assert!(text.lines().all(|line| line.len() <= WIDTH));
    }

    #[test]
    fn blank_lines_stand_alone() {
        let mut out = Source::default();
        out.blank();
        out.block("mod a", |out| {
            out.blank();
            out.line("x");
            out.blank();
            out.blank();
            out.line("y");
        });
        assert_eq!(out.finish(), "mod a {\n    x\n\n    y\n}\n");
    }
}
