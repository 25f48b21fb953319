//! Scalars. They stay unchanged, except for indentation and unnecessary single quotes.

use super::order::LEVEL;
use crate::syntax::{Node, Style, quoted};

/// Returns a scalar or an empty value as in the file.
pub(super) fn written<'t>(node: Node<'_>, text: &'t str) -> &'t str {
    let span = node.span();
    text.get(span.start..span.end).unwrap_or_default()
}

/// Returns a key or a scalar in brackets.
pub(super) fn short(node: Node<'_>, text: &str) -> String {
    laid_out(None, node, text, LEVEL)
}

/// Returns the formatted scalar under a key, or of an item. Its lines after the first start at column `indent`.
pub(super) fn laid_out(key: Option<Node<'_>>, node: Node<'_>, text: &str, indent: usize) -> String {
    let written = written(node, text);
    match node.as_scalar().map(|scalar| scalar.style) {
        Some(Style::Block) => block(key, node, text, indent),
        Some(Style::Quoted) => match double(node, written) {
            Some(double) => double,
            None => folded(written, indent),
        },
        _ => folded(written, indent),
    }
}

/// Returns a single-quoted text in double quotes, if it has the same meaning there. A text that would be a number
/// without quotes keeps its quotes.
fn double(node: Node<'_>, written: &str) -> Option<String> {
    let inside = written.strip_prefix('\'')?.strip_suffix('\'')?;
    let text = node.as_str().filter(|text| *text == inside)?;
    let is_plain =
        |character: char| !matches!(character, '"' | '\\' | '\'') && !character.is_control();
    let is_word = text.starts_with(|first: char| first.is_alphabetic() || first == '`');
    (is_word && text.chars().all(is_plain)).then(|| quoted(text))
}

/// Moves the lines after the first to column `indent`. White space at their start has no meaning.
fn folded(written: &str, indent: usize) -> String {
    let mut lines = written.split('\n');
    let mut out = lines.next().unwrap_or_default().to_owned();
    for line in lines {
        let line = line.trim_start_matches([' ', '\t']);
        out.push('\n');
        if !line.is_empty() {
            out.extend(std::iter::repeat_n(' ', indent));
            out.push_str(line);
        }
    }
    out
}

/// Returns the start of a block scalar in the file: its `|` or `>`.
pub(super) fn header(key: Option<Node<'_>>, node: Node<'_>, text: &str) -> usize {
    let start = node.span().start;
    let at = |start: usize| text.get(start..).unwrap_or_default();
    let from = match key {
        Some(key) => key.span().end,
        None if at(start).starts_with(['|', '>']) && has_no_text(node) => start,
        // The last line with content above the text.
        None => {
            let above = text.get(..line_start(text, start)).unwrap_or_default();
            line_start(text, above.trim_end().len())
        }
    };
    let mut rest = at(from);
    loop {
        rest = rest.trim_start_matches([' ', '\t', '\n', ':', '-']);
        if !rest.starts_with('#') {
            return text.len() - rest.len();
        }
        rest = rest.split_once('\n').map_or("", |(_, lines)| lines);
    }
}

fn has_no_text(node: Node<'_>) -> bool {
    node.as_str()
        .is_none_or(|text| text.trim_matches('\n').is_empty())
}

/// Returns a block scalar: its first line without a comment, and its other lines at column `indent`. An indentation
/// indicator in the first line adds columns.
fn block(key: Option<Node<'_>>, node: Node<'_>, text: &str, indent: usize) -> String {
    let rest = text.get(header(key, node, text)..).unwrap_or_default();
    let (first, body) = rest.split_once('\n').unwrap_or((rest, ""));
    let ends = |character: &char| matches!(character, ' ' | '\t' | '#');
    let mut out: String = first.chars().take_while(|it| !ends(it)).collect();
    if has_no_text(node) {
        let lines = node.as_str().unwrap_or_default();
        return out + lines;
    }
    let span = node.span();
    let old = span.start - line_start(text, span.start);
    let digit = out.chars().find_map(|character| character.to_digit(10));
    let digit = digit.and_then(|digit| usize::try_from(digit).ok());
    let new = digit.map_or(indent, |digit| indent.saturating_sub(LEVEL) + digit);

    // The lines of the text, with the white space after the last one.
    let begin = text.len() - body.len();
    let last = text.get(span.end..).unwrap_or_default();
    let (last, behind) = last.split_once('\n').unwrap_or((last, ""));
    let kept = text.get(begin..span.end + last.len()).unwrap_or_default();
    // The lines of white space after it that belong to the text.
    let behind = behind
        .split_inclusive('\n')
        .filter_map(|line| line.strip_suffix('\n'));
    let behind: Vec<&str> = behind.take_while(|line| line.trim().is_empty()).collect();
    let counting = if out.contains('+') {
        behind.len()
    } else {
        let last = behind.iter().rposition(|line| line.len() > old);
        last.map_or(0, |last| last + 1)
    };
    for line in kept.split('\n').chain(behind.into_iter().take(counting)) {
        out.push('\n');
        if let Some(line) = line.get(old..).filter(|line| !line.is_empty()) {
            out.extend(std::iter::repeat_n(' ', new));
            out.push_str(line);
        }
    }
    out
}

/// Returns the start of the line with byte `at`. It searches backwards, because lines are short.
fn line_start(text: &str, at: usize) -> usize {
    let before = text.get(..at).unwrap_or_default();
    before.rfind('\n').map_or(0, |newline| newline + 1)
}
