//! The code of a header.

use super::ast::{Algorithm, ByteOrder, Field, Header, Role, Shape};
use super::valid::Roles;
use crate::span::generated;
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;

/// Returns the implementation of `Header`.
pub fn code(header: &Header<'_>, roles: &Roles<'_>) -> TokenStream {
    let Header { ident, runtime, .. } = header;
    let len = Literal::usize_unsuffixed(header.len());
    let (read, write) = (read(header), write(header));
    let (new, seal) = (new(header), seal(header, roles));
    let start = roles.total_length.offset;
    let start_literal = Literal::usize_unsuffixed(start);
    let end = Literal::usize_unsuffixed(start + 4);
    let (from_bytes, _) = conversions(header.byte_order);
    let Roles {
        head,
        kind,
        code,
        id,
        encoding,
        total_length,
        plain_length,
        digest,
    } = roles;
    let algorithm = digest.map_or("NoDigest", |field| field.algorithm().facts().0);
    let algorithm = Ident::new(algorithm, Span::call_site());
    let (id_max, id) = read_id(id);
    let [head, kind, code, total_length] =
        [head, kind, code, total_length].map(|field| field.ident);
    let encoding = encoding.map_or_else(|| quote!(0), |field| own(field));
    let plain_length = plain_length.map_or_else(
        || quote!(self.#total_length.saturating_sub(#len)),
        |field| own(field),
    );
    let digest = digest.map_or_else(|| quote!([0; 16]), read_digest);
    quote! {
        #[automatically_derived]
        impl #runtime::Header for #ident {
            type Digest = #runtime::digest::#algorithm;

            const LEN: ::core::primitive::usize = #len;
            const TOTAL_LENGTH_END: ::core::primitive::usize = #end;
            const ID_MAX: ::core::primitive::u32 = #id_max;

            fn read(bytes: &[::core::primitive::u8]) -> ::core::option::Option<Self> {
                let bytes: &[::core::primitive::u8; #len] = bytes.first_chunk()?;
                ::core::option::Option::Some(Self { #read })
            }

            fn write(&self, out: &mut [::core::primitive::u8]) -> ::core::primitive::bool {
                let ::core::option::Option::Some(__out) = out.first_chunk_mut::<#len>() else {
                    return false;
                };
                #write
                true
            }

            fn peek_total_length(
                bytes: &[::core::primitive::u8],
            ) -> ::core::option::Option<::core::primitive::u32> {
                let bytes = bytes.get(#start_literal..)?.first_chunk()?;
                ::core::option::Option::Some(::core::primitive::u32::#from_bytes(*bytes))
            }

            #new

            #seal

            fn head(&self) -> &[::core::primitive::u8] {
                &self.#head
            }

            fn kind(&self) -> ::core::primitive::u8 {
                self.#kind
            }

            fn code(&self) -> ::core::primitive::u16 {
                self.#code
            }

            fn id(&self) -> ::core::primitive::u32 {
                #id
            }

            fn encoding(&self) -> ::core::primitive::u8 {
                #encoding
            }

            fn total_length(&self) -> ::core::primitive::u32 {
                self.#total_length
            }

            fn plain_length(&self) -> ::core::primitive::u32 {
                #plain_length
            }

            fn digest(&self) -> #runtime::digest::Sum {
                #digest
            }
        }
    }
}

/// Returns the names of the conversions of an integer from and to bytes.
fn conversions(order: ByteOrder) -> (TokenStream, TokenStream) {
    match order {
        ByteOrder::Big => (quote!(from_be_bytes), quote!(to_be_bytes)),
        ByteOrder::Little => (quote!(from_le_bytes), quote!(to_le_bytes)),
    }
}

/// Returns the fields with their shapes. All types have been checked.
fn sized<'h>(header: &'h Header<'h>) -> impl Iterator<Item = (&'h Field<'h>, Shape)> {
    header
        .fields
        .iter()
        .filter_map(|field| Some((field, field.shape?)))
}

/// Returns one expression for each field, from the array `bytes`.
fn read(header: &Header<'_>) -> TokenStream {
    let (from_bytes, _) = conversions(header.byte_order);
    let fields = sized(header).map(|(field, shape)| {
        let (ident, ty, start) = (field.ident, field.ty, field.offset);
        let places = (start..start + shape.size()).map(Literal::usize_unsuffixed);
        match shape {
            Shape::Int(_) => quote!(#ident: <#ty>::#from_bytes([#(bytes[#places]),*]),),
            Shape::Bytes(_) => quote!(#ident: [#(bytes[#places]),*],),
        }
    });
    fields.collect()
}

/// Returns code that fills the whole array `out`.
fn write(header: &Header<'_>) -> TokenStream {
    let (_, to_bytes) = conversions(header.byte_order);
    let parts = sized(header).map(|(Field { ident, .. }, shape)| match shape {
        Shape::Int(_) => quote!(let #ident = self.#ident.#to_bytes();),
        Shape::Bytes(_) => quote!(let #ident = self.#ident;),
    });
    let bytes = sized(header).map(|(Field { ident, .. }, shape)| {
        let places = (0..shape.size()).map(Literal::usize_unsuffixed);
        quote!(#(#ident[#places],)*)
    });
    quote! {
        #(#parts)*
        *__out = [#(#bytes)*];
    }
}

fn new(header: &Header<'_>) -> TokenStream {
    let fields = sized(header).map(|(field, shape)| {
        let ident = field.ident;
        let value = match field.role.get().map(|(_, role)| role) {
            Some(Role::Head) => {
                let length = Literal::usize_unsuffixed(shape.size());
                quote!(head.first_chunk().copied().unwrap_or([0; #length]))
            }
            Some(Role::Kind) => quote!(kind),
            Some(Role::Code) => quote!(code),
            Some(Role::Id) => write_id(shape),
            Some(Role::Encoding) => quote!(encoding),
            Some(Role::TotalLength | Role::PlainLength) => quote!(0),
            Some(Role::Digest | Role::Status) | None => match shape {
                Shape::Int(_) => field.value.get().map_or_else(|| quote!(0), generated),
                Shape::Bytes(length) => {
                    let length = Literal::usize_unsuffixed(length);
                    quote!([0; #length])
                }
            },
        };
        quote!(#ident: #value,)
    });
    quote! {
        #[allow(unused_variables)]
        fn new(
            head: &'static [::core::primitive::u8],
            kind: ::core::primitive::u8,
            code: ::core::primitive::u16,
            id: ::core::primitive::u32,
            encoding: ::core::primitive::u8,
        ) -> Self {
            Self { #(#fields)* }
        }
    }
}

/// Returns the value of a field.
fn own(field: &Field<'_>) -> TokenStream {
    let ident = field.ident;
    quote!(self.#ident)
}

/// Returns the largest id, and the id as a `u32`.
fn read_id(field: &Field<'_>) -> (TokenStream, TokenStream) {
    let ident = field.ident;
    match field.shape {
        Some(Shape::Int(2)) => (
            quote!(0xFFFF),
            quote!(::core::primitive::u32::from(self.#ident)),
        ),
        _ => (quote!(::core::primitive::u32::MAX), own(field)),
    }
}

/// Returns the low bits of an id.
fn write_id(shape: Shape) -> TokenStream {
    if shape != Shape::Int(2) {
        return quote!(id);
    }
    quote!({
        let [_, _, high, low] = id.to_be_bytes();
        ::core::primitive::u16::from_be_bytes([high, low])
    })
}

/// Returns a digest field as the first bytes of a digest.
fn read_digest(field: &Field<'_>) -> TokenStream {
    let ident = field.ident;
    match field.algorithm() {
        Algorithm::Md5 => own(field),
        Algorithm::Crc32 => quote!({
            let [a, b, c, d] = self.#ident.to_be_bytes();
            [a, b, c, d, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
        }),
    }
}

/// Returns code that sets a digest field.
fn write_digest(field: &Field<'_>) -> TokenStream {
    let (ident, ty) = (field.ident, field.ty);
    match field.algorithm() {
        Algorithm::Md5 => quote!(self.#ident = digest;),
        Algorithm::Crc32 => quote! {
            let [a, b, c, d, ..] = digest;
            self.#ident = <#ty>::from_be_bytes([a, b, c, d]);
        },
    }
}

fn seal(header: &Header<'_>, roles: &Roles<'_>) -> TokenStream {
    let runtime = &header.runtime;
    let total_length = roles.total_length.ident;
    let plain_length = roles.plain_length.map(|field| {
        let ident = field.ident;
        quote!(self.#ident = plain_length;)
    });
    let digest = roles.digest.map(write_digest);
    quote! {
        #[allow(unused_variables)]
        fn seal(
            &mut self,
            total_length: ::core::primitive::u32,
            plain_length: ::core::primitive::u32,
            digest: #runtime::digest::Sum,
        ) {
            self.#total_length = total_length;
            #plain_length
            #digest
        }
    }
}

/// Returns an implementation that does nothing, for a header with errors.
pub fn stub(header: &Header<'_>) -> TokenStream {
    let Header { ident, runtime, .. } = header;
    let todo = quote!(::core::unimplemented!());
    quote! {
        #[automatically_derived]
        impl #runtime::Header for #ident {
            type Digest = #runtime::digest::NoDigest;
            const LEN: ::core::primitive::usize = 0;
            const TOTAL_LENGTH_END: ::core::primitive::usize = 0;
            const ID_MAX: ::core::primitive::u32 = 0;
            fn read(_: &[::core::primitive::u8]) -> ::core::option::Option<Self> { #todo }
            fn write(&self, _: &mut [::core::primitive::u8]) -> ::core::primitive::bool { #todo }
            fn peek_total_length(
                _: &[::core::primitive::u8],
            ) -> ::core::option::Option<::core::primitive::u32> { #todo }
            fn new(
                _: &'static [::core::primitive::u8],
                _: ::core::primitive::u8,
                _: ::core::primitive::u16,
                _: ::core::primitive::u32,
                _: ::core::primitive::u8,
            ) -> Self { #todo }
            fn seal(
                &mut self,
                _: ::core::primitive::u32,
                _: ::core::primitive::u32,
                _: #runtime::digest::Sum,
            ) { #todo }
            fn head(&self) -> &[::core::primitive::u8] { #todo }
            fn kind(&self) -> ::core::primitive::u8 { #todo }
            fn code(&self) -> ::core::primitive::u16 { #todo }
            fn id(&self) -> ::core::primitive::u32 { #todo }
            fn encoding(&self) -> ::core::primitive::u8 { #todo }
            fn total_length(&self) -> ::core::primitive::u32 { #todo }
            fn plain_length(&self) -> ::core::primitive::u32 { #todo }
            fn digest(&self) -> #runtime::digest::Sum { #todo }
        }
    }
}
