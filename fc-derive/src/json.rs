//! `FromJson` and `ToJson` of an enum.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Ident, Path};

/// The bodies of the methods.
pub struct Bodies {
    /// Returns the value that `reader` reads.
    pub read: TokenStream,
    /// Writes `self` with `writer`.
    pub write: TokenStream,
    /// Checks the messages inside, if there are any.
    pub check_value: Option<TokenStream>,
}

/// Implements both traits.
pub fn implement(ident: &Ident, runtime: &Path, bodies: &Bodies) -> TokenStream {
    let Bodies {
        read,
        write,
        check_value,
    } = bodies;
    let check_value = check_value.as_ref().map(|check| {
        quote! {
            fn check_value(&self) -> ::core::result::Result<(), #runtime::json::BodyError> {
                #check
            }
        }
    });
    quote! {
        #[automatically_derived]
        impl #runtime::json::FromJson for #ident {
            fn read(
                reader: &mut #runtime::json::Reader<'_>,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                #read
            }
        }

        #[automatically_derived]
        impl #runtime::json::ToJson for #ident {
            fn write(&self, writer: &mut #runtime::json::Writer<'_>) {
                #write
            }

            #check_value
        }
    }
}

/// Implements both traits for an item with errors. The methods do nothing.
pub fn stub(ident: &Ident, runtime: &Path) -> TokenStream {
    let bodies = Bodies {
        read: quote! {
            let _ = reader;
            ::core::unimplemented!()
        },
        write: quote! {
            let _ = writer;
            ::core::unimplemented!()
        },
        check_value: None,
    };
    implement(ident, runtime, &bodies)
}
