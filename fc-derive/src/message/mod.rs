//! `#[derive(Message)]`.

mod ast;
mod condition;
mod expand;
mod fallback;
mod valid;

use crate::faults::Faults;
use ast::Message;
use proc_macro2::TokenStream;
use syn::DeriveInput;

/// Writes the implementations, or errors and stubs.
pub fn expand(input: &DeriveInput, mut faults: Faults) -> TokenStream {
    let message = Message::read(input, &mut faults);
    valid::check(&message, &mut faults);
    faults.finish(|| expand::code(&message), || fallback::stub(&message))
}
