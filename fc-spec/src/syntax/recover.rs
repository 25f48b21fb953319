//! Finds the place where parsing continues after text that is not YAML.

use std::ops::Range;

/// The maximum indentation at which parsing resumes: one level below the top.
const INDENT: usize = 2;

/// Returns the lines of the broken entry of a section or a file, from its key to the next key. Such a key has at most
/// two spaces before it. The entry is that of `first`. If it is blank, it is that of `last`. Returns `None` if the
/// entry has no content.
///
/// If the section has no other entry, returns the section.
pub(super) fn entry(text: &str, first: usize, last: usize) -> Option<Range<usize>> {
    let keys: Vec<(usize, usize)> = lines(text, 0)
        .filter_map(|(start, line)| {
            let indent = indent(line).filter(|indent| *indent <= INDENT)?;
            let key = line.trim_start_matches(' ');
            (is_key(key) || (indent == 0 && !key.starts_with(is_no_key))).then_some((start, indent))
        })
        .collect();
    let holder = |at: usize| {
        keys.partition_point(|(start, _)| *start <= at)
            .checked_sub(1)
    };
    let end_of = |at: usize, indent: usize| {
        let mut behind = keys.iter().skip(at + 1);
        let next = behind.find(|(_, other)| *other <= indent);
        next.map_or(text.len(), |(start, _)| *start)
    };
    let found = holder(line_end(text, first))
        .filter(|at| {
            keys.get(*at)
                .is_some_and(|(start, indent)| !is_blank(text, *start..end_of(*at, *indent)))
        })
        .or_else(|| holder(last))?;
    let (start, indent) = *keys.get(found)?;
    let end = end_of(found, indent);
    let section = keys
        .get(..found)?
        .iter()
        .rposition(|(_, other)| *other < indent);
    let Some(section) = section else {
        return (!is_blank(text, start..end)).then_some(start..end);
    };
    let (from, outer) = *keys.get(section)?;
    let to = end_of(section, outer);
    let below = line_end(text, from);
    let is_alone = is_blank(text, below..start) && is_blank(text, end..to);
    let lines = if is_alone { from..to } else { start..end };
    (!is_blank(text, lines.clone())).then_some(lines)
}

/// Returns a text with blanks instead of these lines.
pub(super) fn without(text: &str, lines: Range<usize>) -> String {
    let blank: String = text
        .get(lines.clone())
        .unwrap_or_default()
        .bytes()
        .map(|byte| {
            if matches!(byte, b'\n' | b'\r') {
                char::from(byte)
            } else {
                ' '
            }
        })
        .collect();
    let mut rest = text.to_owned();
    rest.replace_range(lines, &blank);
    rest
}

/// Returns `true` for characters that can start neither a key nor an item.
fn is_no_key(first: char) -> bool {
    first.is_whitespace() || matches!(first, ']' | '}' | ',')
}

/// Returns `true` if the range contains only blank lines and comments.
fn is_blank(text: &str, at: Range<usize>) -> bool {
    let mut lines = text.get(at).unwrap_or_default().lines();
    lines.all(|line| indent(line).is_none())
}

/// Returns the end of the line with byte `at`.
fn line_end(text: &str, at: usize) -> usize {
    let rest = text.get(at..).unwrap_or_default();
    at + rest.find('\n').unwrap_or(rest.len())
}

/// Returns the start of the line with byte `at`.
pub(super) fn line_start(text: &str, at: usize) -> usize {
    text.get(..at)
        .and_then(|before| before.rfind('\n'))
        .map_or(0, |newline| newline + 1)
}

/// Returns the lines from the start of a line, each with its offset.
fn lines(text: &str, from: usize) -> impl Iterator<Item = (usize, &str)> {
    let mut start = from;
    text.get(from..)
        .unwrap_or_default()
        .split_inclusive('\n')
        .map(move |line| {
            let this = start;
            start += line.len();
            (this, line)
        })
}

/// Returns the number of spaces before the text of a line, or `None` for blank lines and comments.
fn indent(line: &str) -> Option<usize> {
    let rest = line.trim_start_matches(' ');
    let blank = rest.trim().is_empty() || rest.starts_with('#');
    (!blank).then_some(line.len() - rest.len())
}

/// Returns `true` if a line starts with a word and a colon.
fn is_key(line: &str) -> bool {
    line.split_once(':').is_some_and(|(word, rest)| {
        !word.is_empty()
            && word
                .chars()
                .all(|c| c.is_alphanumeric() || c == '_' || c == '-')
            && !word.starts_with('-')
            && (rest.trim().is_empty() || rest.starts_with(' '))
    })
}
