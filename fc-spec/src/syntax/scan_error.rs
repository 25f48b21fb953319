//! Translates the parser's errors into this project's words.

use crate::text;
use granit_parser::ErrorKind;

use super::scan_words;
use crate::diagnostic::{Diagnostic, FaultCode};
use crate::source::{FileId, Span};

/// The state of the parser where it stopped.
pub(super) struct ParserState<'a> {
    /// The file.
    pub file: FileId,
    /// The text of the whole file.
    pub text: &'a str,
    /// The byte at which the parser stopped.
    pub at: usize,
    /// The end of the parsed part.
    pub understood: usize,
    /// The last parsed value.
    pub value: Option<Span>,
    /// The start of the innermost open bracket.
    pub bracket: Option<usize>,
}

impl ParserState<'_> {
    /// Returns the span of the character at `at`. It is empty at the end of a line.
    fn here(&self) -> Span {
        self.character(self.at)
    }

    fn character(&self, at: usize) -> Span {
        let length = self
            .text
            .get(at..)
            .and_then(|rest| rest.chars().next())
            .filter(|character| !matches!(character, '\n' | '\r'))
            .map_or(0, char::len_utf8);
        Span::new(self.file, at, at + length)
    }

    /// Returns the opening quote of the current text.
    fn quote(&self) -> Option<Span> {
        let rest = self.text.get(self.understood..)?;
        let before = rest.trim_start_matches([' ', '\t', '\r', '\n', ':', ',', '-', '?', '[', '{']);
        before
            .starts_with(['"', '\''])
            .then(|| self.character(self.understood + rest.len() - before.len()))
    }
}

/// Returns the error for an error of the parser.
pub(super) fn diagnose(kind: &ErrorKind, parser: &ParserState<'_>) -> Diagnostic {
    use ErrorKind as K;
    match kind {
        K::RecursionLimitExceeded => too_deep(parser),
        K::TabNotAllowed
        | K::TabInBlockIndentation
        | K::TabInIndentation
        | K::TabInPlainScalar
        | K::TabAtBlockScalarStart => tab(parser),
        K::MappingValueNotAllowed => colon(parser),
        K::UnclosedQuotedScalar
        | K::InvalidQuotedScalarIndent
        | K::DocumentIndicatorInQuotedScalar => unclosed_quote(parser),
        K::InvalidTrailingSingleQuotedScalar | K::InvalidTrailingDoubleQuotedScalar => {
            behind_quote(parser)
        }
        K::UnclosedFlowCollection { open } => {
            let close = if *open == '[' { ']' } else { '}' };
            Diagnostic::error(
                FaultCode::Unclosed,
                parser.here(),
                text!("`{open}` 没有闭合", "the `{open}` is never closed"),
            )
            .label(text!("从这里开始", "opened here"))
            .note(text!(
                "在结束的地方写 `{close}`",
                "write `{close}` where it ends"
            ))
        }
        K::MismatchedFlowCollectionEnd { open, close } => closed_by(*open, *close, parser),
        K::InvalidColonPlacement
        | K::ExpectedFlowMappingSeparator
        | K::ExpectedFlowSequenceSeparator
        | K::UnexpectedEofFlowMapping
        | K::UnexpectedEofFlowSequence
        | K::UnexpectedEofImplicitFlowMapping => in_bracket(parser),
        K::UnexpectedCharacter { character } => {
            let character = match character {
                '`' => text!("反引号", "a backtick"),
                other => {
                    let other = other.escape_default();
                    text!("`{other}`", "`{other}`")
                }
            };
            Diagnostic::error(
                FaultCode::BadYaml,
                parser.here(),
                text!(
                    "文本的开头不能是：{character}",
                    "a text cannot start with {character}",
                    character = character
                ),
            )
            .note(text!("给文本加上引号", "put the text in quotes"))
        }
        K::DirectiveDisallowed => {
            let line = parser.text.get(parser.at..).unwrap_or_default();
            let line = line.lines().next().unwrap_or_default().trim_end();
            let span = Span::new(parser.file, parser.at, parser.at + line.len());
            Diagnostic::error(
                FaultCode::Directive,
                span,
                text!("YAML 指示", "a YAML directive"),
            )
            .label(text!(
                "规范中不用指示",
                "directives are not used in the spec"
            ))
            .note(text!(
                "删除这一行和下面的 `---`",
                "delete the line and the `---` below it"
            ))
        }
        _ => match scan_words::words(kind) {
            Some((code, [message, label, note])) => {
                let odd = (code == FaultCode::BadIndentation)
                    .then(|| odd_line(parser))
                    .flatten();
                Diagnostic::error(code, odd.unwrap_or_else(|| parser.here()), message)
                    .label(label)
                    .note(note)
            }
            None => Diagnostic::error(
                FaultCode::BadYaml,
                parser.here(),
                text!("不是 YAML：{kind}", "not YAML: {kind}"),
            ),
        },
    }
}

