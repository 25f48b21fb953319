//! `#[derive(OpenEnum)]`.

mod ast;
mod expand;

use crate::faults::Faults;
use crate::json;
use ast::OpenEnum;
use proc_macro2::TokenStream;
use syn::DeriveInput;

/// Writes the implementations, or errors and stubs.
pub fn expand(input: &DeriveInput, mut faults: Faults) -> TokenStream {
    let choice = OpenEnum::read(input, &mut faults);
    choice.check(&mut faults);
    faults.finish(
        || expand::code(&choice),
        || json::stub(choice.ident, &choice.runtime),
    )
}
