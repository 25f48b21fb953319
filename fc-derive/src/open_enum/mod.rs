//! `#[derive(OpenEnum)]`.

mod ast;
mod expand;

use crate::errors::Errors;
use crate::json;
use ast::OpenEnum;
use proc_macro2::TokenStream;
use syn::DeriveInput;

/// Writes the implementations, or errors and stubs.
pub fn expand(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let choice = OpenEnum::read(input, &mut errors);
    choice.check(&mut errors);
    errors.finish(
        || expand::code(&choice),
        || json::stub(choice.ident, &choice.runtime),
    )
}
