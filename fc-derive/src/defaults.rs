//! `#[derive(Defaults)]`: the meaning of absent fields.

use crate::attr::{self, Item, Slot};
use crate::errors::Errors;
use crate::new::optional;
use crate::span::span_of;
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use syn::ext::IdentExt as _;
use syn::{Data, DeriveInput, Expr, Fields, Ident, Type};

/// Writes a constant and an accessor for each default, or errors.
pub fn expand(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let mut found = Vec::new();
    if let Data::Struct(data) = &input.data
        && let Fields::Named(fields) = &data.fields
    {
        for field in &fields.named {
            found.extend(Defaulted::read(field, &mut errors));
        }
    } else {
        errors.on(
            &input.ident,
            "`Defaults` is for structs whose fields have names",
        );
    }
    errors.finish(|| code(input, &found), TokenStream::new)
}

/// A field with a default.
struct Defaulted<'a> {
    ident: &'a Ident,
    /// Inner type of its `Option`.
    ty: &'a Type,
    default: Expr,
}

impl<'a> Defaulted<'a> {
    fn read(field: &'a syn::Field, errors: &mut Errors) -> Option<Self> {
        let mut default = Slot::default();
        let mut at = None;
        attr::read(&field.attrs, errors, "a field", &mut |key, input| {
            if key == "default" {
                at = Some(key.span());
                return default.set(key, attr::value::<Expr>(input));
            }
            // `Message` reads all other keys and reports unknown ones.
            Ok(Item::Foreign)
        });
        let ty = optional(&field.ty);
        if let (Some(at), None) = (at, ty) {
            errors.at(
                at,
                "`default` is for an `Option`: it is what its absence means",
            );
        }
        Some(Self {
            ident: field.ident.as_ref()?,
            ty: ty?,
            default: default.into_value()?,
        })
    }

    fn write(&self, vis: &syn::Visibility) -> TokenStream {
        let Self { ident, ty, default } = self;
        let name = ident.unraw().to_string();
        let name = name.trim_end_matches('_');
        let span = span_of(ident);
        let constant = Ident::new(&format!("DEFAULT_{}", name.to_uppercase()), span);
        let accessor = Ident::new(&format!("{name}_or_default"), span);
        let constant_docs = format!("The meaning of an absent `{name}`.");
        let accessor_docs = format!("Returns `{name}`, or its default if it is absent.");
        let (held, borrowed, value) = if is_string(ty) {
            (
                quote_spanned!(span=> &'static ::core::primitive::str),
                quote_spanned!(span=> &::core::primitive::str),
                quote_spanned!(span=> value.as_str()),
            )
        } else {
            (
                quote_spanned!(span=> #ty),
                quote_spanned!(span=> #ty),
                quote_spanned!(span=> ::core::clone::Clone::clone(value)),
            )
        };
        quote_spanned! {span=>
            #[doc = #constant_docs]
            #vis const #constant: #held = #default;

            #[doc = #accessor_docs]
            #[inline]
            #[must_use]
            #vis fn #accessor(&self) -> #borrowed {
                match &self.#ident {
                    ::core::option::Option::Some(value) => #value,
                    ::core::option::Option::None => Self::#constant,
                }
            }
        }
    }
}

fn is_string(ty: &Type) -> bool {
    matches!(ty, Type::Path(path) if path.path.is_ident("String"))
}

fn code(input: &DeriveInput, fields: &[Defaulted<'_>]) -> TokenStream {
    let DeriveInput { ident, vis, .. } = input;
    let (parameters, generics, bounds) = input.generics.split_for_impl();
    let items = fields.iter().map(|field| field.write(vis));
    quote! {
        #[automatically_derived]
        impl #parameters #ident #generics #bounds {
            #(#items)*
        }
    }
}
