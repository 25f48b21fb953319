//! The check that all operations of a dispatch have different codes.

use crate::span::moved;
use proc_macro2::{Span, TokenStream};
use quote::quote;
use syn::Path;

/// Reports a repeated code at the span of its later occurrence.
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
