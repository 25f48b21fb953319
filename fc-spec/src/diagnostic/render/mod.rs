//! Output of errors for people, editors and machines.

mod github;
mod json;
mod sarif;
mod summary;
mod text;

pub use summary::summary;

use super::{Faults, Severity};
use crate::model::Lang;
use crate::source::Sources;

/// An output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// For people, with the places in the source and ANSI colours.
    Colored,
    /// The same without colours.
    Text,
    /// One JSON object per line.
    Json,
    /// One SARIF 2.1.0 log.
    Sarif,
    /// Workflow commands that make annotations on GitHub.
    Github,
}

/// Renders all errors in one format and language, ending with a newline if there are any. SARIF has a log even without
/// errors.
///
/// # JSON
///
/// Each line is an object with these keys, all always present:
///
/// - `code` (`"FC0012"`), `severity` (`"error"` or `"warning"`), `title` (of the code), `message`
/// - `primary`: a place, and `secondary`: places
/// - `notes`: texts
/// - `fixes`: objects with `message`, `replacement` and `place`, the place to replace
///
/// A place has `path` (from the project's root), `line`, `column`, `end_line`, `end_column` (counted from 1,
/// columns in Unicode characters, the end not included), `start`, `end` (bytes, counted from behind a byte order mark) and
/// `label`. The texts are in `lang`; keys, codes and severities are not.
#[must_use]
pub fn render(faults: &Faults, sources: &Sources, format: Format, lang: Lang) -> String {
    match format {
        Format::Colored => text::render(faults, sources, true, lang),
        Format::Text => text::render(faults, sources, false, lang),
        Format::Json => json::render(faults, sources, lang),
        Format::Sarif => sarif::render(faults, sources, lang),
        Format::Github => github::render(faults, sources, lang),
    }
}

impl Severity {
    /// Returns its word in formats for machines.
    const fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
        }
    }

    /// Returns its word for people.
    fn word(self, lang: Lang) -> &'static str {
        match self {
            Self::Error => lang.pick("错误", "error"),
            Self::Warning => lang.pick("警告", "warning"),
        }
    }
}
