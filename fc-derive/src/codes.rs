//! That no two operations of a dispatch have the same code.

use crate::span::moved;
use proc_macro2::{Span, TokenStream};
use quote::quote;
use syn::Path;

/// Refuses, at the span of the later one, two equal codes.
pub fn distinct(
    runtime: &Path,
    codes: &[TokenStream],
    spans: impl Iterator<Item = Span>,
) -> TokenStream {
    let checks = spans.enumerate().map(|(index, span)| {
        moved(
            quote!(const _: () = #runtime::operation::first_of_its_code(CODES, #index);),
            span,
        )
    });
    quote! {
        const _: () = {
            const CODES: &[::core::primitive::u16] = &[#(#codes),*];
            #(#checks)*
        };
    }
}
