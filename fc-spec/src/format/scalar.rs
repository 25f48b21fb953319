//! Scalars: to the byte, but for what indents the lines of one and for quotes that need not be single ones.

use super::order::LEVEL;
use crate::syntax::{Node, Style, quoted};

/// What stands in the file, of a scalar or of nothing.
pub(super) fn written<'t>(node: Node<'_>, text: &'t str) -> &'t str {
    let span = node.span();
    text.get(span.start..span.end).unwrap_or_default()
}

/// A key, or what is in brackets.
pub(super) fn short(node: Node<'_>, text: &str) -> String {
    laid_out(None, node, text, LEVEL)
}

/// A scalar under a key, or an item, as it is laid out where lines behind its first begin at column `indent`.
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

/// A text in single quotes in double ones, where it reads the same in them. What a slip of the quotes would turn into
/// a number keeps the quotes it has.
fn double(node: Node<'_>, written: &str) -> Option<String> {
    let inside = written.strip_prefix('\'')?.strip_suffix('\'')?;
    let text = node.as_str().filter(|text| *text == inside)?;
    let is_plain =
        |character: char| !matches!(character, '"' | '\\' | '\'') && !character.is_control();
    let is_word = text.starts_with(|first: char| first.is_alphabetic() || first == '`');
    (is_word && text.chars().all(is_plain)).then(|| quoted(text))
}

/// Lines behind the first one begin at column `indent`: white space there says nothing.
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

/// Where a block text begins in the file: at its `|` or `>`.
pub(super) fn header(key: Option<Node<'_>>, node: Node<'_>, text: &str) -> usize {
    let start = node.span().start;
    let at = |start: usize| text.get(start..).unwrap_or_default();
    let from = match key {
        Some(key) => key.span().end,
        None if at(start).starts_with(['|', '>']) && has_no_text(node) => start,
        // The last line with something on it above the text.
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

/// A block text: its first line without a comment, and its lines at column `indent`, or further in where it says by how
/// much.
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

    // Its lines, the white space behind the last one included.
    let begin = text.len() - body.len();
    let last = text.get(span.end..).unwrap_or_default();
    let (last, behind) = last.split_once('\n').unwrap_or((last, ""));
    let kept = text.get(begin..span.end + last.len()).unwrap_or_default();
    // Lines of white space behind it that count.
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

/// Start of the line that byte `at` is on, which has little before it.
fn line_start(text: &str, at: usize) -> usize {
    let before = text.get(..at).unwrap_or_default();
    before.rfind('\n').map_or(0, |newline| newline + 1)
}
