//! Regular expressions of `pattern`.

use super::Text;
use crate::{text, text_error};
use regex_lite::Regex;
use regex_syntax::ast::parse::Parser;
use regex_syntax::ast::{
    AssertionKind, Ast, ClassAsciiKind, ClassBracketed, ClassPerl, ClassPerlKind, ClassSet,
    ClassSetItem, GroupKind, RepetitionKind, RepetitionRange,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::{self, Write as _};
use std::sync::OnceLock;

/// A regular expression that a text must match as a whole.
///
/// The dialect is that of `regex-lite`: `\d`, `\w` and `\s` are ASCII, and `.` excludes only `\n`.
/// A construct that other languages interpret differently is translated or refused.
/// A dump contains the source of the pattern.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(into = "String", try_from = "String")]
#[schemars(with = "String")]
pub struct Pattern {
    source: String,
    portable: String,
    /// Compiled at the first match.
    regex: OnceLock<Option<Regex>>,
}

impl PartialEq for Pattern {
    fn eq(&self, other: &Self) -> bool {
        self.source == other.source
    }
}

impl Eq for Pattern {}

/// The reason why a string is not a valid pattern.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PatternError {
    /// The source is not a regular expression. Holds the parser's explanation.
    Syntax(String),
    /// The source uses a construct that not all languages have. Holds its name.
    NotPortable(Text),
    /// The repetitions expand to too many parts.
    TooLarge,
}

/// The maximum number of parts of a pattern with expanded repetitions.
const MOST_PARTS: usize = 10_000;

impl Pattern {
    /// Parses the source of a pattern.
    ///
    /// # Errors
    ///
    /// [`PatternError`] for a text that is not a regular expression, is not portable, or is too large.
    pub fn new(source: impl Into<String>) -> Result<Self, PatternError> {
        let source = source.into();
        let ast = Parser::new().parse(&source);
        let ast = ast.map_err(|error| PatternError::Syntax(error.kind().to_string()))?;
        let mut portable = String::new();
        let parts = write(&ast, Edges::BOTH, &mut portable)?;
        if parts > MOST_PARTS {
            return Err(PatternError::TooLarge);
        }
        Ok(Self {
            source,
            portable,
            regex: OnceLock::new(),
        })
    }

    /// Returns the pattern as the spec writes it.
    #[must_use]
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Returns the pattern in constructs that all languages interpret alike.
    #[must_use]
    pub fn portable(&self) -> &str {
        &self.portable
    }

    /// Returns `true` if the whole text matches.
    #[must_use]
    pub fn matches(&self, text: &str) -> bool {
        let compile = || Regex::new(&format!("^(?:{})$", self.portable)).ok();
        let regex = self.regex.get_or_init(compile);
        regex.as_ref().is_some_and(|regex| regex.is_match(text))
    }
}

impl fmt::Display for Pattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.source)
    }
}

impl From<Pattern> for String {
    fn from(pattern: Pattern) -> Self {
        pattern.source
    }
}

impl TryFrom<String> for Pattern {
    type Error = PatternError;

    fn try_from(source: String) -> Result<Self, PatternError> {
        Self::new(source)
    }
}

impl PatternError {
    /// Returns the message for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Syntax(error) => text!("正则表达式库的说明：{error}", "{error}"),
            Self::NotPortable(construct) => text!(
                "各语言对{construct}的处理不同，请改写",
                "the languages treat {construct} differently; write the pattern without it",
                construct = construct
            ),
            Self::TooLarge => text!(
                "重复次数展开后超过 {MOST_PARTS} 个部分",
                "its repetitions expand to more than {MOST_PARTS} parts"
            ),
        }
    }
}

text_error!(PatternError);

/// The edges of the whole text that a part touches.
#[derive(Clone, Copy)]
struct Edges {
    start: bool,
    end: bool,
}

impl Edges {
    const BOTH: Self = Self {
        start: true,
        end: true,
    };
    const NONE: Self = Self {
        start: false,
        end: false,
    };
}

fn refused<T>(construct: Text) -> Result<T, PatternError> {
    Err(PatternError::NotPortable(construct))
}

