//! `#[derive(RedactedDebug)]`.

use crate::attr;
use crate::errors::Errors;
use crate::item;
use proc_macro2::TokenStream;
use quote::quote;
use syn::ext::IdentExt as _;
use syn::{DeriveInput, Field, Ident};

/// Writes `Debug`, or errors and a stub.
pub fn expand(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let fields: Vec<_> = item::named_fields(input, &mut errors, "RedactedDebug")
        .into_iter()
        .filter_map(|field| read(field, &mut errors))
        .collect();
    errors.finish(|| code(input, &fields), || code(input, &[]))
}

/// Reads a field. The bool is `true` for a sensitive one.
fn read<'a>(field: &'a Field, errors: &mut Errors) -> Option<(&'a Ident, bool)> {
    let sensitive = attr::read_own(&field.attrs, errors, "sensitive", |_| Ok(()));
    Some((field.ident.as_ref()?, sensitive.get().is_some()))
}

fn code(input: &DeriveInput, fields: &[(&Ident, bool)]) -> TokenStream {
    let ident = &input.ident;
    let name = ident.unraw().to_string();
    let (parameters, arguments, bounds) = input.generics.split_for_impl();
    let fields = fields.iter().map(|(field, sensitive)| {
        let name = field.unraw().to_string();
        if *sensitive {
            quote!(.field(#name, &::core::format_args!("<redacted>")))
        } else {
            quote!(.field(#name, &self.#field))
        }
    });
    quote! {
        #[automatically_derived]
        impl #parameters ::core::fmt::Debug for #ident #arguments #bounds {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                f.debug_struct(#name) #(#fields)* .finish()
            }
        }
    }
}
