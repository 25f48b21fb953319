//! Finds punctuation that is not YAML's, but was meant to be: `effect：read`, `effect:read`, `“read”`.
//!
//! A scan of a line collects such punctuation. To see whether it causes an error, it is replaced, and the parser must
//! then get beyond the error.

use crate::text;
use std::ops::Range;

use super::comment;
use super::parser::reaches;
use super::width::{describe, half_width};
use crate::diagnostic::{Diagnostic, FaultCode};
use crate::source::{FileId, Span};

/// The maximum number of bytes that are parsed again to find a cause.
const BYTES: usize = 256 << 10;
/// The maximum length of a scanned line or scalar. Longer ones are not typed by hand.
const LINE_BYTES: usize = 4 << 10;
/// The maximum number of lines that are searched for a cause.
const LINES: usize = 40;

/// Punctuation to be replaced.
struct Slip {
    at: Range<usize>,
    replacement: &'static str,
}

/// Returns the error for a scalar that was meant as more than a scalar.
pub(super) fn of_scalar(span: Span, text: &str) -> Option<Diagnostic> {
    if text.len() > LINE_BYTES {
        return None;
    }
    let scanner = Scanner::of(text, false);
    fault(span.file, text, span.start, &scanner.found)
}

/// Returns the slip that causes an error of the parser at byte `at`. The parser was reading the lines from byte `from`.
pub(super) fn behind_error(
    file: FileId,
    text: &str,
    range: &Range<usize>,
    from: usize,
    at: usize,
) -> Option<Diagnostic> {
    let before = text.get(range.start..at)?;
    if before.len() > BYTES {
        return None;
    }
    let end_of_line = |at: usize| {
        let rest = text.get(at..range.end).unwrap_or_default();
        at + rest.find('\n').unwrap_or(rest.len())
    };
    let first = super::recover::line_start(text, from.min(at));
    let mut start = first;
    for _ in 0..LINES {
        let end = end_of_line(start);
        let line = text
            .get(start..end)
            .filter(|line| line.len() <= LINE_BYTES)?;
        let in_brackets = text
            .get(first..start)
            .is_some_and(|before| !Scanner::of(before, false).open.is_empty());
        let helps = |slips: &[Slip]| {
            if slips.is_empty() {
                return false;
            }
            let whole = text.get(range.start..range.end).unwrap_or_default();
            let fixed = replace(whole, start - range.start, slips);
            // The end of the error's line in the fixed text.
            let beyond = (end_of_line(at.max(start)) + fixed.len()).checked_sub(range.end);
            beyond.is_some_and(|beyond| reaches(&fixed, beyond))
        };
        let scanner = Scanner::of(line, in_brackets);
        let is_indentation = scanner.found.first().is_some_and(|slip| {
            let before = line.get(..slip.at.end).unwrap_or_default();
            before.trim().is_empty()
        });
        if is_indentation || helps(&scanner.found) {
            return fault(file, line, start, &scanner.found);
        }
        if let Some(cut) = &scanner.cut {
            let hash = Slip {
                at: cut.clone(),
                replacement: "x",
            };
            if helps(&[hash]) {
                let cut = start + cut.start;
                let word = start + scanner.token.unwrap_or_default();
                return Some(comment::cut(file, text, word, cut, true));
            }
        }
        start = end + 1;
        if start > end_of_line(at) {
            break;
        }
    }
    None
}

fn replace(text: &str, offset: usize, slips: &[Slip]) -> String {
    let mut fixed = text.to_owned();
    for slip in slips.iter().rev() {
        let at = offset + slip.at.start..offset + slip.at.end;
        if fixed.get(at.clone()).is_some() {
            fixed.replace_range(at, slip.replacement);
        }
    }
    fixed
}

