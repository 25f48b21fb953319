//! Places and fixes that errors of several checks have in common.

use crate::diagnostic::Diagnostic;
use crate::source::Span;
use crate::syntax::quoted;
use crate::text;

impl Diagnostic {
    /// Adds the place of the first of two equal things.
    pub(super) fn also_first(self, span: Span) -> Self {
        self.also(span, text!("首次出现在这里", "first used here"))
    }

    /// Adds the declaration of the thing that the text at the primary place names.
    pub(super) fn also_declared(self, span: Span) -> Self {
        self.also(span, text!("在这里声明", "declared here"))
    }

    /// Adds the type of the field at the primary place.
    pub(super) fn also_type(self, span: Span) -> Self {
        self.also(span, text!("类型", "the type"))
    }

    /// Proposes another text for the primary place.
    pub(super) fn write(self, better: impl Into<String>) -> Self {
        let (span, better) = (self.primary.span, better.into());
        let message = text!("改写为 `{better}`", "write `{better}`");
        self.fix(span, better, message)
    }

    /// Proposes quotes around the text at the primary place.
    pub(super) fn quote(self, text: &str) -> Self {
        let span = self.primary.span;
        self.fix(span, quoted(text), text!("加上引号", "quote it"))
    }

    /// Proposes the text at the primary place without its quotes.
    pub(super) fn unquote(self, text: impl Into<String>) -> Self {
        let span = self.primary.span;
        self.fix(span, text, text!("去掉引号", "remove the quotes"))
    }
}
