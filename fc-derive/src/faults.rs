//! All faults of one macro call, reported together.

use proc_macro2::{Span, TokenStream};
use quote::ToTokens;
use std::fmt::Display;

/// Faults found so far.
#[derive(Default)]
pub struct Faults(Option<syn::Error>);

impl Faults {
    /// Adds a fault on the tokens of `place`.
    pub fn on(&mut self, place: &dyn ToTokens, message: impl Display) {
        let place = place.to_token_stream();
        self.push(syn::Error::new_spanned(place, message.to_string()));
    }

    /// Adds a fault at a span.
    pub fn at(&mut self, span: Span, message: impl Display) {
        self.push(syn::Error::new(span, message.to_string()));
    }

    /// Adds a fault.
    pub fn push(&mut self, error: syn::Error) {
        match &mut self.0 {
            Some(first) => first.combine(error),
            none => *none = Some(error),
        }
    }

    /// Gives the value of a result, or keeps its fault.
    pub fn ok<T>(&mut self, result: syn::Result<T>) -> Option<T> {
        result.map_err(|error| self.push(error)).ok()
    }

    /// The faults as one error.
    pub fn into_result(self) -> syn::Result<()> {
        self.0.map_or(Ok(()), Err)
    }

    /// The faults as `compile_error!`s in front of `stub`, which keeps the compiler from reporting
    /// what is missing because of them; `code` if there are none.
    pub fn finish(
        self,
        code: impl FnOnce() -> TokenStream,
        stub: impl FnOnce() -> TokenStream,
    ) -> TokenStream {
        match self.0 {
            None => code(),
            Some(error) => {
                let mut tokens = error.into_compile_error();
                tokens.extend(stub());
                tokens
            }
        }
    }
}
