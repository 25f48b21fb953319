//! The comments of a file in the order in which they stand, until something has taken each.

use crate::syntax::Span;

/// A comment on a line of its own.
#[derive(Clone, Debug)]
pub(super) struct Line<'t> {
    /// The comment.
    pub text: &'t str,
    /// Whether the line above it is blank.
    pub blank: bool,
}

/// Those that nothing has taken yet.
pub(super) struct Comments<'t> {
    text: &'t str,
    spans: std::iter::Peekable<std::vec::IntoIter<Span>>,
    /// Where the blank lines end that are of a text.
    text_end: usize,
}

impl<'t> Comments<'t> {
    pub fn new(text: &'t str, spans: Vec<Span>) -> Self {
        Self {
            text,
            spans: spans.into_iter().peekable(),
            text_end: 0,
        }
    }

    /// The blank lines from byte `end` on are of the text that ends there.
    pub fn keep_blank(&mut self, end: usize) {
        let rest = self.text.get(end..).unwrap_or_default();
        let next = end + rest.len() - rest.trim_start().len();
        self.text_end = line_start(self.text, next);
    }

    /// Whether what stands at byte `at` begins its line, below a blank one that is of no text.
    pub fn is_below_blank(&self, at: usize) -> bool {
        blank_above(self.text, at) && line_start(self.text, at) != self.text_end
    }

    /// The first one, if it begins before byte `end` and fits.
    pub fn take_if(&mut self, end: usize, fits: impl FnOnce(Span) -> bool) -> Option<Span> {
        self.spans.next_if(|span| span.start < end && fits(*span))
    }

    /// Whether the first one begins before byte `end`.
    pub fn has_before(&mut self, end: usize) -> bool {
        self.spans.peek().is_some_and(|span| span.start < end)
    }

    /// All that begin before byte `end`, as lines of their own.
    pub fn lines_before(&mut self, end: usize) -> Vec<Line<'t>> {
        let mut lines = Vec::new();
        while let Some(span) = self.take_if(end, |_| true) {
            lines.push(self.line(span));
        }
        lines
    }

    /// As a line of its own.
    pub fn line(&self, span: Span) -> Line<'t> {
        Line {
            text: self.slice(span),
            blank: self.is_below_blank(span.start),
        }
    }

    /// Its text.
    pub fn slice(&self, span: Span) -> &'t str {
        self.text.get(span.start..span.end).unwrap_or_default()
    }
}

/// Start of the line that byte `at` is on.
pub(super) fn line_start(text: &str, at: usize) -> usize {
    let before = text.get(..at).unwrap_or_default();
    before.rfind('\n').map_or(0, |newline| newline + 1)
}

/// Columns before the first text of the line that byte `at` is on.
pub(super) fn indentation(text: &str, at: usize) -> usize {
    let line = text.get(line_start(text, at)..).unwrap_or_default();
    line.len() - line.trim_start_matches(' ').len()
}

/// Whether what stands at byte `at` begins its line, but for the dashes of lists.
pub(super) fn begins_line(text: &str, at: usize) -> bool {
    let before = text.get(line_start(text, at)..at).unwrap_or_default();
    before.trim_matches([' ', '-']).is_empty()
}

/// Whether it begins its line, below a blank one.
fn blank_above(text: &str, at: usize) -> bool {
    let start = line_start(text, at);
    let above = text.get(..start).unwrap_or_default();
    let above = above.strip_suffix('\n').unwrap_or_default();
    let last = above.get(line_start(above, above.len())..);
    start > 0 && begins_line(text, at) && last.is_some_and(|line| line.trim().is_empty())
}

/// Whether no line ends between two bytes.
pub(super) fn on_one_line(text: &str, from: usize, to: usize) -> bool {
    text.get(from..to)
        .is_some_and(|between| !between.contains('\n'))
}
