//! Comments that swallow the rest of a text.

use super::quote::quoted;
use super::{FileId, Span};
use crate::diagnostic::{Diagnostic, FaultCode};

/// The comment that follows a plain scalar on its last line.
pub(super) fn behind(text: &str, scalar: Span) -> Option<Span> {
    let rest = text.get(scalar.end..)?.lines().next()?;
    let comment = rest.trim_start_matches([' ', '\t']);
    let start = scalar.end + rest.len() - comment.len();
    (comment.starts_with('#') && start > scalar.end)
        .then(|| Span::new(scalar.file, start, start + comment.trim_end().len()))
}

/// The fault of a text, which begins at byte `start`, that is cut off by the ` #` at byte `at`. In brackets the text
/// was meant to end before the next comma or bracket.
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
        "a `#` after a space cuts the text off",
    )
    .label("the rest of the line is a comment")
    .note("write a comment on its own line")
    .fix(whole, wanted, "quote the text if the `#` is part of it")
}
