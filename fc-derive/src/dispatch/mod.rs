//! `#[dispatch]`: makes a trait of methods, one per command, into a service.

mod ast;
mod declaration;
mod expand;
mod partial;
mod valid;

use crate::errors::Errors;
use ast::{Options, Service};
use proc_macro2::TokenStream;

/// Writes the trait and its service, or errors and the trait.
pub fn expand(attribute: TokenStream, item: TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    let options = Options::read(attribute, &mut errors);
    let service = match syn::parse2::<Service>(item.clone()) {
        Ok(service) => service,
        Err(error) => {
            errors.push(error);
            return errors.finish(TokenStream::new, || ast::without_attributes(item));
        }
    };
    valid::check(&service, &mut errors);
    let Some(roles) = valid::roles(&service, &mut errors) else {
        return errors.finish(TokenStream::new, || declaration::declaration(&service));
    };
    errors.finish(
        || expand::code(&options, &service, &roles),
        || declaration::declaration(&service),
    )
}
