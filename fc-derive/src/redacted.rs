//! `#[derive(RedactedDebug)]`.

use crate::attr::{self, Item, Slot};
use crate::faults::Faults;
use proc_macro2::TokenStream;
use quote::quote;
use syn::ext::IdentExt as _;
use syn::{Data, DeriveInput, Field, Fields, Ident};

/// Writes `Debug`, or the faults and a stub.
pub fn expand(input: TokenStream) -> TokenStream {
    let input: DeriveInput = match syn::parse2(input) {
        Ok(input) => input,
        Err(error) => return error.into_compile_error(),
    };
    let mut faults = Faults::default();
    let mut fields = Vec::new();
    match &input.data {
        Data::Struct(data) => match &data.fields {
            Fields::Named(named) => {
                fields.extend(
                    named
                        .named
                        .iter()
                        .filter_map(|field| read(field, &mut faults)),
                );
            }
            Fields::Unit => {}
            Fields::Unnamed(unnamed) => {
                faults.on(
                    unnamed,
                    "`RedactedDebug` is for structs whose fields have names",
                );
            }
        },
        Data::Enum(data) => faults.on(&data.enum_token, "`RedactedDebug` is for structs"),
        Data::Union(data) => faults.on(&data.union_token, "`RedactedDebug` is for structs"),
    }
    faults.finish(|| code(&input, &fields), || code(&input, &[]))
}

/// A field and whether it is sensitive.
fn read<'a>(field: &'a Field, faults: &mut Faults) -> Option<(&'a Ident, bool)> {
    let mut sensitive = Slot::default();
    attr::read(&field.attrs, faults, "a field", &mut |key, _| {
        if key == "sensitive" {
            return sensitive.set(key, Ok(()));
        }
        // `Message` reads the rest, and refuses what nobody reads.
        Ok(Item::Foreign)
    });
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
