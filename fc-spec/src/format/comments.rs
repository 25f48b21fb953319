//! The comments of a file in the order in which they stand, until something has taken each.

use crate::source::{SourceFile, Span};

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
    file: &'t SourceFile,
    spans: std::iter::Peekable<std::vec::IntoIter<Span>>,
    /// Where the blank lines end that are of a text.
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

    /// The blank lines from byte `end` on are of the text that ends there.
    pub fn keep_blank(&mut self, end: usize) {
        let rest = self.file.text.get(end..).unwrap_or_default();
        let next = end + rest.len() - rest.trim_start().len();
        self.text_end = line_start(self.file, next);
    }

    /// Whether what stands at byte `at` begins its line, below a blank one that is of no text.
    pub fn is_below_blank(&self, at: usize) -> bool {
        blank_above(self.file, at) && line_start(self.file, at) != self.text_end
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
        let text = self.file.text.get(span.start..span.end);
        text.unwrap_or_default()
    }
}

/// The line that byte `at` is on: where it begins and where its text ends.
pub(super) fn line(file: &SourceFile, at: usize) -> (usize, usize) {
    let number = file.line(at);
    file.lines(number, number).unwrap_or((at, at))
}

fn line_start(file: &SourceFile, at: usize) -> usize {
    line(file, at).0
}

/// Columns before byte `at` on its line.
pub(super) fn column(file: &SourceFile, at: usize) -> usize {
    at - line_start(file, at).min(at)
}

/// Columns before the first text of the line that byte `at` is on.
pub(super) fn indentation(file: &SourceFile, at: usize) -> usize {
    let (start, end) = line(file, at);
    let line = file.text.get(start..end).unwrap_or_default();
    line.len() - line.trim_start_matches(' ').len()
}

/// Whether what stands at byte `at` begins its line, but for the dashes of lists.
pub(super) fn begins_line(file: &SourceFile, at: usize) -> bool {
    let before = file.text.get(line_start(file, at)..at).unwrap_or_default();
    before.trim_start_matches([' ', '-']).is_empty()
}

/// Whether it begins its line, below a blank one.
fn blank_above(file: &SourceFile, at: usize) -> bool {
    let above = file.line(at) - 1;
    let above = file.lines(above, above);
    let above = above.and_then(|(start, end)| file.text.get(start..end));
    above.is_some_and(|line| line.trim().is_empty()) && begins_line(file, at)
}

/// Whether no line ends between two bytes.
pub(super) fn on_one_line(file: &SourceFile, from: usize, to: usize) -> bool {
    file.line(from) == file.line(to)
}
