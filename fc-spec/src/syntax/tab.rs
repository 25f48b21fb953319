//! Tabs that some parsers refuse.

use super::node::{NodeKind, Style};
use super::tree::Tree;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::source::{FileId, Span};
use crate::text;
use std::ops::Range;

/// Reports tabs outside of quotes, block scalars and comments in the tree's part of a file. Tabs before the first text
/// of a line are indentation and have been checked.
pub(super) fn check(
    file: FileId,
    text: &str,
    range: &Range<usize>,
    tree: &Tree<'_>,
    faults: &mut Faults,
) {
    let text = text.get(..range.end).unwrap_or(text);
    if !text
        .get(range.start..)
        .is_some_and(|part| part.contains('\t'))
    {
        return;
    }
    let scalars: Vec<(Span, bool)> = tree
        .nodes()
        .filter_map(|node| match node.kind() {
            NodeKind::Scalar(scalar) => Some((node.span(), scalar.style == Style::Plain)),
            _ => None,
        })
        .collect();
    let mut from = range.start;
    while let Some(found) = text.get(from..).and_then(|rest| rest.find('\t')) {
        let at = from + found;
        let rest = text.get(at..).unwrap_or_default();
        let length = rest.len() - rest.trim_start_matches([' ', '\t']).len();
        from = at + length.max(1);

        let line = super::recover::line_start(text, at);
        let behind = rest.get(length..).unwrap_or_default();
        let ends_line = behind.is_empty() || behind.starts_with(['\n', '\r', '#']);
        let before = text.get(line..at).unwrap_or_default();
        let last = scalars.partition_point(|(span, _)| span.start <= at);
        let last = last.checked_sub(1).and_then(|last| scalars.get(last));
        let (is_plain, is_inside, end) = match last {
            Some((span, plain)) => (*plain, at < span.end, span.end.max(line)),
            None => (false, false, line),
        };
        let is_indentation = before.trim().is_empty() && !ends_line;
        let in_comment = !is_inside && text.get(end..at).is_some_and(|gap| gap.contains('#'));
        if is_indentation || in_comment || (is_inside && !is_plain) {
            continue;
        }
        let span = Span::new(file, at, at + length);
        let fault = Diagnostic::error(
            FaultCode::Tab,
            span,
            text!(
                "有的 YAML 解析器不接受的制表符",
                "a tab that some YAML parsers reject"
            ),
        );
        faults.push(if ends_line && !behind.starts_with('#') {
            fault.fix(span, "", text!("删除它", "delete it"))
        } else {
            fault.fix(span, " ", text!("改用空格", "write a space instead"))
        });
    }
}
