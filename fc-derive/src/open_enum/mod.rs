//! `#[derive(OpenEnum)]`.

mod ast;
mod expand;

use crate::faults::Faults;
use ast::OpenEnum;
use proc_macro2::TokenStream;
use syn::DeriveInput;

/// Writes the implementations, or the faults and stubs.
pub fn expand(input: TokenStream) -> TokenStream {
    let input: DeriveInput = match syn::parse2(input) {
        Ok(input) => input,
        Err(error) => return error.into_compile_error(),
    };
    let mut faults = Faults::default();
    let choice = OpenEnum::read(&input, &mut faults);
    choice.check(&mut faults);
    faults.finish(|| expand::code(&choice), || expand::stub(&choice))
}
