//! `#[derive(Dispatch)]`: an enum of reports, distinguished by code.

use crate::attr::{self, Item, Slot};
use crate::codes::distinct;
use crate::errors::Errors;
use crate::item;
use crate::span::span_of;
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use syn::{DeriveInput, Ident, Path, Type, Variant};

/// Writes `from_raw`, or errors.
pub fn expand(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let mut protocol = Slot::default();
    let item = "an enum of reports";
    let runtime = item::read_attributes(input, &mut errors, item, &mut |key, input| {
        if key == "protocol" {
            protocol.set(key, attr::path(input))
        } else {
            Ok(Item::Unknown)
        }
    });
    let message = "`protocol` is missing: `#[fc(protocol = Fc)]`";
    protocol.required(&mut errors, &input.ident, message);
    let mut reports = Reports::default();
    let message = "`Dispatch` is for enums of reports";
    if let Some(variants) = item::variants(input, &mut errors, message, "") {
        for variant in variants {
            reports.add(variant, &mut errors);
        }
        if reports.unknown.is_none() {
            errors.on(
                &input.ident,
                "one variant must hold what no other does: `#[fc(unknown)] Unknown(RawReport)`",
            );
        }
    }
    errors.finish(
        || code(&input.ident, &runtime, protocol.get(), &reports),
        TokenStream::new,
    )
}

#[derive(Default)]
struct Reports<'a> {
    typed: Vec<(&'a Ident, &'a Type)>,
    unknown: Option<(&'a Ident, &'a Type)>,
}

impl<'a> Reports<'a> {
    fn add(&mut self, variant: &'a Variant, errors: &mut Errors) {
        let mut unknown = Slot::default();
        attr::read(
            &variant.attrs,
            errors,
            "a report's variant",
            &mut |key, _| {
                if key == "unknown" {
                    unknown.set(key, Ok(()))
                } else {
                    Ok(Item::Unknown)
                }
            },
        );
        let message = "each variant holds one report";
        let Some(payload) = item::variant_payload(variant, errors, message) else {
            return;
        };
        let report = (&variant.ident, payload);
        match (unknown.key(), self.unknown) {
            (None, _) => self.typed.push(report),
            (Some(_), None) => self.unknown = Some(report),
            (Some(key), Some(_)) => errors.at(key, "`unknown` is given twice"),
        }
    }
}

fn code(
    ident: &Ident,
    runtime: &Path,
    protocol: Option<&Path>,
    reports: &Reports<'_>,
) -> TokenStream {
    let Some((unknown, raw)) = reports.unknown else {
        return TokenStream::new();
    };
    let names = reports.typed.iter().map(|(name, _)| name);
    let types: Vec<_> = reports.typed.iter().map(|(_, ty)| ty).collect();
    let codes: Vec<_> = types
        .iter()
        .map(|ty| quote_spanned!(span_of(ty)=> <#ty as #runtime::Report>::CODE))
        .collect();
    let distinct = distinct(runtime, &codes, types.iter().map(span_of));
    quote! {
        #distinct

        #[automatically_derived]
        impl #ident {
            /// Reads a report as the type of its code.
            ///
            /// # Errors
            /// The error of the report's text or of a key of that type.
            pub fn from_raw(
                raw: #raw,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                match raw.code {
                    #(#codes => raw.read::<#protocol, #types>().map(Self::#names),)*
                    _ => ::core::result::Result::Ok(Self::#unknown(raw)),
                }
            }
        }
    }
}
