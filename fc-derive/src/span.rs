//! Where generated code is said to stand.

use proc_macro2::{Span, TokenStream};
use quote::ToTokens;
use syn::spanned::Spanned;

/// The place of `tokens`, as code that a macro wrote: errors point there, lints on hand-written code
/// leave it alone.
pub fn span_of(tokens: &impl Spanned) -> Span {
    Span::call_site().located_at(tokens.span())
}

/// `tokens` as code that a macro wrote, each in its place.
pub fn generated(tokens: impl ToTokens) -> TokenStream {
    respanned(tokens.into_token_stream(), &|span| {
        Span::call_site().located_at(span)
    })
}

/// `tokens` as if they all stood at `span`.
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
