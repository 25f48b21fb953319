//! `#[derive(OneOf)]`.

use crate::attr::{self, Item};
use crate::errors::Errors;
use crate::item;
use crate::json::{self, Bodies};
use crate::span::span_of;
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens as _, quote, quote_spanned};
use syn::{DeriveInput, Ident, Path, Type, Variant};

/// Writes the implementations, or errors and stubs.
pub fn expand(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let item = "a choice of messages";
    let runtime = item::read_attributes(input, &mut errors, item, &mut |_, _| Ok(Item::Unknown));
    item::forbid_parameters(&input.generics, &mut errors, item);
    let variants = read_variants(input, &mut errors);
    errors.finish(
        || code(&input.ident, &runtime, &variants),
        || json::stub(&input.ident, &runtime),
    )
}

/// Returns the variants and their messages.
fn read_variants<'a>(input: &'a DeriveInput, errors: &mut Errors) -> Vec<(&'a Ident, &'a Type)> {
    let hint = "; a struct is a `Message`";
    let Some(variants) = item::variants(input, errors, "`OneOf` is for enums", hint) else {
        return Vec::new();
    };
    if variants.is_empty() {
        errors.on(&input.ident, "a choice has at least one variant");
    }
    variants
        .iter()
        .filter_map(|variant| read_variant(variant, errors))
        .collect()
}

fn read_variant<'a>(variant: &'a Variant, errors: &mut Errors) -> Option<(&'a Ident, &'a Type)> {
    attr::read(&variant.attrs, errors, "a choice's variant", &mut |_, _| {
        Ok(Item::Unknown)
    });
    let message = "each variant holds one message";
    let payload = item::variant_payload(variant, errors, message)?;
    Some((&variant.ident, payload))
}

fn code(ident: &Ident, runtime: &Path, variants: &[(&Ident, &Type)]) -> TokenStream {
    let lacking = variants
        .iter()
        .map(|(_, ty)| quote_spanned!(span_of(ty)=> #runtime::json::lacking::<#ty>));
    let last = variants.len().saturating_sub(1);
    let reads = variants.iter().enumerate().map(|(index, (name, ty))| {
        let pattern = if index == last {
            quote!(_)
        } else {
            Literal::usize_unsuffixed(index).into_token_stream()
        };
        quote! {
            #pattern => <#ty as #runtime::json::FromJson>::read(reader).map(Self::#name),
        }
    });
    let (names, types): (Vec<_>, Vec<_>) = variants.iter().copied().unzip();
    let bodies = Bodies {
        read: quote! {
            match reader.choose(&[#(#lacking),*])? {
                #(#reads)*
            }
        },
        write: quote! {
            match self {
                #(Self::#names(message) => <#types as #runtime::json::ToJson>::write(message, writer),)*
            }
        },
        check_value: Some(quote! {
            match self {
                #(Self::#names(message) => #runtime::json::ToJson::check_value(message),)*
            }
        }),
    };
    json::implement(ident, runtime, &bodies)
}
