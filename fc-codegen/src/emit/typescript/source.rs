//! Source text in the layout of Biome: comments, literals and declarations.

use super::context::Context;
use crate::package::docs::{Docs, escape_links};
use crate::package::joined::Joined;
use crate::package::literal::quoted;
use crate::package::source::join;
use crate::package::style::{Comment, Style};
use crate::package::template::{Templates, templates};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::LazyLock;

pub use crate::package::source::Source;

static TEMPLATES: Templates = LazyLock::new(|| templates(include_str!("templates.ts.in")));

/// The style of the package.
pub static TYPESCRIPT: Style = Style {
    width: 120,
    indent: "  ",
    comment: Comment {
        open: "/**",
        mark: " *",
        inner_mark: " *",
        close: " */",
        begins_at_once: false,
        prose,
        code: in_comment,
        fence: |language| language,
    },
    link: |name| format!("{{@link {name}}}"),
    integer: |value| value.to_string(),
    redacted: "Left out by `redacted`.",
    templates: &TEMPLATES,
};

/// Escapes prose that could end the comment, or read as a link or a tag.
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

/// Escapes code that would end the comment.
fn in_comment(line: &str) -> Cow<'_, str> {
    if line.contains("*/") {
        Cow::Owned(line.replace("*/", "*\\/"))
    } else {
        Cow::Borrowed(line)
    }
}

/// Returns the text of a block tag on one line.
pub fn tag_text(text: &str) -> String {
    text.lines().map(|line| prose(line.trim())).joined(" ")
}

/// Returns a string literal in the quotes that need fewer escapes.
pub fn literal(text: &str) -> String {
    let count = |quote| text.matches(quote).count();
    let quote = if count('\'') > count('"') { '"' } else { '\'' };
    quoted(text, quote, &[], |out, c| out.extend(c.escape_unicode()))
}

pub fn float(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// Writes `export type Name =`, with each alternative and its comment on separate lines. A single one has no bar.
pub fn alternatives(out: &mut Source, name: &str, all: &[(Docs<'_>, String)]) {
    let bar = if all.len() > 1 { "| " } else { "" };
    out.enclose(&format!("export type {name} ="), "", |out| {
        for (docs, alternative) in all {
            out.docs(docs);
            out.line([bar, alternative].concat());
        }
    });
}

/// Creates the head of a file whose source is the whole spec.
pub fn head(context: &Context<'_>, about: [&str; 2]) -> Source {
    let mut out = context.source();
    let mut docs = Docs::default();
    docs.raw_both(about);
    docs.raw("@module");
    out.docs(&docs);
    out.blank();
    out
}

/// Ends a file without exports, which must still be a module.
pub fn nothing(mut out: Source) -> String {
    out.line("export {}");
    out.finish()
}

pub fn property(name: &str, ty: &str, is_optional: bool) -> String {
    if is_optional {
        format!("{name}?: {ty} | undefined")
    } else {
        format!("{name}: {ty}")
    }
}

/// Writes `word { a, b } from 'path'`, sorted.
pub fn named<S: AsRef<str>>(
    out: &mut Source,
    word: &str,
    names: impl IntoIterator<Item = S>,
    path: &str,
) {
    let names: BTreeSet<String> = names.into_iter().map(|it| it.as_ref().to_owned()).collect();
    let names: Vec<String> = names.into_iter().collect();
    let line = format!("{word} {{ {} }} from '{path}'", join(&names));
    match names.as_slice() {
        [] => {}
        // A single name is not broken.
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
}