/// Returns the error for a bracket that is closed by another kind of bracket.
fn closed_by(open: char, close: char, parser: &ParserState<'_>) -> Diagnostic {
    let message = text!(
        "`{open}` 的闭合写成了 `{close}`",
        "the `{open}` is closed by a `{close}`"
    );
    let close_right = if open == '[' { ']' } else { '}' };
    let fault = Diagnostic::error(FaultCode::Unclosed, parser.here(), message)
        .label(text!("从这里开始", "opened here"))
        .note(text!(
            "改写为 `{close_right}`，或补上左括号",
            "write `{close_right}` instead, or add the opening bracket"
        ));
    let rest = parser.text.get(parser.understood..).unwrap_or_default();
    let closed = rest.find(close);
    let closed = closed.map(|at| parser.character(parser.understood + at));
    fault.also_if(closed, text!("在这里闭合", "closed here"))
}

/// Returns the start of the line before the error, if its indentation is the cause. The line of the error then has the
/// indentation of the next line.
fn odd_line(parser: &ParserState<'_>) -> Option<Span> {
    let indent = |line: &str| line.len() - line.trim_start_matches(' ').len();
    let is_text = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    let start = super::recover::line_start(parser.text, parser.at);
    let mut behind = parser.text.get(start..)?.lines().filter(is_text);
    let (here, next) = (indent(behind.next()?), indent(behind.next()?));
    let before = parser.text.get(..start)?;
    let line = before.lines().rev().find(is_text)?;
    let at = parser.text.get(..start)?.rfind(line)? + indent(line);
    (here == next && indent(line) > here).then(|| parser.character(at))
}

/// Returns the error for a colon that does not follow a key.
fn colon(parser: &ParserState<'_>) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadYaml,
        parser.here(),
        text!("这里不能写冒号", "a colon is not allowed here"),
    )
    .label(text!(
        "这个冒号会把前面的文本变成键",
        "this colon would turn the text before it into a key"
    ))
    .note(text!(
        "如果冒号是文本的一部分，给文本加上引号",
        "put the text in quotes if the colon belongs to it"
    ))
    .note(text!(
        "如果想写一个新的键，检查这一行的缩进",
        "if a new key was meant, check the indentation of its line"
    ));
    let before = parser.value.filter(|value| {
        let lines = parser.text.get(value.start..value.end).unwrap_or_default();
        value.end <= parser.at && lines.contains('\n')
    });
    // A line that starts like a key lacks its colon.
    let lacks_colon = before.filter(|value| {
        let line = super::recover::line_start(parser.text, value.start);
        let blanks = parser.text.get(line..value.start).unwrap_or_default();
        let text = parser.text.get(value.start..).unwrap_or_default();
        let is_plain = !text.starts_with(['"', '\'', '|', '>']);
        is_plain && blanks.trim_matches([' ', '-']).is_empty()
    });
    if let Some(value) = lacks_colon {
        let text = parser.text.get(value.start..value.end).unwrap_or_default();
        let line = text.lines().next().unwrap_or_default().trim_end().len();
        let first = Span::new(parser.file, value.start, value.start + line);
        return Diagnostic::error(
            FaultCode::BadYaml,
            first,
            text!("应为键和冒号", "expected a key followed by a colon"),
        )
        .label(text!("实际是这个", "found this"))
        .also(
            parser.here(),
            text!(
                "这个冒号所在的行被当作它的一部分",
                "the line with this colon is taken for a part of it"
            ),
        )
        .note(text!(
            "写成 `key: value`，或 `- value`，短横后要有空格",
            "write `key: value`, or `- value` with a space after the dash"
        ));
    }
    let label = text!(
        "这一行属于从这里开始的值",
        "the line belongs to the value that starts here"
    );
    fault.also_if(before.map(|value| parser.character(value.start)), label)
}

/// Returns the error for brackets whose content is followed by neither `,` nor their end.
fn in_bracket(parser: &ParserState<'_>) -> Diagnostic {
    let note = text!(
        "补上缺少的括号，或给文本加上引号",
        "add the missing bracket, or put the text in quotes"
    );
    let Some(bracket) = parser.bracket else {
        let message = text!("应为 `,` 或右括号", "expected `,` or a closing bracket");
        return Diagnostic::error(FaultCode::Unclosed, parser.here(), message)
            .label(text!("实际是这个", "found this instead"))
            .note(note);
    };
    let opened = parser.character(bracket);
    let here = parser.here();
    let between = parser
        .text
        .get(opened.start..here.start)
        .unwrap_or_default();
    let fault = if between.contains('\n') {
        let message = text!("没有闭合的括号", "a bracket that is not closed");
        Diagnostic::error(FaultCode::Unclosed, opened, message)
            .label(text!("从这里开始", "opened here"))
            .also(
                here,
                text!("到这里还没有闭合", "not closed before this point"),
            )
    } else {
        let message = text!("应为 `,` 或右括号", "expected `,` or a closing bracket");
        Diagnostic::error(FaultCode::Unclosed, here, message)
            .label(text!("实际是这个", "found this instead"))
            .also(opened, text!("从这里开始", "opened here"))
    };
    fault.note(note)
}

