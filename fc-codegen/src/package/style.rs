//! How a language is written: its lines, its comments, the few words that a comment cannot say without it.

use std::borrow::Cow;

/// How a language is written.
#[derive(Debug)]
pub struct Style {
    /// Columns of a line.
    pub width: usize,
    /// One level of indentation.
    pub indent: &'static str,
    /// The comment on what follows.
    pub comment: Comment,
    /// A name in a comment as a link to what it names.
    pub link: fn(&str) -> String,
    /// An integer as it stands in source text.
    pub integer: fn(i128) -> String,
    /// Says that a value is kept out of what is printed.
    pub redacted: &'static str,
}

/// A documentation comment.
#[derive(Clone, Copy, Debug)]
pub struct Comment {
    /// What opens it, on a line of its own; empty where each line has its mark.
    pub open: &'static str,
    /// What each of its lines begins with.
    pub mark: &'static str,
    /// What closes it.
    pub close: &'static str,
    /// Whether its text begins right behind what opens it.
    pub begins_at_once: bool,
    /// A line of the spec's Markdown as the language's documentation tool takes it for the same.
    pub prose: fn(&str) -> Cow<'_, str>,
    /// A line of code in fences likewise.
    pub code: fn(&str) -> Cow<'_, str>,
    /// What a fence says of its language, from what the spec says.
    pub fence: fn(&str) -> &str,
}
