//! Where generated code is said to stand.

use proc_macro2::Span;
use syn::spanned::Spanned;

/// The place of `tokens`, as code that a macro wrote: errors point there, lints on hand-written code
/// leave it alone.
pub fn span_of(tokens: &impl Spanned) -> Span {
    Span::call_site().located_at(tokens.span())
}