/// Returns one error for all slips of a line. `offset` is the byte at which the line starts in its file.
fn fault(file: FileId, line: &str, offset: usize, slips: &[Slip]) -> Option<Diagnostic> {
    let (first, last) = (slips.first()?, slips.last()?);
    let place = |at: &Range<usize>| Span::new(file, offset + at.start, offset + at.end);
    let whole = first.at.start..last.at.end;
    let fixed = replace(line, 0, slips);
    let behind = line.len() - whole.end;
    let replacement = fixed.get(whole.start..fixed.len() - behind)?.to_owned();
    let whole = place(&whole);
    let character = line.get(first.at.clone())?.chars().next();
    let fault = if let Some(character) = character {
        let ascii = half_width(character).unwrap_or(character);
        let wanted = match ascii {
            ' ' => text!("空格", "a space"),
            ascii => text!("半角的 `{ascii}`", "`{ascii}`"),
        };
        let message = text!(
            "YAML 在这里需要{wanted}，实际是{character}",
            "{character} where YAML needs {wanted}",
            character = describe(character),
            wanted = wanted
        );
        Diagnostic::error(FaultCode::FullWidth, place(&first.at), message)
            .label(text!(
                "对 YAML 来说这只是普通字符",
                "to YAML this is an ordinary character"
            ))
            .fix(
                whole,
                replacement,
                text!("改为半角", "write it in half-width"),
            )
    } else {
        let before = line.get(..first.at.start).unwrap_or_default();
        let mark = before.chars().next_back().unwrap_or(':');
        let mark_at = first.at.start.saturating_sub(mark.len_utf8());
        let message = text!(
            "`{mark}` 后面没有空格",
            "a `{mark}` without a space after it"
        );
        Diagnostic::error(
            FaultCode::MissingSpace,
            place(&(mark_at..first.at.start)),
            message,
        )
        .label(text!("成了前后文本的一部分", "part of the text around it"))
        .fix(
            whole,
            replacement,
            text!("在后面加一个空格", "write a space after it"),
        )
    };
    Some(if slips.len() > 1 {
        fault.note(text!(
            "这一行有 {places} 处",
            "{places} places on this line",
            places = slips.len()
        ))
    } else {
        fault
    })
}

/// A scan of a line or a scalar.
struct Scanner<'a> {
    text: &'a str,
    at: usize,
    /// The start of the text since the last punctuation.
    token: Option<usize>,
    /// `true` if the line had only white space and dashes so far.
    line_start: bool,
    /// For each open bracket, `true` if it is full-width.
    open: Vec<bool>,
    found: Vec<Slip>,
    /// The `#` of a comment directly after a text in brackets.
    cut: Option<Range<usize>>,
}

impl<'a> Scanner<'a> {
    /// Scans a whole text.
    fn of(text: &'a str, in_brackets: bool) -> Self {
        let mut scanner = Self {
            text,
            at: 0,
            token: None,
            line_start: !in_brackets,
            open: if in_brackets { vec![false] } else { Vec::new() },
            found: Vec::new(),
            cut: None,
        };
        while scanner.step().is_some() {}
        scanner
    }

    /// Scans the next character.
    fn step(&mut self) -> Option<()> {
        let rest = self.text.get(self.at..)?;
        let character = rest.chars().next()?;
        let start = self.at;
        self.at += character.len_utf8();
        let behind = self.text.get(self.at..).unwrap_or_default();
        // Other white space is a separate slip.
        let spaced =
            behind.is_empty() || behind.starts_with([' ', '\t', '\r', '\n', '\u{3000}', '\u{a0}']);
        let begins = self.token.is_none();
        match character {
            '\n' => {
                self.token = None;
                self.line_start = self.open.is_empty();
            }
            ' ' | '\t' | '\r' => {}
            '"' | '\'' if begins => {
                let close = behind.find(character).map(|end| end + 1);
                self.at += close.unwrap_or(behind.len());
                self.token = Some(start);
            }
            '#' if self.is_separated(start) => {
                if self.token.is_some() && !self.open.is_empty() {
                    self.cut = Some(start..self.at);
                }
                self.at += behind.find('\n').unwrap_or(behind.len());
            }
            '＃' if self.is_separated(start) => {
                self.slip(start, "#");
                self.at += behind.find('\n').unwrap_or(behind.len());
            }
            '-' if begins && self.line_start => {
                if spaced {
                    return Some(());
                }
                if behind.starts_with(|next: char| next.is_ascii_alphabetic()) {
                    self.insert_space();
                } else {
                    self.token = Some(start);
                }
            }
            '－' | '—' | '–' if begins && self.line_start && spaced => self.slip(start, "-"),
            '{' | '[' if begins => self.open.push(false),
            '｛' | '［' | '【' if begins => {
                self.slip(start, if character == '｛' { "{" } else { "[" });
                self.open.push(true);
            }
            '}' | ']' if !self.open.is_empty() => {
                self.open.pop();
                self.token = Some(start);
            }
            '｝' | '］' | '】' if self.closes(behind) => {
                self.slip(start, if character == '｝' { "}" } else { "]" });
                self.open.pop();
                self.token = Some(start);
            }
            ',' if !self.open.is_empty() => self.token = None,
            '，' | '、' if self.separates(behind) => {
                self.slip(start, if spaced { "," } else { ", " });
                self.token = None;
            }
            ':' if spaced => self.token = None,
            ':' if self.is_key(start) && !behind.starts_with(['/', ':', '\\']) => {
                self.insert_space();
                self.token = None;
            }
            '：' if self.is_key(start) => {
                self.slip(start, if spaced { ":" } else { ": " });
                self.token = None;
            }
            '“' | '‘' | '＂' | '”' if begins => self.quoted(start, character, behind),
            '\u{3000}' if self.line_start => self.slip(start, "  "),
            '\u{3000}' | '\u{a0}' if begins => self.slip(start, " "),
            _ => {
                self.token.get_or_insert(start);
            }
        }
        if !matches!(character, ' ' | '\t' | '\r' | '\n' | '\u{3000}' | '\u{a0}') {
            self.line_start = false;
        }
        Some(())
    }

