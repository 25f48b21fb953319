//! The errors of one macro call, reported together.

use proc_macro2::{Span, TokenStream};
use quote::ToTokens;
use std::fmt::Display;

/// The errors found so far.
#[derive(Default)]
pub struct Errors(Option<syn::Error>);

impl Errors {
    /// Adds an error at the tokens of `place`.
    pub fn on(&mut self, place: &dyn ToTokens, message: impl Display) {
        let place = place.to_token_stream();
        self.push(syn::Error::new_spanned(place, message.to_string()));
    }

    /// Adds an error at a span.
    pub fn at(&mut self, span: Span, message: impl Display) {
        self.push(syn::Error::new(span, message.to_string()));
    }

    /// Adds an error.
    pub fn push(&mut self, error: syn::Error) {
        match &mut self.0 {
            Some(first) => first.combine(error),
            none => *none = Some(error),
        }
    }

    /// Returns the value of a result, or adds its error.
    pub fn ok<T>(&mut self, result: syn::Result<T>) -> Option<T> {
        result.map_err(|error| self.push(error)).ok()
    }

    /// Returns all errors as one.
    pub fn into_result(self) -> syn::Result<()> {
        self.0.map_or(Ok(()), Err)
    }

    /// Returns `code` without errors. Otherwise returns `compile_error!`s and `stub`, which prevents further errors
    /// about missing implementations.
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
