//! The parser's errors in this project's words.

use granit_parser::ErrorKind;

use super::{FileId, Span};
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
    let at = |code, message: &str, label: &str| {
        Diagnostic::error(code, place.here(), message).label(label)
    };
    match kind {
        K::RecursionLimitExceeded => too_deep(place),
        K::TabNotAllowed
        | K::TabInBlockIndentation
        | K::TabInIndentation
        | K::TabInPlainScalar
        | K::TabAtBlockScalarStart => tab(tab_before(place)),
        K::DirectiveDisallowed => at(FaultCode::Directive, "a YAML directive", "directives have no place in the spec")
            .note("delete the line and the `---` below it"),
        K::UnclosedFlowCollection { open } => {
            let close = if *open == '[' { ']' } else { '}' };
            at(
                FaultCode::Unclosed,
                &format!("the `{open}` is never closed"),
                "opened here",
            )
            .note(format!("write `{close}` where it ends"))
        }
        K::MismatchedFlowCollectionEnd { open, close } => at(
            FaultCode::Unclosed,
            &format!("the `{open}` is closed by a `{close}`"),
            "opened here",
        ),
        K::MisplacedFlowCollectionEnd => at(
            FaultCode::BadYaml,
            "a closing bracket without an opening one",
            "closes nothing",
        )
        .note("delete it, or put the text in quotes"),
        K::UnclosedQuotedScalar | K::InvalidQuotedScalarIndent | K::DocumentIndicatorInQuotedScalar => {
            unclosed_quote(place)
        }
        K::InvalidTrailingSingleQuotedScalar | K::InvalidTrailingDoubleQuotedScalar => {
            let fault = at(FaultCode::BadYaml, "text behind a closing quote", "belongs to nothing")
                .note("to write a quote inside quotes: `''` in '…', `\\\"` in \"…\"");
            match place.quote() {
                Some(quote) => fault.also(quote, "the quoted text starts here"),
                None => fault,
            }
        }
        K::UnknownQuotedScalarEscape
        | K::InvalidQuotedScalarHexEscape
        | K::InvalidLowSurrogateHexEscape
        | K::InvalidLowSurrogate
        | K::MissingLowSurrogate
        | K::UnpairedLowSurrogate
        | K::InvalidUnicodeEscape => at(FaultCode::BadEscape, "an escape that YAML does not know", "in the text that starts here")
            .note("write `\\\\` for a backslash in \"…\", or use '…', in which a backslash is a backslash"),
        K::MappingValueNotAllowed => at(
            FaultCode::BadYaml,
            "a second colon in one value",
            "this colon would make a mapping of the text before it",
        )
        .note("put the text in quotes if the colon belongs to it; if a new key was meant, check the indentation of its line"),
        K::InvalidColonPlacement
        | K::ExpectedFlowMappingSeparator
        | K::ExpectedFlowSequenceSeparator
        | K::UnexpectedEofFlowMapping
        | K::UnexpectedEofFlowSequence
        | K::UnexpectedEofImplicitFlowMapping => {
            let fault = at(FaultCode::Unclosed, "expected `,` or a closing bracket", "found this instead");
            match place.bracket {
                Some(bracket) => fault.also(place.character(bracket), "in the bracket opened here"),
                None => fault,
            }
        }
        K::ExpectedBlockMappingKey
        | K::ExpectedBlockSequenceEntry
        | K::InvalidIndentation
        | K::InvalidBlockScalarIndent
        | K::InvalidFlowScalarIndent
        | K::UnexpectedEofBlockMapping
        | K::UnexpectedEofBlockSequence => at(
            FaultCode::BadIndentation,
            "this line fits neither the mapping or list before it nor any around it",
            "starts here",
        )
        .note("indent it like the lines it belongs to: two spaces per level"),
        K::BlockSequenceEntryNotAllowed | K::BlockEntryInFlowCollection => at(
            FaultCode::BadYaml,
            "a list item where none can stand",
            "this `-`",
        )
        .note("start each item on a line of its own, below the key; in brackets write items without `-`"),
        K::SimpleKeyExpected | K::InvalidSimpleKey => at(
            FaultCode::BadYaml,
            "expected a key with a colon behind it",
            "found this",
        )
        .note("write `key: value`, or `- value` with a space behind the dash"),
        K::UnexpectedCharacter { character } => at(
            FaultCode::BadYaml,
            &format!("a text cannot start with `{}`", character.escape_default()),
            "here",
        )
        .note("put the text in quotes"),
        K::CommentNotSeparated => at(FaultCode::BadYaml, "a comment without a space before it", "here")
            .note("write a space before the `#`, or put the text in quotes if the `#` belongs to it"),
        other => at(FaultCode::BadYaml, &format!("not YAML: {other}"), "here"),
    }
}

/// Too many brackets or levels.
pub(super) fn too_deep(place: &Place<'_>) -> Diagnostic {
    let limit = super::limits::DEPTH;
    Diagnostic::error(
        FaultCode::TooDeep,
        place.here(),
        format!("more than {limit} mappings and lists inside one another"),
    )
    .label("this one is too deep")
    .note("define a type for the inner ones and name it")
}

/// A tab that indents.
pub(super) fn tab(span: Span) -> Diagnostic {
    Diagnostic::error(FaultCode::Tab, span, "a tab as indentation")
        .label("this tab")
        .note("indent with spaces, two per level")
        .fix(span, "  ", "write spaces instead")
}

/// The first tab in the white space around the place; the parser points behind it.
fn tab_before(place: &Place<'_>) -> Span {
    let start = super::recover::line_start(place.text, place.at);
    let line = place.text.get(start..).unwrap_or_default();
    let line = line.split_once('\n').map_or(line, |(line, _)| line);
    let white = line.len() - line.trim_start_matches([' ', '\t']).len();
    match line.get(..white).and_then(|white| white.find('\t')) {
        Some(tab) => Span::new(place.file, start + tab, start + tab + 1),
        None => place.here(),
    }
}

fn unclosed_quote(place: &Place<'_>) -> Diagnostic {
    let message = "a quoted text that is never closed";
    match place.quote() {
        Some(quote) => Diagnostic::error(FaultCode::Unclosed, quote, message)
            .label("opened here")
            .also(place.here(), "cannot go on here"),
        None => {
            Diagnostic::error(FaultCode::Unclosed, place.here(), message).label("cannot go on here")
        }
    }
    .note("write the closing quote, or indent the lines of the text deeper than its key")
}