fn behind_quote(parser: &ParserState<'_>) -> Diagnostic {
    // If a text of several lines is followed by more text on the line, it has ended at the opening quote of another
    // text.
    let opened = parser.quote().filter(|quote| {
        let between = parser.text.get(quote.start..parser.at).unwrap_or_default();
        between.contains('\n')
    });
    if opened.is_some() {
        return unclosed_quote(parser);
    }
    let message = text!("右引号后面还有文本", "text after a closing quote");
    let fault = Diagnostic::error(FaultCode::BadYaml, parser.here(), message)
        .label(text!("不在引号之内", "not part of the quoted text"))
        .note(text!(
            "引号中要写引号：'…' 中写 `''`，\"…\" 中写 `\\\"`",
            "to write a quote inside quotes: `''` in '…', `\\\"` in \"…\""
        ));
    let label = text!("引号中的文本从这里开始", "the quoted text starts here");
    fault.also_if(parser.quote(), label)
}

/// Returns the error for too many brackets or levels.
pub(super) fn too_deep(parser: &ParserState<'_>) -> Diagnostic {
    let limit = super::limits::DEPTH;
    Diagnostic::error(
        FaultCode::TooDeep,
        parser.here(),
        text!(
            "映射和列表嵌套超过 {limit} 层",
            "more than {limit} nested mappings and lists"
        ),
    )
    .label(text!("这一层过深", "this one is too deep"))
    .note(text!(
        "为内层定义一个类型并引用它",
        "define a type for the inner ones and refer to it"
    ))
}

/// Returns the error for a tab that the parser refuses.
fn tab(parser: &ParserState<'_>) -> Diagnostic {
    let line = super::recover::line_start(parser.text, parser.at);
    // In block scalars the parser reports the `|` above the line.
    let next = parser
        .text
        .get(parser.at..)
        .and_then(|rest| rest.find('\n'));
    let next = next.map(|newline| parser.at + newline + 1);
    std::iter::once(line)
        .chain(next)
        .find_map(|line| indenting_tab(parser.file, parser.text, line))
        .unwrap_or_else(|| {
            let message = text!("这里不能用制表符", "a tab is not allowed here");
            Diagnostic::error(FaultCode::Tab, parser.here(), message)
                .note(text!("改用空格", "write spaces instead"))
        })
}

/// Returns the error for a line that starts with white space containing a tab.
pub(super) fn indenting_tab(file: FileId, text: &str, line: usize) -> Option<Diagnostic> {
    let rest = text.get(line..)?;
    let white = rest.get(..rest.len() - rest.trim_start_matches([' ', '\t']).len())?;
    let tabs = white.get(white.find('\t')?..)?;
    let span = Span::new(file, line + white.len() - tabs.len(), line + white.len());
    Some(
        Diagnostic::error(
            FaultCode::Tab,
            span,
            text!("用制表符缩进", "a tab used for indentation"),
        )
        .label(text!("以制表符开头", "starts with a tab"))
        .note(text!(
            "用空格缩进，每级两个",
            "indent with spaces, two per level"
        ))
        .fix(
            span,
            tabs.replace('\t', "  "),
            text!("改用空格", "write spaces instead"),
        ),
    )
}

fn unclosed_quote(parser: &ParserState<'_>) -> Diagnostic {
    let message = text!("引号没有闭合的文本", "a quoted text that is never closed");
    let note = text!(
        "补上右引号，或让文本各行的缩进比键更深",
        "write the closing quote, or indent the lines of the text deeper than its key"
    );
    let Some(quote) = parser.quote() else {
        return Diagnostic::error(FaultCode::Unclosed, parser.here(), message)
            .label(text!("到这里无法继续", "cannot continue here"))
            .note(note);
    };
    let fault = Diagnostic::error(FaultCode::Unclosed, quote, message)
        .label(text!("从这里开始", "opened here"));
    let rest = parser.text.get(parser.at..).unwrap_or_default();
    let stopped = (!rest.trim().is_empty()).then(|| parser.here());
    let label = text!("到这里无法继续", "cannot continue here");
    fault.also_if(stopped, label).note(note)
}
