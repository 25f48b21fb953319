//! The parser's errors in this project's words.

use granit_parser::ErrorKind;

use super::span::{FileId, Span};
use crate::diagnostic::{Diagnostic, FaultCode};

/// Where the parser gave up, and what it had understood by then.
pub(super) struct Place<'a> {
    /// The file.
    pub file: FileId,
    /// Its whole text.
    pub text: &'a str,
    /// Byte at which the parser gave up.
    pub at: usize,
    /// End of what it had understood.
    pub understood: usize,
    /// The last value it had understood.
    pub value: Option<Span>,
    /// Start of the innermost bracket that is open.
    pub bracket: Option<usize>,
}

impl Place<'_> {
    /// The character at `at`; nothing at the end of a line.
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

    /// The opening quote of the text that was being read.
    fn quote(&self) -> Option<Span> {
        let rest = self.text.get(self.understood..)?;
        let before = rest.trim_start_matches([' ', '\t', '\r', '\n', ':', ',', '-', '?', '[', '{']);
        before
            .starts_with(['"', '\''])
            .then(|| self.character(self.understood + rest.len() - before.len()))
    }
}

/// The fault for an error of the parser.
pub(super) fn diagnose(kind: &ErrorKind, place: &Place<'_>) -> Diagnostic {
    use ErrorKind as K;
    match kind {
        K::RecursionLimitExceeded => too_deep(place),
        K::TabNotAllowed
        | K::TabInBlockIndentation
        | K::TabInIndentation
        | K::TabInPlainScalar
        | K::TabAtBlockScalarStart => tab(place),
        K::MappingValueNotAllowed => colon(place),
        K::UnclosedQuotedScalar
        | K::InvalidQuotedScalarIndent
        | K::DocumentIndicatorInQuotedScalar => unclosed_quote(place),
        K::InvalidTrailingSingleQuotedScalar | K::InvalidTrailingDoubleQuotedScalar => {
            behind_quote(place)
        }
        K::UnclosedFlowCollection { open } => {
            let close = if *open == '[' { ']' } else { '}' };
            Diagnostic::error(
                FaultCode::Unclosed,
                place.here(),
                format!("the `{open}` is never closed"),
            )
            .label("opened here")
            .note(format!("write `{close}` where it ends"))
        }
        K::MismatchedFlowCollectionEnd { open, close } => {
            let message = format!("the `{open}` is closed by a `{close}`");
            let close_right = if *open == '[' { ']' } else { '}' };
            let fault = Diagnostic::error(FaultCode::Unclosed, place.here(), message)
                .label("opened here")
                .note(format!(
                    "write `{close_right}` instead, or add the opening bracket"
                ));
            match place
                .text
                .get(place.understood..)
                .and_then(|rest| rest.find(*close))
            {
                Some(at) => fault.also(place.character(place.understood + at), "closed here"),
                None => fault,
            }
        }
        K::InvalidColonPlacement
        | K::ExpectedFlowMappingSeparator
        | K::ExpectedFlowSequenceSeparator
        | K::UnexpectedEofFlowMapping
        | K::UnexpectedEofFlowSequence
        | K::UnexpectedEofImplicitFlowMapping => in_bracket(place),
        K::UnexpectedCharacter { character } => {
            let character = match character {
                '`' => "a backtick".to_owned(),
                other => format!("`{}`", other.escape_default()),
            };
            Diagnostic::error(
                FaultCode::BadYaml,
                place.here(),
                format!("a text cannot start with {character}"),
            )
            .note("put the text in quotes")
        }
        K::DirectiveDisallowed => {
            let line = place.text.get(place.at..).unwrap_or_default();
            let line = line.lines().next().unwrap_or_default().trim_end();
            let span = Span::new(place.file, place.at, place.at + line.len());
            Diagnostic::error(FaultCode::Directive, span, "a YAML directive")
                .label("directives are not used in the spec")
                .note("delete the line and the `---` below it")
        }
        _ => match words(kind) {
            Some((code, message, label, note)) => {
                let odd = (code == FaultCode::BadIndentation)
                    .then(|| odd_line(place))
                    .flatten();
                Diagnostic::error(code, odd.unwrap_or_else(|| place.here()), message)
                    .label(label)
                    .note(note)
            }
            None => Diagnostic::error(
                FaultCode::BadYaml,
                place.here(),
                format!("not YAML: {kind}"),
            ),
        },
    }
}

