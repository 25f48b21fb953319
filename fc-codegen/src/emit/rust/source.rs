//! Layout rules of rustfmt that only Rust needs: attributes, arrays and imports.

use crate::package::docs::{columns_of, escape_links};
use crate::package::source::join;
use crate::package::style::{Comment, Style};
use crate::package::template::{Templates, templates};
use std::borrow::Cow;
use std::sync::LazyLock;

pub use crate::package::source::Source;

static TEMPLATES: Templates = LazyLock::new(|| templates(include_str!("templates.rs.in")));

/// The style of rustfmt.
pub static RUST: Style = Style {
    width: 100,
    indent: "    ",
    comment: Comment {
        open: "",
        mark: "///",
        inner_mark: "//!",
        close: "",
        begins_at_once: false,
        prose: escape_links,
        code: |line| Cow::Borrowed(line),
        // rustdoc would compile it.
        fence: |language| match language {
            "" | "rust" | "rs" => "text",
            language => language,
        },
    },
    link: |name| format!("[`{name}`]"),
    integer: crate::package::digits::grouped,
    redacted: "Never shown by `Debug`.",
    templates: &TEMPLATES,
};

/// The maximum width of several attribute arguments on one line, as in rustfmt.
const ATTRIBUTE_WIDTH: usize = 70;

/// The maximum width of array items on one line, as in rustfmt.
const ARRAY_WIDTH: usize = 60;

/// The maximum width of an array item that can share a line, as in rustfmt.
const SHORT_ITEM: usize = 10;

impl Source {
    /// Writes `open a, b close` for an array, on one line if it is short.
    ///
    /// Otherwise it puts as many items on a line as fit, or one item per line if any item is long.
    pub fn array<S: AsRef<str>>(&mut self, open: &str, items: &[S], close: &str) {
        if columns_of(&join(items)) <= ARRAY_WIDTH {
            self.list(open, items, close);
        } else if items
            .iter()
            .all(|item| columns_of(item.as_ref()) <= SHORT_ITEM)
        {
            self.enclose(open, close, |out| out.fill(items, ","));
        } else {
            self.lines(open, items, close);
        }
    }

    /// Writes `open a, b close` for an attribute, on one line if it is short.
    ///
    /// Otherwise every argument has a separate line, and the last has no comma.
    pub fn attribute<S: AsRef<str>>(&mut self, open: &str, arguments: &[S], close: &str) {
        let joined = join(arguments);
        let fits = match arguments {
            [_] => self.has_room([open, &joined, close]),
            _ => columns_of(&joined) <= ATTRIBUTE_WIDTH,
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

    /// Writes `open a, b close` for words in the parentheses of an attribute.
    ///
    /// Short words share one line. Otherwise it puts as many words on a line as fit.
    pub fn attribute_words<S: AsRef<str>>(&mut self, open: &str, words: &[S], close: &str) {
        let joined = join(words);
        if columns_of(&joined) <= ATTRIBUTE_WIDTH {
            self.line([open, &joined, close].concat());
        } else {
            self.enclose(open, close, |out| out.fill(words, ""));
        }
    }

    /// Writes `use path::{a, b};`, sorted, with as many names to a line as fit.
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

    /// Writes a list like [`list`](Self::list), but with as many items to a line as fit.
    pub fn filled<S: AsRef<str>>(&mut self, open: &str, items: &[S], close: &str) {
        let joined = join(items);
        // rustfmt keeps two columns free here.
        if self.has_room([open, &joined, close, "  "]) {
            return self.line([open, &joined, close].concat());
        }
        self.enclose(open, close, |out| out.fill(items, ","));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fc_spec::model::Languages;

    #[test]
    fn imports_are_sorted_and_filled() {
        let mut out = Source::new(&RUST, Languages::All);
        out.import("a", &["B"]);
        out.import("a", &["C", "B", "C"]);
        let names: Vec<String> = (10..30).map(|n| format!("Name{n}")).collect();
        out.import("a", &names);
        let text = out.finish();
        assert!(
            text.starts_with("use a::B;\nuse a::{B, C};\nuse a::{\n    Name10, Name11"),
            "{text}"
        );
        assert!(text.lines().all(|line| line.len() <= RUST.width));
    }
}