/// Writes a part of a pattern. Returns its size with expanded repetitions.
fn write(ast: &Ast, edges: Edges, out: &mut String) -> Result<usize, PatternError> {
    match ast {
        Ast::Empty(_) => Ok(0),
        Ast::Flags(_) => refused(text!("标志（如 `(?i)`）", "flags such as `(?i)`")),
        Ast::Literal(literal) => {
            write_literal(literal.c, out);
            Ok(1)
        }
        Ast::Dot(_) => {
            out.push_str(r"[^\n]");
            Ok(1)
        }
        Ast::Assertion(assertion) => match assertion.kind {
            // A pattern always matches the whole text, so the assertion is redundant.
            AssertionKind::StartLine | AssertionKind::StartText if edges.start => Ok(0),
            AssertionKind::EndLine | AssertionKind::EndText if edges.end => Ok(0),
            _ => refused(text!(
                "文本中间的断言（如 `^`、`$`、`\\b`）",
                "assertions such as `^`, `$` and `\\b` inside a text"
            )),
        },
        Ast::ClassUnicode(_) => refused(text!(
            "Unicode 类（如 `\\p{{L}}`）",
            "Unicode classes such as `\\p{{L}}`"
        )),
        Ast::ClassPerl(class) => perl(class).write(out),
        Ast::ClassBracketed(class) => bracketed(class)?.write(out),
        Ast::Repetition(repetition) => {
            out.push_str("(?:");
            let inside = out.len();
            let size = write(&repetition.ast, Edges::NONE, out)?;
            if matches!(
                *repetition.ast,
                Ast::Literal(_)
                    | Ast::Dot(_)
                    | Ast::ClassPerl(_)
                    | Ast::ClassBracketed(_)
                    | Ast::Group(_)
            ) {
                // A single item needs no extra group.
                out.replace_range(inside - 3..inside, "");
            } else {
                out.push(')');
            }
            Ok(size.saturating_mul(write_repetition(&repetition.op.kind, out)))
        }
        Ast::Group(group) => {
            if let GroupKind::NonCapturing(flags) = &group.kind
                && !flags.items.is_empty()
            {
                return refused(text!("标志（如 `(?i:…)`）", "flags such as `(?i:…)`"));
            }
            out.push_str("(?:");
            let size = write(&group.ast, edges, out)?;
            out.push(')');
            Ok(size)
        }
        Ast::Alternation(alternation) => {
            let mut size = 0_usize;
            for (index, ast) in alternation.asts.iter().enumerate() {
                if index > 0 {
                    out.push('|');
                }
                size = size
                    .saturating_add(1)
                    .saturating_add(write(ast, edges, out)?);
            }
            // Outside a group, `a|b` is the whole pattern: `^(?:…)$` surrounds it.
            Ok(size)
        }
        Ast::Concat(concat) => {
            let mut size = 0_usize;
            let last = concat.asts.len().saturating_sub(1);
            for (index, ast) in concat.asts.iter().enumerate() {
                let edges = Edges {
                    start: edges.start && index == 0,
                    end: edges.end && index == last,
                };
                size = size.saturating_add(write(ast, edges, out)?);
            }
            Ok(size)
        }
    }
}

/// Writes the repetition of a part. Returns the factor by which the part grows.
///
/// The repetition is always greedy: lazy repetition has the same result for a whole text.
fn write_repetition(kind: &RepetitionKind, out: &mut String) -> usize {
    let (text, times) = match kind {
        RepetitionKind::ZeroOrOne => ("?".to_owned(), 1),
        RepetitionKind::ZeroOrMore => ("*".to_owned(), 1),
        RepetitionKind::OneOrMore => ("+".to_owned(), 2),
        RepetitionKind::Range(RepetitionRange::Exactly(times)) => (format!("{{{times}}}"), *times),
        RepetitionKind::Range(RepetitionRange::AtLeast(least)) => {
            (format!("{{{least},}}"), least.saturating_add(1))
        }
        RepetitionKind::Range(RepetitionRange::Bounded(least, most)) => {
            (format!("{{{least},{most}}}"), *most)
        }
    };
    out.push_str(&text);
    usize::try_from(times).unwrap_or(usize::MAX)
}

fn write_literal(character: char, out: &mut String) {
    if r"^$\.*+?()[]{}|".contains(character) {
        out.push('\\');
    }
    write_character(character, out);
}

fn write_hex(character: char, out: &mut String) {
    // Writing to a String cannot fail.
    let _ = write!(out, "\\x{:02X}", u32::from(character));
}

fn write_character(character: char, out: &mut String) {
    match character {
        '\n' => out.push_str(r"\n"),
        '\r' => out.push_str(r"\r"),
        '\t' => out.push_str(r"\t"),
        c if c.is_ascii_control() => write_hex(c, out),
        c => out.push(c),
    }
}

/// A set of characters, as sorted ranges that do not touch.
struct Class(Vec<(u32, u32)>);

const LAST: u32 = char::MAX as u32;

impl Class {
    fn of(mut ranges: Vec<(u32, u32)>) -> Self {
        ranges.sort_unstable();
        let mut merged: Vec<(u32, u32)> = Vec::with_capacity(ranges.len());
        for (first, last) in ranges {
            match merged.last_mut() {
                Some((_, end)) if first <= end.saturating_add(1) => *end = last.max(*end),
                _ => merged.push((first, last)),
            }
        }
        Self(merged)
    }

