//! Errors of a spec, and their output.
//!
//! A [`Diagnostic`] describes an error, its place and its fix. Its [`FaultCode`] is fixed and has an explanation. Every
//! sentence is a [`Text`] in both languages. A check pushes each error to [`Faults`] and continues, so that one run
//! shows all.

mod codes;
mod render;
mod suggest;

pub(crate) use codes::explained;
pub use codes::{FaultCode, LintCode};
pub use render::{Format, render, summary};
pub use suggest::nearest;

use crate::model::Text;
use crate::source::Span;
use crate::text;

/// The severity of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Stops `fcproto generate`.
    Error,
    /// Does not stop anything.
    Warning,
}

/// A place with a short text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// A few words next to the place; may be empty for the primary place.
    pub text: Text,
}

/// A change that fixes the error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// The text to replace; empty to insert.
    pub span: Span,
    /// The new text; empty to delete.
    pub replacement: String,
    /// Describes the change, such as "a type with a similar name exists".
    pub message: Text,
    /// Other places with the same replacement.
    pub elsewhere: Vec<Span>,
}

impl Fix {
    /// Returns all places, starting with [`span`](Self::span).
    pub fn places(&self) -> impl Iterator<Item = Span> {
        std::iter::once(self.span).chain(self.elsewhere.iter().copied())
    }
}

/// An error or warning of the spec.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The code.
    pub code: FaultCode,
    /// The severity.
    pub severity: Severity,
    /// The message: one sentence without a full stop, starting in lower case.
    pub message: Text,
    /// The place of the error.
    pub primary: Label,
    /// Other places involved ("first used here").
    pub secondary: Vec<Label>,
    /// Notes, in the imperative where they tell what to do.
    pub notes: Vec<Text>,
    /// Changes that fix it.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// Creates an error at `span`.
    #[must_use]
    pub fn error(code: FaultCode, span: Span, message: Text) -> Self {
        Self {
            code,
            severity: Severity::Error,
            message,
            primary: Label {
                span,
                text: Text::default(),
            },
            secondary: Vec::new(),
            notes: Vec::new(),
            fixes: Vec::new(),
        }
    }

    /// Creates a warning at `span`.
    #[must_use]
    pub fn warning(code: FaultCode, span: Span, message: Text) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(code, span, message)
        }
    }

    /// Adds a few words at the primary place.
    #[must_use]
    pub fn label(mut self, text: Text) -> Self {
        self.primary.text = text;
        self
    }

    /// Adds another place.
    #[must_use]
    pub fn also(mut self, span: Span, text: Text) -> Self {
        self.secondary.push(Label { span, text });
        self
    }

    /// Adds another place, if there is one.
    pub(crate) fn also_if(mut self, span: Option<Span>, text: Text) -> Self {
        self.secondary.extend(span.map(|span| Label { span, text }));
        self
    }

    /// Adds a note.
    #[must_use]
    pub fn note(mut self, text: Text) -> Self {
        self.notes.push(text);
        self
    }

    /// Adds a change that fixes the error.
    #[must_use]
    pub fn fix(mut self, span: Span, replacement: impl Into<String>, message: Text) -> Self {
        self.fixes.push(Fix {
            span,
            replacement: replacement.into(),
            message,
            elsewhere: Vec::new(),
        });
        self
    }

    /// Proposes a name with a similar spelling for the primary place. Without one, adds the note.
    pub(crate) fn suggest(self, near: Option<&str>, otherwise: Option<Text>) -> Self {
        let span = self.primary.span;
        match (near, otherwise) {
            (Some(near), _) => {
                let message = text!("是否想写 `{near}`？", "did you mean `{near}`?");
                self.fix(span, near, message)
            }
            (None, Some(note)) => self.note(note),
            (None, None) => self,
        }
    }

    /// Adds another place with the same replacement to each fix.
    #[must_use]
    pub fn fix_also(mut self, span: Span) -> Self {
        for fix in &mut self.fixes {
            fix.elsewhere.push(span);
        }
        self
    }
}

