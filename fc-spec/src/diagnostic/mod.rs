//! Faults of a spec and how they are shown.
//!
//! A [`Diagnostic`] says what is wrong, where, and what to do; its [`FaultCode`] is fixed and has an
//! explanation. All that it says is a [`Text`], in both languages. Whoever finds a fault pushes it to [`Faults`] and goes on, so that one run shows all.

mod codes;
mod render;
mod suggest;

pub use codes::FaultCode;
pub use render::{Format, render, summary};
pub use suggest::nearest;

use crate::model::Text;
use crate::syntax::Span;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Nothing can be generated.
    Error,
    /// Worth a look.
    Warning,
}

/// A place and what to say about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// A few words beside it; may be empty for the primary place.
    pub text: Text,
}

/// A change that mends the fault.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// What to replace; empty to insert.
    pub span: Span,
    /// With what; empty to delete.
    pub replacement: String,
    /// What the change does, such as "a type with a similar name exists".
    pub message: Text,
    /// Other places of the same fault, at which the same is replaced.
    pub elsewhere: Vec<Span>,
}

impl Fix {
    /// All places of the fault, its first one first.
    pub fn places(&self) -> impl Iterator<Item = Span> {
        std::iter::once(self.span).chain(self.elsewhere.iter().copied())
    }
}

/// A fault of the spec.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Which fault it is.
    pub code: FaultCode,
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong: one sentence, no full stop, starting in lower case.
    pub message: Text,
    /// Where.
    pub primary: Label,
    /// Other places to blame ("first used here").
    pub secondary: Vec<Label>,
    /// What to do or to know.
    pub notes: Vec<Text>,
    /// Changes that mend it.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// An error at `span`.
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

    /// A warning at `span`.
    #[must_use]
    pub fn warning(code: FaultCode, span: Span, message: Text) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(code, span, message)
        }
    }

    /// A few words at the primary place.
    #[must_use]
    pub fn label(mut self, text: Text) -> Self {
        self.primary.text = text;
        self
    }

    /// Another place to blame.
    #[must_use]
    pub fn also(mut self, span: Span, text: Text) -> Self {
        self.secondary.push(Label { span, text });
        self
    }

    /// What to do or to know.
    #[must_use]
    pub fn note(mut self, text: Text) -> Self {
        self.notes.push(text);
        self
    }

    /// A change that mends it.
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

    /// Another place at which each fix so far replaces the same.
    #[must_use]
    pub fn fix_also(mut self, span: Span) -> Self {
        for fix in &mut self.fixes {
            fix.elsewhere.push(span);
        }
        self
    }
}

/// Most diagnostics that are kept; the rest is only counted.
const KEPT: usize = 1000;

/// The faults found so far.
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
    /// None yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one. Past a thousand they are counted, not kept.
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

    /// Notes that because of a fault nobody reads this text: what seems to be missing may be in it.
    pub(crate) fn hide(&mut self, text: Span) {
        self.hidden.push(text);
    }

    /// Notes that there are entries in this text, which is hidden as it is no YAML: what it stands in lacks them.
    pub(crate) fn leave_out(&mut self, text: Span) {
        self.hide(text);
        self.gaps.push(text);
    }

    /// Texts that are left out.
    pub(crate) fn gaps(&self) -> &[Span] {
        &self.gaps
    }

    /// Notes that because of a fault something has lost its name, or is lost with it: of nothing can be said that it is
    /// missing.
    pub(crate) fn lose(&mut self) {
        self.nameless = true;
    }

    /// Whether something is lost of which the name is not known.
    pub(crate) fn has_lost(&self) -> bool {
        self.nameless
    }

    /// Texts that nobody reads because of one of these faults.
    pub(crate) fn hidden(&self) -> &[Span] {
        &self.hidden
    }

    /// Adds all of another list behind these.
    pub fn append(&mut self, other: Self) {
        self.hidden.extend(other.hidden);
        self.gaps.extend(other.gaps);
        self.nameless |= other.nameless;
        let room = KEPT.saturating_sub(self.list.len());
        self.errors += other.errors;
        self.omitted += other.omitted + other.list.len().saturating_sub(room);
        self.list.extend(other.list.into_iter().take(room));
    }

    /// Keeps those of which this is true; those that are only counted stay counted.
    pub(crate) fn retain(&mut self, is_kept: impl Fn(&Diagnostic) -> bool) {
        let errors = &mut self.errors;
        self.list.retain(|fault| {
            let kept = is_kept(fault);
            *errors -= usize::from(!kept && fault.severity == Severity::Error);
            kept
        });
    }

    /// Whether one of them says to write this.
    pub(crate) fn suggests(&self, text: &str) -> bool {
        let mut fixes = self.list.iter().flat_map(|fault| &fault.fixes);
        fixes.any(|fix| fix.replacement == text)
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// How many are kept.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether anything stands in the way of generating.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// Number of errors, also of those that are not kept.
    #[must_use]
    pub fn errors(&self) -> usize {
        self.errors
    }

    /// Number of warnings, also of those that are not kept.
    #[must_use]
    pub fn warnings(&self) -> usize {
        self.list.len() + self.omitted - self.errors
    }

    /// How many were counted but not kept.
    #[must_use]
    pub fn omitted(&self) -> usize {
        self.omitted
    }

    /// Puts them in the order of the files and of their places in them.
    pub fn sort(&mut self) {
        self.list
            .sort_by_key(|fault| (fault.primary.span, fault.severity, fault.code));
    }

    /// Those that are kept.
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
