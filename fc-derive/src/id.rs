//! `#[derive(Id)]`: an id with its own type, sent as its inner value.

use crate::attr::Item;
use crate::errors::Errors;
use crate::item;
use crate::span::span_of;
use proc_macro2::TokenStream;
use quote::quote_spanned;
use syn::{Data, DeriveInput, Ident, Path, Type};

/// Inner types of an id besides `String`.
const INTEGERS: [&str; 8] = ["i8", "i16", "i32", "i64", "u8", "u16", "u32", "u64"];

/// Writes the implementations, or errors.
pub fn expand(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let runtime = item::read_attributes(input, &mut errors, "an id", &mut |_, _| Ok(Item::Unknown));
    let held = held(input, &mut errors);
    errors.finish(
        || held.map_or_else(TokenStream::new, |held| code(&input.ident, &runtime, &held)),
        TokenStream::new,
    )
}

/// The inner type of an id.
enum Held<'a> {
    Integer(&'a Type),
    Text(&'a Type),
}

/// Returns the inner type, or reports an invalid one.
fn held<'a>(input: &'a DeriveInput, errors: &mut Errors) -> Option<Held<'a>> {
    const WANTED: &str =
        "an id is a struct of one integer or `String`, such as `struct StationId(pub i64)`";
    if !input.generics.params.is_empty() {
        errors.on(&input.generics, "an id has no parameters");
        return None;
    }
    let payload = match &input.data {
        Data::Struct(data) => item::payload(&data.fields),
        Data::Enum(_) | Data::Union(_) => None,
    };
    let Some(ty) = payload else {
        errors.on(&input.ident, WANTED);
        return None;
    };
    match item::last_name(ty) {
        Some(name) if INTEGERS.iter().any(|integer| name == integer) => Some(Held::Integer(ty)),
        Some(name) if name == "String" => Some(Held::Text(ty)),
        _ => {
            errors.on(ty, WANTED);
            None
        }
    }
}

fn code(ident: &Ident, runtime: &Path, held: &Held<'_>) -> TokenStream {
    let (ty, own) = match held {
        Held::Integer(ty) => (ty, of_integer(ident, runtime, ty)),
        Held::Text(ty) => (ty, of_text(ident, runtime, ty)),
    };
    let span = span_of(ty);
    let all = quote_spanned! {span=>
        #[automatically_derived]
        impl #runtime::json::FromJson for #ident {
            #[inline]
            fn read(
                reader: &mut #runtime::json::Reader<'_>,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                <#ty as #runtime::json::FromJson>::read(reader).map(Self)
            }
        }
        #[automatically_derived]
        impl #runtime::json::ToJson for #ident {
            #[inline]
            fn write(&self, writer: &mut #runtime::json::Writer<'_>) {
                #runtime::json::ToJson::write(&self.0, writer);
            }
        }
        #[automatically_derived]
        impl ::core::fmt::Display for #ident {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                ::core::fmt::Display::fmt(&self.0, f)
            }
        }
        #[automatically_derived]
        impl ::core::convert::From<#ty> for #ident {
            #[inline]
            fn from(id: #ty) -> Self {
                Self(id)
            }
        }
        #[automatically_derived]
        impl ::core::convert::From<#ident> for #ty {
            #[inline]
            fn from(id: #ident) -> Self {
                id.0
            }
        }
    };
    all.into_iter().chain(own).collect()
}

/// Returns the wire forms and constraints of an integer.
fn of_integer(ident: &Ident, runtime: &Path, ty: &Type) -> TokenStream {
    quote_spanned! {span_of(ty)=>
        #[automatically_derived]
        impl #runtime::json::Quotable for #ident {
            fn read_quoted(
                reader: &mut #runtime::json::Reader<'_>,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                <#ty as #runtime::json::Quotable>::read_quoted(reader).map(Self)
            }
            fn write_quoted(&self, writer: &mut #runtime::json::Writer<'_>) {
                #runtime::json::Quotable::write_quoted(&self.0, writer);
            }
        }
        #[automatically_derived]
        impl #runtime::json::ReadLenientNumber for #ident {
            fn read_lenient(
                reader: &mut #runtime::json::Reader<'_>,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                <#ty as #runtime::json::ReadLenientNumber>::read_lenient(reader).map(Self)
            }
        }
        #[automatically_derived]
        impl #runtime::json::Bounded for #ident {
            #[inline]
            fn all_within(
                &self,
                limit: #runtime::json::Limit,
                wanted: ::core::cmp::Ordering,
            ) -> ::core::primitive::bool {
                #runtime::json::Bounded::all_within(&self.0, limit, wanted)
            }
        }
    }
}

/// Returns the constraints and conversions of a string.
fn of_text(ident: &Ident, runtime: &Path, ty: &Type) -> TokenStream {
    quote_spanned! {span_of(ty)=>
        #[automatically_derived]
        impl #runtime::json::Measured for #ident {
            fn measure(&self) -> ::core::option::Option<::core::primitive::usize> {
                #runtime::json::Measured::measure(&self.0)
            }
        }
        #[automatically_derived]
        impl #runtime::json::Patterned for #ident {
            fn all_match(
                &self,
                matches: &dyn ::core::ops::Fn(&::core::primitive::str) -> ::core::primitive::bool,
            ) -> ::core::primitive::bool {
                #runtime::json::Patterned::all_match(&self.0, matches)
            }
        }
        #[automatically_derived]
        impl ::core::convert::From<&::core::primitive::str> for #ident {
            fn from(id: &::core::primitive::str) -> Self {
                Self(::core::convert::From::from(id))
            }
        }
        #[automatically_derived]
        impl ::core::convert::AsRef<::core::primitive::str> for #ident {
            fn as_ref(&self) -> &::core::primitive::str {
                &self.0
            }
        }
    }
}
