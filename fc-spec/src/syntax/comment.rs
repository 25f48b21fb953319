//! Comments: the node that a comment belongs to, and comments that cut off a text.

use super::quote::quoted;
use crate::diagnostic::{Diagnostic, FaultCode};
use crate::source::{FileId, Span};
use crate::text;
use std::ops::Range;

/// Returns the comments that belong to the node at byte `at`: those on its line and directly above. Returns none if
/// another node starts the line.
pub(super) fn about(comments: &[Range<usize>], text: &str, at: usize) -> Range<usize> {
    let behind = comments.partition_point(|comment| comment.start < at);
    let Some(mut line) = opening(text, at) else {
        return behind..behind;
    };
    let on_line = |comment: &Range<usize>| {
        let between = text.get(at..comment.start);
        between.is_some_and(|between| !between.contains('\n'))
    };
    let end = behind + usize::from(comments.get(behind).is_some_and(on_line));
    let mut first = behind;
    while let Some(comment) = first.checked_sub(1).and_then(|above| comments.get(above)) {
        let gap = text.get(comment.end..line);
        match opening(text, comment.start) {
            Some(start) if matches!(gap, Some("\n" | "\r\n")) => line = start,
            _ => break,
        }
        first -= 1;
    }
    first..end
}

/// Returns the start of the line with byte `at`, if only white space and the dashes of lists precede it.
fn opening(text: &str, at: usize) -> Option<usize> {
    let before = text.get(..at)?.trim_end_matches([' ', '-']);
    (before.is_empty() || before.ends_with('\n')).then_some(before.len())
}

/// Returns the comment that follows a plain scalar on its last line.
pub(super) fn behind(text: &str, scalar: Span) -> Option<Span> {
    let rest = text.get(scalar.end..)?.lines().next()?;
    let comment = rest.trim_start_matches([' ', '\t']);
    let start = scalar.end + rest.len() - comment.len();
    (comment.starts_with('#') && start > scalar.end)
        .then(|| Span::new(scalar.file, start, start + comment.trim_end().len()))
}

/// Returns the error for a text from byte `start` that the ` #` at byte `at` cuts off. In brackets, the intended text
/// ends before the next comma or bracket.
pub(super) fn cut(
    file: FileId,
    text: &str,
    start: usize,
    at: usize,
    in_brackets: bool,
) -> Diagnostic {
    let line = text.get(at..).and_then(|rest| rest.lines().next());
    let comment = line.unwrap_or_default().trim_end();
    let meant = match comment.find([',', '}', ']']) {
        Some(end) if in_brackets => comment.get(..end).unwrap_or_default().trim_end(),
        _ => comment,
    };
    let whole = Span::new(file, start, at + meant.len());
    let wanted = quoted(text.get(whole.start..whole.end).unwrap_or_default());
    let span = Span::new(file, at, at + comment.len());
    Diagnostic::error(
        FaultCode::TextCut,
        span,
        text!(
            "空格后面的 `#` 把文本截断了",
            "a `#` after a space cuts the text off"
        ),
    )
    .label(text!(
        "这一行的其余部分成了注释",
        "the rest of the line is a comment"
    ))
    .note(text!("注释请另起一行", "write a comment on its own line"))
    .fix(
        whole,
        wanted,
        text!(
            "如果 `#` 是文本的一部分，给文本加上引号",
            "quote the text if the `#` is part of it"
        ),
    )
}