    fn negated_if(self, is_negated: bool) -> Self {
        if !is_negated {
            return self;
        }
        let mut from = 0;
        let mut rest = Vec::with_capacity(self.0.len() + 1);
        for (first, last) in self.0 {
            if first > from {
                rest.push((from, first - 1));
            }
            from = last + 1;
        }
        if from <= LAST {
            rest.push((from, LAST));
        }
        Self(rest)
    }

    /// Writes the class, which is one part of a pattern.
    fn write(self, out: &mut String) -> Result<usize, PatternError> {
        let is_open = self.0.last().is_some_and(|(_, last)| *last == LAST);
        let class = self.negated_if(is_open);
        if class.0.is_empty() {
            if !is_open {
                return refused(text!("空的字符类", "empty classes"));
            }
            out.push_str(r"(?:[^\n]|\n)");
            return Ok(1);
        }
        out.push_str(if is_open { "[^" } else { "[" });
        for (first, last) in class.0 {
            write_in_class(first, out);
            if last > first {
                if last > first + 1 {
                    out.push('-');
                }
                write_in_class(last, out);
            }
        }
        out.push(']');
        Ok(1)
    }
}

fn write_in_class(character: u32, out: &mut String) {
    let Some(character) = char::from_u32(character) else {
        return;
    };
    match character {
        '[' | ']' | '\\' | '^' | '-' => out.extend(['\\', character]),
        // Doubled, these characters are set operators in some languages.
        '&' | '|' | '~' => write_hex(character, out),
        _ => write_character(character, out),
    }
}

fn perl(class: &ClassPerl) -> Class {
    let kind = match class.kind {
        ClassPerlKind::Digit => &ClassAsciiKind::Digit,
        ClassPerlKind::Space => &ClassAsciiKind::Space,
        ClassPerlKind::Word => &ClassAsciiKind::Word,
    };
    ascii(kind).negated_if(class.negated)
}

fn ascii(kind: &ClassAsciiKind) -> Class {
    let ranges: &[(u8, u8)] = match kind {
        ClassAsciiKind::Alnum => &[(b'0', b'9'), (b'A', b'Z'), (b'a', b'z')],
        ClassAsciiKind::Alpha => &[(b'A', b'Z'), (b'a', b'z')],
        ClassAsciiKind::Ascii => &[(0, 0x7F)],
        ClassAsciiKind::Blank => &[(b'\t', b'\t'), (b' ', b' ')],
        ClassAsciiKind::Cntrl => &[(0, 0x1F), (0x7F, 0x7F)],
        ClassAsciiKind::Digit => &[(b'0', b'9')],
        ClassAsciiKind::Graph => &[(b'!', b'~')],
        ClassAsciiKind::Lower => &[(b'a', b'z')],
        ClassAsciiKind::Print => &[(b' ', b'~')],
        ClassAsciiKind::Punct => &[(b'!', b'/'), (b':', b'@'), (b'[', b'`'), (b'{', b'~')],
        ClassAsciiKind::Space => &[(b'\t', b'\r'), (b' ', b' ')],
        ClassAsciiKind::Upper => &[(b'A', b'Z')],
        ClassAsciiKind::Word => &[(b'0', b'9'), (b'A', b'Z'), (b'_', b'_'), (b'a', b'z')],
        ClassAsciiKind::Xdigit => &[(b'0', b'9'), (b'A', b'F'), (b'a', b'f')],
    };
    Class::of(ranges.iter().map(|&(a, b)| (a.into(), b.into())).collect())
}

fn bracketed(class: &ClassBracketed) -> Result<Class, PatternError> {
    let ClassSet::Item(item) = &class.kind else {
        return refused(text!("字符类的集合运算", "operations on classes"));
    };
    Ok(Class::of(ranges(item)?).negated_if(class.negated))
}

fn ranges(item: &ClassSetItem) -> Result<Vec<(u32, u32)>, PatternError> {
    let class = match item {
        ClassSetItem::Empty(_) => return Ok(Vec::new()),
        ClassSetItem::Literal(literal) => return Ok(vec![(literal.c.into(), literal.c.into())]),
        ClassSetItem::Range(range) => return Ok(vec![(range.start.c.into(), range.end.c.into())]),
        ClassSetItem::Ascii(class) => ascii(&class.kind).negated_if(class.negated),
        ClassSetItem::Perl(class) => perl(class),
        ClassSetItem::Unicode(_) => {
            return refused(text!(
                "Unicode 类（如 `\\p{{L}}`）",
                "Unicode classes such as `\\p{{L}}`"
            ));
        }
        ClassSetItem::Bracketed(_) => {
            return refused(text!("嵌套的字符类", "nested classes"));
        }
        ClassSetItem::Union(union) => {
            let mut all = Vec::new();
            for item in &union.items {
                all.extend(ranges(item)?);
            }
            return Ok(all);
        }
    };
    Ok(class.0)
}
