//! Where parsing can go on after text that is not YAML.

use std::ops::Range;

/// Deepest indentation at which parsing resumes: one level below the top.
const INDENT: usize = 2;

/// The next stretch of whole lines that looks like a mapping of its own: it starts at a key with at
/// most two spaces before it, at or behind byte `at` and behind the line at `last`, and ends before the
/// next line that is indented less.
pub(super) fn next_chunk(text: &str, at: usize, last: usize) -> Option<Range<usize>> {
    let from = line_start(text, at);
    // What stands before `at` on its line has been parsed; if it is only white space, nothing has.
    let fresh = text.get(from..at)?.trim().is_empty() && from > last;
    let mut lines = lines(text, from).skip(usize::from(!fresh));
    let (start, indent) = lines.find_map(|(start, line)| {
        let indent = indent(line)?;
        (indent <= INDENT && start > last && is_key(line.trim_start_matches(' ')))
            .then_some((start, indent))
    })?;
    let end = lines
        .find(|(_, line)| self::indent(line).is_some_and(|other| other < indent))
        .map_or(text.len(), |(start, _)| start);
    Some(start..end)
}

/// Start of the line that holds byte `at`.
pub(super) fn line_start(text: &str, at: usize) -> usize {
    text.get(..at)
        .and_then(|before| before.rfind('\n'))
        .map_or(0, |newline| newline + 1)
}

/// Lines from a line's start on, each with its offset.
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

/// Spaces before the line's text; `None` for blank lines and comments.
fn indent(line: &str) -> Option<usize> {
    let rest = line.trim_start_matches(' ');
    let blank = rest.trim().is_empty() || rest.starts_with('#');
    (!blank).then_some(line.len() - rest.len())
}

/// Whether a line starts with a word and a colon.
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
