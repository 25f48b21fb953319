//! `#[derive(Header)]`.

mod ast;
mod expand;
mod valid;

use crate::faults::Faults;
use ast::Header;
use proc_macro2::TokenStream;
use syn::DeriveInput;

/// Writes `Header`, or errors.
pub fn expand(input: &DeriveInput, mut faults: Faults) -> TokenStream {
    let header = Header::read(input, &mut faults);
    let roles = valid::check(&header, &mut faults);
    faults.finish(
        || {
            roles
                .map(|roles| expand::code(&header, &roles))
                .unwrap_or_default()
        },
        || expand::stub(&header),
    )
}