/// Code, message, label and note of the errors that need nothing but their place.
fn words(kind: &ErrorKind) -> Option<(FaultCode, &'static str, &'static str, &'static str)> {
    use ErrorKind as K;
    Some(match kind {
        K::MisplacedFlowCollectionEnd => (
            FaultCode::BadYaml,
            "a closing bracket without an opening one",
            "does not match an opening bracket",
            "delete it, or put the text in quotes",
        ),
        K::UnknownQuotedScalarEscape
        | K::InvalidQuotedScalarHexEscape
        | K::InvalidLowSurrogateHexEscape
        | K::InvalidLowSurrogate
        | K::MissingLowSurrogate
        | K::UnpairedLowSurrogate
        | K::InvalidUnicodeEscape => (
            FaultCode::BadEscape,
            "an unknown escape",
            "in the text that starts here",
            "write `\\\\` for a backslash in \"…\", or use '…', in which a backslash is a backslash",
        ),
        K::ExpectedBlockMappingKey
        | K::ExpectedBlockSequenceEntry
        | K::InvalidIndentation
        | K::InvalidBlockScalarIndent
        | K::InvalidFlowScalarIndent
        | K::UnexpectedEofBlockMapping
        | K::UnexpectedEofBlockSequence => (
            FaultCode::BadIndentation,
            "the indentation of this line does not match any mapping or list it could belong to",
            "starts here",
            "indent it like the lines it belongs to: two spaces per level",
        ),
        K::BlockSequenceEntryNotAllowed | K::BlockEntryInFlowCollection => (
            FaultCode::BadYaml,
            "a list item is not allowed here",
            "this `-`",
            "start each item on its own line below the key; in brackets, write items without `-`",
        ),
        K::SimpleKeyExpected | K::InvalidSimpleKey => (
            FaultCode::BadYaml,
            "expected a key followed by a colon",
            "found this",
            "write `key: value`, or `- value` with a space after the dash",
        ),
        K::ExpectedTagBang
        | K::InvalidGlobalTagCharacter
        | K::InvalidTagTerminator
        | K::MissingTagUri
        | K::UnclosedVerbatimTag
        | K::InvalidTagEscape
        | K::InvalidTagUtf8LeadingByte
        | K::InvalidTagUtf8TrailingByte
        | K::InvalidTagUtf8
        | K::UndeclaredTagHandle => (
            FaultCode::Tag,
            "an invalid tag",
            "tags are not used in the spec",
            "put the text in quotes if it starts with a `!`",
        ),
        K::MissingAnchorOrAliasName => (
            FaultCode::BadYaml,
            "a text cannot start with `&` or `*`",
            "here",
            "put the text in quotes",
        ),
        K::CommentNotSeparated | K::CommentInterceptedScalar => (
            FaultCode::BadYaml,
            "a comment is not allowed here",
            "here",
            "write a space before the `#`, or put the text in quotes if the `#` belongs to it",
        ),
        _ => return None,
    })
}

/// The start of the line before the error where that is the one that is indented otherwise than those around it: the
/// line of the error begins where the next one does.
fn odd_line(place: &Place<'_>) -> Option<Span> {
    let indent = |line: &str| line.len() - line.trim_start_matches(' ').len();
    let is_text = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    let start = super::recover::line_start(place.text, place.at);
    let mut behind = place.text.get(start..)?.lines().filter(is_text);
    let (here, next) = (indent(behind.next()?), indent(behind.next()?));
    let before = place.text.get(..start)?;
    let line = before.lines().rev().find(is_text)?;
    let at = place.text.get(..start)?.rfind(line)? + indent(line);
    (here == next && indent(line) > here).then(|| place.character(at))
}

/// A colon that makes no key.
fn colon(place: &Place<'_>) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadYaml,
        place.here(),
        "a colon is not allowed here",
    )
    .label("this colon would turn the text before it into a key")
    .note("put the text in quotes if the colon belongs to it")
    .note("if a new key was meant, check the indentation of its line");
    let before = place.value.filter(|value| {
        let lines = place.text.get(value.start..value.end).unwrap_or_default();
        value.end <= place.at && lines.contains('\n')
    });
    // A line that is no key but begins like one: its own colon is missing.
    let lacks_colon = before.filter(|value| {
        let line = super::recover::line_start(place.text, value.start);
        let blanks = place.text.get(line..value.start).unwrap_or_default();
        let is_plain = !place
            .text
            .get(value.start..)
            .unwrap_or_default()
            .starts_with(['"', '\'', '|', '>']);
        is_plain && blanks.trim_matches([' ', '-']).is_empty()
    });
    if let Some(value) = lacks_colon {
        let text = place.text.get(value.start..value.end).unwrap_or_default();
        let line = text.lines().next().unwrap_or_default().trim_end().len();
        let first = Span::new(place.file, value.start, value.start + line);
        return Diagnostic::error(
            FaultCode::BadYaml,
            first,
            "expected a key followed by a colon",
        )
        .label("found this")
        .also(
            place.here(),
            "the line with this colon is taken for a part of it",
        )
        .note("write `key: value`, or `- value` with a space after the dash");
    }
    match before {
        Some(value) => fault.also(
            place.character(value.start),
            "the line belongs to the value that starts here",
        ),
        None => fault,
    }
}

