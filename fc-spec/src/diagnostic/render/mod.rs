//! Faults for people, editors and machines.

mod github;
mod json;
mod sarif;
mod summary;
mod text;

pub use summary::summary;

use super::Faults;
use crate::syntax::Sources;

/// A way to show faults.
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

/// All faults in one format, ending with a newline if there are any. SARIF also has a log of nothing.
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
/// `label`.
#[must_use]
pub fn render(faults: &Faults, sources: &Sources, format: Format) -> String {
    match format {
        Format::Colored => text::render(faults, sources, true),
        Format::Text => text::render(faults, sources, false),
        Format::Json => json::render(faults, sources),
        Format::Sarif => sarif::render(faults, sources),
        Format::Github => github::render(faults, sources),
    }
}
