//! `#[derive(Header)]`.

mod ast;
mod expand;
mod valid;

use crate::errors::Errors;
use ast::Header;
use proc_macro2::TokenStream;
use syn::DeriveInput;

/// Writes `Header`, or errors.
pub fn expand(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let header = Header::read(input, &mut errors);
    let roles = valid::check(&header, &mut errors);
    errors.finish(
        || {
            roles
                .map(|roles| expand::code(&header, &roles))
                .unwrap_or_default()
        },
        || expand::stub(&header),
    )
}
