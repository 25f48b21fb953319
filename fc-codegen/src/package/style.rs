//! The source style of a language: line width, indentation, comments and a few fixed phrases.

use super::template::Templates;
use std::borrow::Cow;

/// The source style of a language.
#[derive(Debug)]
pub struct Style {
    /// The width of a line, in columns.
    pub width: usize,
    /// One level of indentation.
    pub indent: &'static str,
    /// The comment on the next item.
    pub comment: Comment,
    /// Formats a name in a comment as a link.
    pub link: fn(&str) -> String,
    /// Formats an integer literal.
    pub integer: fn(i128) -> String,
    /// The phrase for a value that is not printed.
    pub redacted: &'static str,
    /// The source text that does not depend on the spec, by name: see
    /// [`Source::template`](super::source::Source::template).
    pub templates: &'static Templates,
}

/// A documentation comment.
#[derive(Clone, Copy, Debug)]
pub struct Comment {
    /// The line that opens the comment; empty if each line has a mark.
    pub open: &'static str,
    /// The start of each line.
    pub mark: &'static str,
    /// The start of each line of a comment on the enclosing item.
    pub inner_mark: &'static str,
    /// The end of the comment.
    pub close: &'static str,
    /// `true` if the text begins directly after `open`.
    pub begins_at_once: bool,
    /// Escapes a line of the spec's Markdown for the language's documentation tool.
    pub prose: fn(&str) -> Cow<'_, str>,
    /// Escapes a line of code in a fence.
    pub code: fn(&str) -> Cow<'_, str>,
    /// Converts the language of a fence from the spec.
    pub fence: fn(&str) -> &str,
}
