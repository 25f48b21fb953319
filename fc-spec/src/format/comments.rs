//! The comments of a file that no row has taken yet, in their order.

use crate::source::{SourceFile, Span};

/// A comment on its own line.
#[derive(Clone, Debug)]
pub(super) struct Line<'t> {
    pub text: &'t str,
    /// `true` if the line above is blank.
    pub blank: bool,
}

/// The comments that no row has taken yet.
pub(super) struct Comments<'t> {
    file: &'t SourceFile,
    spans: std::iter::Peekable<std::vec::IntoIter<Span>>,
    /// The end of the blank lines that belong to a block scalar.
    text_end: usize,
}

impl<'t> Comments<'t> {
    pub fn new(file: &'t SourceFile, spans: Vec<Span>) -> Self {
        Self {
            file,
            spans: spans.into_iter().peekable(),
            text_end: 0,
        }
    }

    /// Records that the blank lines from byte `end` belong to the block scalar that ends there.
    pub fn keep_blank(&mut self, end: usize) {
        let rest = self.file.text.get(end..).unwrap_or_default();
        let next = end + rest.len() - rest.trim_start().len();
        self.text_end = self.file.line_start(next);
    }

    /// Returns `true` if byte `at` starts a line below a blank one that belongs to no block scalar.
    pub fn is_below_blank(&self, at: usize) -> bool {
        blank_above(self.file, at) && self.file.line_start(at) != self.text_end
    }

    /// Takes the first comment, if it starts before byte `end` and fits.
    pub fn take_if(&mut self, end: usize, fits: impl FnOnce(Span) -> bool) -> Option<Span> {
        self.spans.next_if(|span| span.start < end && fits(*span))
    }

    /// Returns `true` if the first comment starts before byte `end`.
    pub fn has_before(&mut self, end: usize) -> bool {
        self.spans.peek().is_some_and(|span| span.start < end)
    }

    /// Takes all comments that start before byte `end`, as lines.
    pub fn lines_before(&mut self, end: usize) -> Vec<Line<'t>> {
        let mut lines = Vec::new();
        while let Some(span) = self.take_if(end, |_| true) {
            lines.push(self.line(span));
        }
        lines
    }

    /// Returns a comment as a line.
    pub fn line(&self, span: Span) -> Line<'t> {
        Line {
            text: self.slice(span),
            blank: self.is_below_blank(span.start),
        }
    }

    /// Returns the text of a comment.
    pub fn slice(&self, span: Span) -> &'t str {
        self.file.slice(span)
    }
}

/// Returns `true` if only spaces and the dashes of lists precede byte `at` on its line.
pub(super) fn begins_line(file: &SourceFile, at: usize) -> bool {
    file.before(at).trim_start_matches([' ', '-']).is_empty()
}

/// Returns `true` if byte `at` starts a line below a blank one.
fn blank_above(file: &SourceFile, at: usize) -> bool {
    let above = file.line_text(file.line(at) - 1);
    above.is_some_and(|line| line.trim().is_empty()) && begins_line(file, at)
}

/// Returns `true` if two bytes are on the same line.
pub(super) fn on_one_line(file: &SourceFile, from: usize, to: usize) -> bool {
    file.line(from) == file.line(to)
}