    fn slip(&mut self, start: usize, replacement: &'static str) {
        let at = start..self.at;
        self.found.push(Slip { at, replacement });
    }

    fn insert_space(&mut self) {
        self.slip(self.at, " ");
    }

    fn is_separated(&self, start: usize) -> bool {
        let before = self.text.get(..start).unwrap_or_default();
        before.is_empty() || before.ends_with([' ', '\t', '\n', '\u{3000}', '\u{a0}'])
    }

    /// Returns `true` if the text since the last punctuation looks like a key.
    fn is_key(&self, end: usize) -> bool {
        let Some(word) = self.token.and_then(|start| self.text.get(start..end)) else {
            return false;
        };
        is_word(word.trim_end())
    }

    /// Returns `true` if a full-width bracket closes a bracket here.
    fn closes(&self, behind: &str) -> bool {
        let rest = behind.trim_start_matches([' ', '\u{3000}']);
        let ends =
            rest.is_empty() || rest.starts_with([',', '，', '}', '｝', ']', '］', '\r', '\n']);
        self.open.last().is_some_and(|full| *full || ends)
    }

    /// Returns `true` if a full-width comma separates entries: in full-width brackets, or before a key.
    fn separates(&self, behind: &str) -> bool {
        let Some(full) = self.open.last() else {
            return false;
        };
        let rest = behind.trim_start();
        let end = rest.find([':', '：']);
        let is_key = end.and_then(|end| rest.get(..end)).is_some_and(is_word);
        let spaced = end.is_some_and(|end| {
            let colon = rest.get(end..).unwrap_or_default();
            colon.starts_with('：') || colon.starts_with(": ")
        });
        *full || (is_key && spaced)
    }

    /// Handles a text in characters that are not YAML quotes.
    fn quoted(&mut self, start: usize, open: char, behind: &str) {
        let close = match open {
            '‘' => '’',
            '＂' => '＂',
            _ => '”',
        };
        self.token = Some(start);
        let line = behind.lines().next().unwrap_or_default();
        let Some(end) = line.find(close) else { return };
        let rest = line.get(end + close.len_utf8()..).unwrap_or_default();
        let rest = rest.trim_start();
        let inside = line.get(..end).unwrap_or_default();
        // After a quotation, a Chinese text continues, also with a full-width comma or colon.
        let ends = rest.is_empty()
            || rest.starts_with('#')
            || rest.starts_with(": ")
            || (!self.open.is_empty() && rest.starts_with([',', '}', '｝', ']', '］']));
        if ends && !inside.contains(['"', '\\']) {
            self.slip(start, "\"");
            let from = self.at + end;
            self.at = from + close.len_utf8();
            self.slip(from, "\"");
        }
    }
}

fn is_word(text: &str) -> bool {
    text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_')
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}
