//! Positions of generated code.

use proc_macro2::{Span, TokenStream};
use quote::ToTokens;
use syn::spanned::Spanned;

/// Returns the position of `tokens` for generated code: errors point there, and lints for handwritten code do not
/// apply.
pub fn span_of(tokens: &impl Spanned) -> Span {
    Span::call_site().located_at(tokens.span())
}

/// Returns `tokens` as generated code, each at its position.
pub fn generated(tokens: impl ToTokens) -> TokenStream {
    respanned(tokens.into_token_stream(), &|span| {
        Span::call_site().located_at(span)
    })
}

/// Returns `tokens` with all positions set to `span`.
pub fn moved(tokens: impl ToTokens, span: Span) -> TokenStream {
    respanned(tokens.into_token_stream(), &|_| span)
}

fn respanned(tokens: TokenStream, place: &dyn Fn(Span) -> Span) -> TokenStream {
    let respan = |mut token: proc_macro2::TokenTree| {
        token.set_span(place(token.span()));
        token
    };
    tokens.into_iter().map(respan).collect()
}
