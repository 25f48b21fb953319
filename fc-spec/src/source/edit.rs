//! Replacements in the text of a file. All other bytes stay unchanged.

use super::{SourceFile, Span};
use similar::{ChangeTag, TextDiff};
use std::fmt::Write as _;
use std::time::Duration;

/// The time limit of the search for the smallest difference of two texts.
const PATIENCE: Duration = Duration::from_secs(1);

/// Replacements in one file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Edits(Vec<(Span, String)>);

impl Edits {
    /// Replaces a span with `text`.
    pub fn replace(&mut self, span: Span, text: impl Into<String>) {
        self.0.push((span, text.into()));
    }

    /// Inserts `text` after a span.
    pub fn insert_after(&mut self, span: Span, text: impl Into<String>) {
        self.replace(Span::point(span.file, span.end), text);
    }

    /// Adds one or more lines below the last line of a span.
    pub fn add_line(&mut self, file: &SourceFile, span: Span, line: &str) {
        let last = file.last_line(span);
        let (at, text) = match file.lines(last + 1, last + 1) {
            Some((next, _)) => (next, format!("{line}\n")),
            None if file.text.ends_with('\n') => (file.text.len(), format!("{line}\n")),
            None => (file.text.len(), format!("\n{line}")),
        };
        self.replace(Span::point(span.file, at), text);
    }

    /// Removes all lines of a span.
    pub fn remove_lines(&mut self, file: &SourceFile, span: Span) {
        let end = file.next_line(file.last_line(span));
        let lines = Span::new(span.file, file.line_start(span.start), end);
        self.replace(lines, String::new());
    }

    /// Returns the place of the first replacement, for messages.
    pub fn place(&self) -> Option<Span> {
        self.0.first().map(|(span, _)| *span)
    }

    /// Returns the text of the file with all replacements.
    pub fn apply(&self, file: &SourceFile) -> String {
        made(&self.sorted(file), &file.text, 0, file.text.len())
    }

    /// Returns the changed lines as a diff without line numbers. Removed lines start with `-`, added lines with `+`,
    /// and unchanged lines with a space. `@@` marks omitted lines.
    pub fn diff(&self, file: &SourceFile) -> String {
        let sorted = self.sorted(file);
        let mut hunks: Vec<(usize, usize)> = Vec::new();
        for (span, _) in &sorted {
            let (first, last) = if is_between_lines(file, *span) {
                (file.line(span.start) - 1, file.line(span.start) - 1)
            } else {
                (file.line(span.start), file.last_line(*span))
            };
            match hunks.last_mut() {
                Some((_, end)) if first <= *end + 1 => *end = last.max(*end),
                _ => hunks.push((first, last)),
            }
        }
        let mut diff = String::new();
        for (index, (first, last)) in hunks.into_iter().enumerate() {
            let Some((start, _)) = file.lines(first, first) else {
                continue;
            };
            let end = file.next_line(last);
            let new = made(&sorted, &file.text, start, end);
            let old = file.text.get(start..end).unwrap_or_default();
            if index > 0 {
                diff.push_str("@@\n");
            }
            compare(&mut diff, old, &new);
        }
        diff
    }

    /// Returns the replacements by place, with the line ends of the file.
    fn sorted(&self, file: &SourceFile) -> Vec<(Span, String)> {
        let mut sorted = self.0.clone();
        for (_, text) in &mut sorted {
            *text = text.replace("\r\n", "\n").replace('\n', file.newline());
        }
        sorted.sort_by_key(|(span, _)| (span.start, span.end));
        sorted
    }
}

/// Returns the changed lines between two texts in the form of [`Edits::diff`], with one line around them.
pub(crate) fn changed_lines(old: &str, new: &str) -> String {
    let changes = TextDiff::configure().timeout(PATIENCE).diff_lines(old, new);
    let mut diff = String::new();
    for (index, group) in changes.grouped_ops(1).iter().enumerate() {
        if index > 0 {
            diff.push_str("@@\n");
        }
        for change in group.iter().flat_map(|op| changes.iter_changes(op)) {
            let sign = match change.tag() {
                ChangeTag::Delete => '-',
                ChangeTag::Insert => '+',
                ChangeTag::Equal => ' ',
            };
            let line = change.value().trim_end_matches(['\r', '\n']);
            // Writing to a String cannot fail.
            let _ = writeln!(diff, "{sign}{line}");
        }
    }
    diff
}

/// Returns `true` for an insertion between two lines. It belongs to the line above.
fn is_between_lines(file: &SourceFile, span: Span) -> bool {
    let is_empty = span.start == span.end;
    is_empty && file.line(span.start) > 1 && file.line_start(span.start) == span.start
}

/// Returns a part of a text with the replacements inside it.
fn made(sorted: &[(Span, String)], text: &str, start: usize, end: usize) -> String {
    let mut made = String::new();
    let mut at = start;
    for (span, new) in sorted {
        let is_before = span.end == start && span.start == start && start > 0;
        if span.start >= at && span.end <= end && !is_before {
            made.push_str(text.get(at..span.start).unwrap_or_default());
            made.push_str(new);
            at = span.end;
        }
    }
    made.push_str(text.get(at..end).unwrap_or_default());
    made
}

/// Adds the lines of a hunk. Common lines at both ends start with a space. Removed and added lines are between them.
fn compare(diff: &mut String, old: &str, new: &str) {
    let (old, new): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
    let same = |(a, b): &(&&str, &&str)| a == b;
    let head = old.iter().zip(&new).take_while(same).count();
    let rest = old.len().min(new.len()) - head;
    let tail = old.iter().rev().zip(new.iter().rev()).take_while(same);
    let tail = tail.count().min(rest);
    let part = |lines: &[&str], sign: char, out: &mut String| {
        for line in lines {
            // Writing to a String cannot fail.
            let _ = writeln!(out, "{sign}{line}");
        }
    };
    let gone = old.get(head..old.len() - tail).unwrap_or_default();
    let come = new.get(head..new.len() - tail).unwrap_or_default();
    part(old.get(..head).unwrap_or_default(), ' ', diff);
    part(gone, '-', diff);
    part(come, '+', diff);
    part(old.get(old.len() - tail..).unwrap_or_default(), ' ', diff);
}