/// Maximum number of diagnostics to keep; further ones are only counted.
const KEPT: usize = 1000;

/// The errors found so far.
#[derive(Clone, Debug, Default)]
pub struct Faults {
    list: Vec<Diagnostic>,
    omitted: usize,
    errors: usize,
    hidden: Vec<Span>,
    gaps: Vec<Span>,
    nameless: bool,
}

impl Faults {
    /// Creates an empty list.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a diagnostic. Above the maximum it is counted and not kept.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if diagnostic.severity == Severity::Error {
            self.errors += 1;
        }
        if self.list.len() < KEPT {
            self.list.push(diagnostic);
        } else {
            self.omitted += 1;
        }
    }

    /// Marks a text that is not read because of an error. It may contain keys that seem to be missing.
    pub(crate) fn hide(&mut self, text: Span) {
        self.hidden.push(text);
    }

    /// Marks a hidden text that is not YAML and contains entries. The surrounding value lacks them.
    pub(crate) fn leave_out(&mut self, text: Span) {
        self.hide(text);
        self.gaps.push(text);
    }

    /// Returns the hidden texts with entries.
    pub(crate) fn gaps(&self) -> &[Span] {
        &self.gaps
    }

    /// Records that an error hides a name or a definition. After this, no definition is reported as missing.
    pub(crate) fn lose(&mut self) {
        self.nameless = true;
    }

    /// Returns `true` if an error hides a definition with an unknown name.
    pub(crate) fn has_lost(&self) -> bool {
        self.nameless
    }

    /// Returns the texts that are not read because of these errors.
    pub(crate) fn hidden(&self) -> &[Span] {
        &self.hidden
    }

    /// Adds all of another list at the end.
    pub fn append(&mut self, other: Self) {
        self.hidden.extend(other.hidden);
        self.gaps.extend(other.gaps);
        self.nameless |= other.nameless;
        let room = KEPT.saturating_sub(self.list.len());
        self.errors += other.errors;
        self.omitted += other.omitted + other.list.len().saturating_sub(room);
        self.list.extend(other.list.into_iter().take(room));
    }

    /// Keeps the diagnostics for which the predicate is true. Counts of diagnostics that were not kept stay.
    pub(crate) fn retain(&mut self, is_kept: impl Fn(&Diagnostic) -> bool) {
        let errors = &mut self.errors;
        self.list.retain(|fault| {
            let kept = is_kept(fault);
            *errors -= usize::from(!kept && fault.severity == Severity::Error);
            kept
        });
    }

    /// Returns `true` if a fix has this replacement.
    pub(crate) fn suggests(&self, text: &str) -> bool {
        let mut fixes = self.list.iter().flat_map(|fault| &fault.fixes);
        fixes.any(|fix| fix.replacement == text)
    }

    /// Returns `true` if the list is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Returns the number of diagnostics kept.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Returns `true` if there are errors, so that nothing can be generated.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// Returns the number of errors, including those not kept.
    #[must_use]
    pub fn errors(&self) -> usize {
        self.errors
    }

    /// Returns the number of warnings, including those not kept.
    #[must_use]
    pub fn warnings(&self) -> usize {
        self.list.len() + self.omitted - self.errors
    }

    /// Returns the number of diagnostics counted but not kept.
    #[must_use]
    pub fn omitted(&self) -> usize {
        self.omitted
    }

    /// Sorts them by file and by place.
    pub fn sort(&mut self) {
        self.list
            .sort_by_key(|fault| (fault.primary.span, fault.severity, fault.code));
    }

    /// Returns the diagnostics kept.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.list.iter()
    }
}

impl<'a> IntoIterator for &'a Faults {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl Extend<Diagnostic> for Faults {
    fn extend<I: IntoIterator<Item = Diagnostic>>(&mut self, diagnostics: I) {
        for diagnostic in diagnostics {
            self.push(diagnostic);
        }
    }
}
