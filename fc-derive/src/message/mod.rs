//! `#[derive(Message)]`.

mod ast;
mod condition;
mod constraint;
mod expand;
mod fallback;
mod valid;

use crate::errors::Errors;
use ast::Message;
use proc_macro2::TokenStream;
use syn::DeriveInput;

/// Writes the implementations, or errors and stubs.
pub fn expand(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let message = Message::read(input, &mut errors);
    valid::check(&message, &mut errors);
    errors.finish(|| expand::code(&message), || fallback::stub(&message))
}