/// A list or mapping in brackets that goes on with something else than `,` or its end.
fn in_bracket(place: &Place<'_>) -> Diagnostic {
    let note = "add the missing bracket, or put the text in quotes";
    let Some(bracket) = place.bracket else {
        let message = "expected `,` or a closing bracket";
        return Diagnostic::error(FaultCode::Unclosed, place.here(), message)
            .label("found this instead")
            .note(note);
    };
    let opened = place.character(bracket);
    let here = place.here();
    let between = place.text.get(opened.start..here.start).unwrap_or_default();
    let fault = if between.contains('\n') {
        let message = "a bracket that is not closed";
        Diagnostic::error(FaultCode::Unclosed, opened, message)
            .label("opened here")
            .also(here, "not closed before this point")
    } else {
        let message = "expected `,` or a closing bracket";
        Diagnostic::error(FaultCode::Unclosed, here, message)
            .label("found this instead")
            .also(opened, "opened here")
    };
    fault.note(note)
}

fn behind_quote(place: &Place<'_>) -> Diagnostic {
    // A text of several lines, behind which there is more on the line, ends at the opening quote of another one.
    let opened = place.quote().filter(|quote| {
        let between = place.text.get(quote.start..place.at).unwrap_or_default();
        between.contains('\n')
    });
    if opened.is_some() {
        return unclosed_quote(place);
    }
    let message = "text after a closing quote";
    let fault = Diagnostic::error(FaultCode::BadYaml, place.here(), message)
        .label("not part of the quoted text")
        .note("to write a quote inside quotes: `''` in '…', `\\\"` in \"…\"");
    match place.quote() {
        Some(quote) => fault.also(quote, "the quoted text starts here"),
        None => fault,
    }
}

/// Too many brackets or levels.
pub(super) fn too_deep(place: &Place<'_>) -> Diagnostic {
    let limit = super::limits::DEPTH;
    Diagnostic::error(
        FaultCode::TooDeep,
        place.here(),
        format!("more than {limit} nested mappings and lists"),
    )
    .label("this one is too deep")
    .note("define a type for the inner ones and refer to it")
}

/// A tab that the parser stumbled over.
fn tab(place: &Place<'_>) -> Diagnostic {
    let line = super::recover::line_start(place.text, place.at);
    // In block texts the parser points at the `|` above the line.
    let next = place.text.get(place.at..).and_then(|rest| rest.find('\n'));
    let next = next.map(|newline| place.at + newline + 1);
    std::iter::once(line)
        .chain(next)
        .find_map(|line| indenting_tab(place.file, place.text, line))
        .unwrap_or_else(|| {
            let message = "a tab is not allowed here";
            Diagnostic::error(FaultCode::Tab, place.here(), message).note("write spaces instead")
        })
}

/// The fault of a line that starts with white space in which there is a tab.
pub(super) fn indenting_tab(file: FileId, text: &str, line: usize) -> Option<Diagnostic> {
    let rest = text.get(line..)?;
    let white = rest.get(..rest.len() - rest.trim_start_matches([' ', '\t']).len())?;
    let tabs = white.get(white.find('\t')?..)?;
    let span = Span::new(file, line + white.len() - tabs.len(), line + white.len());
    Some(
        Diagnostic::error(FaultCode::Tab, span, "a tab used for indentation")
            .label("starts with a tab")
            .note("indent with spaces, two per level")
            .fix(span, tabs.replace('\t', "  "), "write spaces instead"),
    )
}

fn unclosed_quote(place: &Place<'_>) -> Diagnostic {
    let message = "a quoted text that is never closed";
    let note = "write the closing quote, or indent the lines of the text deeper than its key";
    let Some(quote) = place.quote() else {
        return Diagnostic::error(FaultCode::Unclosed, place.here(), message)
            .label("cannot continue here")
            .note(note);
    };
    let fault = Diagnostic::error(FaultCode::Unclosed, quote, message).label("opened here");
    let rest = place.text.get(place.at..).unwrap_or_default();
    if rest.trim().is_empty() {
        fault.note(note)
    } else {
        fault.also(place.here(), "cannot continue here").note(note)
    }
}
