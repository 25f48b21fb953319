//! `#[derive(OneOf)]`.

use crate::attr::{self, Item, Slot};
use crate::faults::Faults;
use crate::span::span_of;
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens as _, quote, quote_spanned};
use syn::{Data, DeriveInput, Fields, Ident, Path, Type, Variant};

/// Writes the implementations, or the faults and stubs.
pub fn expand(input: TokenStream) -> TokenStream {
    let input: DeriveInput = match syn::parse2(input) {
        Ok(input) => input,
        Err(error) => return error.into_compile_error(),
    };
    let mut faults = Faults::default();
    let mut runtime = Slot::default();
    attr::read(
        &input.attrs,
        &mut faults,
        "a choice of messages",
        &mut |key, input| match key.to_string().as_str() {
            "crate" => runtime.set(key, attr::path(input)),
            _ => Ok(Item::Unknown),
        },
    );
    let runtime = attr::runtime(runtime);
    if !input.generics.params.is_empty() {
        faults.on(
            &input.generics.params,
            "a choice of messages has no parameters",
        );
    }
    let variants = read_variants(&input, &mut faults);
    faults.finish(
        || code(&input.ident, &runtime, &variants),
        || stub(&input.ident, &runtime),
    )
}

/// The variants and their messages.
fn read_variants<'a>(input: &'a DeriveInput, faults: &mut Faults) -> Vec<(&'a Ident, &'a Type)> {
    match &input.data {
        Data::Enum(data) => {
            if data.variants.is_empty() {
                faults.on(&input.ident, "a choice has at least one variant");
            }
            let variants = data.variants.iter();
            variants
                .filter_map(|variant| read_variant(variant, faults))
                .collect()
        }
        Data::Struct(data) => {
            faults.on(
                &data.struct_token,
                "`OneOf` is for enums; a struct is a `Message`",
            );
            Vec::new()
        }
        Data::Union(data) => {
            faults.on(&data.union_token, "`OneOf` is for enums");
            Vec::new()
        }
    }
}

fn read_variant<'a>(variant: &'a Variant, faults: &mut Faults) -> Option<(&'a Ident, &'a Type)> {
    attr::read(&variant.attrs, faults, "a choice's variant", &mut |_, _| {
        Ok(Item::Unknown)
    });
    if let Fields::Unnamed(fields) = &variant.fields
        && let (1, Some(field)) = (fields.unnamed.len(), fields.unnamed.first())
    {
        return Some((&variant.ident, &field.ty));
    }
    let place = match &variant.fields {
        Fields::Unit => variant.ident.to_token_stream(),
        fields => fields.to_token_stream(),
    };
    faults.on(&place, "each variant holds one message");
    None
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
    quote! {
        #[automatically_derived]
        impl #runtime::json::FromJson for #ident {
            fn read(
                reader: &mut #runtime::json::Reader<'_>,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                match reader.choose(&[#(#lacking),*])? {
                    #(#reads)*
                }
            }
        }

        #[automatically_derived]
        impl #runtime::json::ToJson for #ident {
            fn write(&self, writer: &mut #runtime::json::Writer<'_>) {
                match self {
                    #(Self::#names(message) => <#types as #runtime::json::ToJson>::write(message, writer),)*
                }
            }

            fn check_value(&self) -> ::core::result::Result<(), #runtime::json::BodyError> {
                match self {
                    #(Self::#names(message) => #runtime::json::ToJson::check_value(message),)*
                }
            }
        }
    }
}

/// Implementations that do nothing, for a choice with faults.
fn stub(ident: &Ident, runtime: &Path) -> TokenStream {
    quote! {
        #[automatically_derived]
        impl #runtime::json::FromJson for #ident {
            fn read(
                _: &mut #runtime::json::Reader<'_>,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                ::core::unimplemented!()
            }
        }

        #[automatically_derived]
        impl #runtime::json::ToJson for #ident {
            fn write(&self, _: &mut #runtime::json::Writer<'_>) {
                ::core::unimplemented!()
            }
        }
    }
}
