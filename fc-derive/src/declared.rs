//! `#[derive(DeclaredError)]`: the errors that a command declares.

use crate::attr::{self, Item, NumberValue, Slot};
use crate::errors::Errors;
use crate::item;
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use std::collections::HashSet;
use syn::parse::ParseStream;
use syn::{Data, DeriveInput, Fields, Ident, Path, Token, Variant};

/// Writes the implementation, or errors and a stub.
pub fn expand(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let item = "an enum of errors";
    let runtime = item::read_attributes(input, &mut errors, item, &mut |_, _| Ok(Item::Unknown));
    let declared = match &input.data {
        Data::Enum(data) => {
            if data.variants.is_empty() {
                errors.on(&input.ident, "there is at least one error");
            }
            let variants = data.variants.iter();
            let declared = variants.filter_map(|variant| Declared::read(variant, &mut errors));
            declared.collect()
        }
        Data::Struct(_) | Data::Union(_) => {
            errors.on(&input.ident, "`DeclaredError` is for enums");
            Vec::new()
        }
    };
    let mut codes = HashSet::new();
    for error in declared.iter().filter(|error| !codes.insert(error.code)) {
        let message = format!("{} is the code of another variant, too", error.code);
        errors.on(error.ident, message);
    }
    errors.finish(
        || code(&input.ident, &runtime, &declared),
        || stub(&input.ident, &runtime),
    )
}

/// A variant and its result.
struct Declared<'a> {
    ident: &'a Ident,
    code: i64,
    text: String,
}

impl<'a> Declared<'a> {
    fn read(variant: &'a Variant, errors: &mut Errors) -> Option<Self> {
        let mut code = Slot::default();
        let mut text = Slot::default();
        attr::read(
            &variant.attrs,
            errors,
            "an error",
            &mut |key, input| match key.to_string().as_str() {
                "code" => code.set(key, result_code(input)),
                "text" => text.set(key, attr::text(input)),
                _ => Ok(Item::Unknown),
            },
        );
        if !matches!(variant.fields, Fields::Unit) {
            errors.on(&variant.fields, "an error holds nothing");
        }
        let ident = &variant.ident;
        let code = code.required(errors, ident, "`code` is missing: `#[fc(code = 41)]`");
        let text = text.required(errors, ident, "`text` is missing: `#[fc(text = \"…\")]`");
        Some(Self {
            ident,
            code: *code?,
            text: text?.value(),
        })
    }
}

/// Reads `= -2`.
fn result_code(input: ParseStream<'_>) -> syn::Result<i64> {
    let place = input.fork();
    place.parse::<Token![=]>()?;
    let code = match attr::number(input)?.value {
        NumberValue::Int(code) => i64::try_from(code).ok(),
        NumberValue::Float(_) => None,
    };
    code.ok_or_else(|| place.error("a result code is an integer of 64 bits"))
}

fn code(ident: &Ident, runtime: &Path, declared: &[Declared<'_>]) -> TokenStream {
    let names: Vec<_> = declared.iter().map(|error| error.ident).collect();
    let codes = declared.iter().map(|it| Literal::i64_unsuffixed(it.code));
    let texts = declared.iter().map(|it| &it.text);
    quote! {
        #[automatically_derived]
        impl #runtime::DeclaredError for #ident {
            const ALL: &'static [Self] = &[#(Self::#names),*];

            fn result(self) -> #runtime::ResultText {
                match self {
                    #(Self::#names => #runtime::ResultText { code: #codes, text: #texts },)*
                }
            }
        }
    }
}

/// Returns an implementation that does nothing, for an enum with errors.
fn stub(ident: &Ident, runtime: &Path) -> TokenStream {
    quote! {
        #[automatically_derived]
        impl #runtime::DeclaredError for #ident {
            const ALL: &'static [Self] = &[];

            fn result(self) -> #runtime::ResultText {
                ::core::unimplemented!()
            }
        }
    }
}
