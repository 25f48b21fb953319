//! Scalars: to the byte, but for what indents the lines of one and for quotes that need not be single ones.

use crate::syntax::{Node, Style, quoted};

/// What stands in the file, of a scalar or of nothing.
pub(super) fn written<'t>(node: Node<'_>, text: &'t str) -> &'t str {
    let span = node.span();
    text.get(span.start..span.end).unwrap_or_default()
}

/// A scalar as it is laid out where lines behind its first begin at column `indent`.
pub(super) fn laid_out(node: Node<'_>, text: &str, indent: usize) -> String {
    let written = written(node, text);
    match node.as_scalar().map(|scalar| scalar.style) {
        Some(Style::Block) => block(node, text, indent),
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

/// What begins with `|` or `>`: its first line without a comment, and its lines at column `indent`, or further in where
/// it says by how much.
fn block(node: Node<'_>, text: &str, indent: usize) -> String {
    let start = node.span().start;
    let rest = text.get(start..).unwrap_or_default();
    let (first, body) = rest.split_once('\n').unwrap_or((rest, ""));
    let header: String = first
        .chars()
        .take_while(|character| !matches!(character, ' ' | '\t' | '#'))
        .collect();
    let explicit = header.chars().find_map(|character| character.to_digit(10));
    let explicit = explicit.and_then(|digit| usize::try_from(digit).ok());

    let depth = |line: &str| line.len() - line.trim_start_matches(' ').len();
    let is_blank = |line: &&str| line.trim().is_empty();
    // The lines of the text, and blank ones behind it where they count.
    let end = node.span().end.saturating_sub(start + first.len() + 1);
    let end = end
        + body
            .get(end..)
            .and_then(|rest| rest.find('\n'))
            .unwrap_or_default();
    let kept = body.get(..end).unwrap_or(body);
    let has_text = !kept.trim().is_empty();
    let mut lines: Vec<&str> = kept.split('\n').filter(|_| has_text).collect();
    let said = node.as_str().unwrap_or_default();
    let said = said
        .split('\n')
        .find(|line| !is_blank(line))
        .map_or(0, depth);
    // A text may itself begin with spaces; the others are the file's.
    let old = lines
        .iter()
        .find(|line| !is_blank(line))
        .map_or(0, |line| depth(line));
    let old = old.saturating_sub(said);
    let behind = body
        .get(if has_text { kept.len() + 1 } else { 0 }..)
        .unwrap_or_default();
    let behind = behind
        .split_inclusive('\n')
        .filter_map(|line| line.strip_suffix('\n'));
    let behind: Vec<&str> = behind.take_while(is_blank).collect();
    let counting = if header.contains('+') {
        behind.len()
    } else {
        let counting = behind.iter().rposition(|line| has_text && line.len() > old);
        counting.map_or(0, |last| last + 1)
    };
    lines.extend(behind.iter().take(counting));
    let new = explicit.map_or(indent, |digit| indent.saturating_sub(2) + digit);

    let mut out = header;
    for line in lines {
        out.push('\n');
        if let Some(line) = line.get(old..).filter(|line| !line.is_empty()) {
            out.extend(std::iter::repeat_n(' ', new));
            out.push_str(line);
        }
    }
    out
}
