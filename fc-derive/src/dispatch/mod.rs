//! `#[dispatch]`: makes a trait of methods, one per command, into a service.

mod ast;
mod declaration;
mod expand;
mod partial;
mod valid;

use crate::faults::Faults;
use ast::{Options, Service};
use proc_macro2::TokenStream;

/// Writes the trait and its service, or errors and the trait.
pub fn expand(attribute: TokenStream, item: TokenStream) -> TokenStream {
    let mut faults = Faults::default();
    let options = Options::read(attribute, &mut faults);
    let service = match syn::parse2::<Service>(item.clone()) {
        Ok(service) => service,
        Err(error) => {
            faults.push(error);
            return faults.finish(TokenStream::new, || ast::without_attributes(item));
        }
    };
    valid::check(&service, &mut faults);
    let Some(roles) = valid::roles(&service, &mut faults) else {
        return faults.finish(TokenStream::new, || declaration::declaration(&service));
    };
    faults.finish(
        || expand::code(&options, &service, &roles),
        || declaration::declaration(&service),
    )
}
