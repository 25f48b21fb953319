//! `#[derive(New)]`: constructors of messages that may get further fields.

use crate::attr;
use crate::errors::Errors;
use crate::item;
use crate::span::span_of;
use proc_macro2::TokenStream;
use quote::{format_ident, quote, quote_spanned};
use syn::ext::IdentExt as _;
use syn::{DeriveInput, GenericArgument, Ident, PathArguments, Type};

/// Writes `new`, the setters and, for two or more required fields, a struct with these fields; or errors.
pub fn expand(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let fields: Vec<_> = item::named_fields(input, &mut errors, "New")
        .into_iter()
        .filter_map(|field| Field::read(field, &mut errors))
        .collect();
    errors.finish(|| code(input, &fields), TokenStream::new)
}

/// A field and the source of its value.
struct Field<'a> {
    of: &'a syn::Field,
    ident: &'a Ident,
    value: Value<'a>,
}

enum Value<'a> {
    /// A parameter of `new`.
    Required(&'a Type),
    /// A setter; absent by default.
    Optional(&'a Type),
    /// Empty.
    Extra,
}

impl<'a> Field<'a> {
    fn read(field: &'a syn::Field, errors: &mut Errors) -> Option<Self> {
        let extra = attr::read_own(&field.attrs, errors, "extra", |_| Ok(()));
        let value = match (extra.get(), optional(&field.ty)) {
            (Some(()), _) => Value::Extra,
            (None, Some(inner)) => Value::Optional(inner),
            (None, None) => Value::Required(&field.ty),
        };
        let ident = field.ident.as_ref()?;
        Some(Self {
            of: field,
            ident,
            value,
        })
    }
}

/// Returns the inner type of an `Option`.
pub fn optional(ty: &Type) -> Option<&Type> {
    let Type::Path(path) = ty else { return None };
    let last = path.path.segments.last()?;
    let PathArguments::AngleBracketed(arguments) = &last.arguments else {
        return None;
    };
    match arguments.args.first()? {
        GenericArgument::Type(inner) if last.ident == "Option" => Some(inner),
        _ => None,
    }
}

/// Returns the parameter type and the conversion of a value. A string may be passed as `&str`.
fn taken(ty: &Type, name: &Ident) -> (TokenStream, TokenStream) {
    match ty {
        Type::Path(path) if path.path.is_ident("String") => (
            quote!(impl ::core::convert::Into<#ty>),
            quote!(::core::convert::Into::into(#name)),
        ),
        _ => (quote!(#ty), quote!(#name)),
    }
}

fn code(input: &DeriveInput, fields: &[Field<'_>]) -> TokenStream {
    let DeriveInput { ident, vis, .. } = input;
    let (parameters, generics, bounds) = input.generics.split_for_impl();
    let (companion, given) = required(input, fields);
    let mut values = Vec::new();
    let mut setters = Vec::new();
    for Field {
        ident: name, value, ..
    } in fields
    {
        let value = match value {
            Value::Required(ty) => match &companion {
                Some(_) => quote!(required.#name),
                None => taken(ty, name).1,
            },
            Value::Optional(ty) => {
                let (ty, value) = taken(ty, name);
                let plain = name.unraw();
                let setter = Ident::new(&format!("with_{plain}"), span_of(name));
                let docs = format!("Sets `{plain}`, which may be absent.");
                setters.push(quote_spanned! {span_of(name)=>
                    #[doc = #docs]
                    #[inline]
                    #[must_use]
                    #vis fn #setter(mut self, #name: #ty) -> Self {
                        self.#name = ::core::option::Option::Some(#value);
                        self
                    }
                });
                quote!(::core::option::Option::None)
            }
            Value::Extra => quote!(::core::default::Default::default()),
        };
        values.push(quote!(#name: #value));
    }
    quote! {
        #companion

        #[automatically_derived]
        impl #parameters #ident #generics #bounds {
            /// Takes the required fields; optional fields are absent.
            #[inline]
            #[must_use]
            #vis fn new(#given) -> Self {
                Self { #(#values),* }
            }

            #(#setters)*
        }
    }
}

/// Returns the struct with the required fields, if there are several, and the parameter of `new`. Without the struct,
/// neighbouring values of one type could be swapped by mistake.
fn required(input: &DeriveInput, fields: &[Field<'_>]) -> (Option<TokenStream>, TokenStream) {
    let DeriveInput { ident, vis, .. } = input;
    let required: Vec<_> = fields
        .iter()
        .filter_map(|field| match field.value {
            Value::Required(ty) => Some((field, ty)),
            Value::Optional(_) | Value::Extra => None,
        })
        .collect();
    match required.as_slice() {
        [] => (None, TokenStream::new()),
        [(field, ty)] => {
            let (name, (ty, _)) = (field.ident, taken(ty, field.ident));
            (None, quote!(#name: #ty))
        }
        several => {
            let name = format_ident!("{}Fields", ident.unraw(), span = span_of(ident));
            let docs = format!("The required fields of [`{ident}`], by name.");
            let fields = several.iter().map(|(Field { of, ident, .. }, ty)| {
                let docs = of.attrs.iter().filter(|it| it.path().is_ident("doc"));
                let vis = &of.vis;
                quote!(#(#docs)* #vis #ident: #ty)
            });
            let (generics, bounds) = (&input.generics, &input.generics.where_clause);
            let (_, arguments, _) = input.generics.split_for_impl();
            let companion = quote! {
                #[doc = #docs]
                #[allow(missing_debug_implementations)]
                #vis struct #name #generics #bounds {
                    #(#fields),*
                }
            };
            (Some(companion), quote!(required: #name #arguments))
        }
    }
}
