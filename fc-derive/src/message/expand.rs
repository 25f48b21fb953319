//! The code of a message.

use super::ast::{Field, Lenient, Message};
use crate::attr::{Number, NumberValue};
use crate::span::{generated, moved, span_of};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Type;

/// Longest tuple that has a `Default`.
const TUPLE: usize = 12;

/// The implementations of `FromJson`, `ToJson` and `Message`.
pub fn code(message: &Message<'_>) -> TokenStream {
    let Message { ident, runtime, .. } = message;
    let partial = Partial::of(message);
    let partial_type = &partial.ty;
    let example = message.example.get().map(|literal| {
        quote! { const EXAMPLE: &'static ::core::primitive::str = #literal; }
    });
    let keys = message.fields.iter().map(|field| key(message, field));
    let in_order = read_in_order(message, &partial);
    let by_key = read_field(message, &partial);
    let unknown = partial.extra().map_or_else(
        || quote!(reader.skip_value()),
        |slot| quote!(partial #slot.keep(key, reader)),
    );
    let values = finish(message, &partial);
    let writes = write_fields(message);
    let check_value = check_value(message);
    let check_own = check_own(message);
    let finished = if check_own.is_some() {
        quote! {
            let message = Self { #values };
            #runtime::message::Message::check_own(&message)?;
            ::core::result::Result::Ok(message)
        }
    } else {
        quote!(::core::result::Result::Ok(Self { #values }))
    };
    quote! {
        #[automatically_derived]
        impl #runtime::json::FromJson for #ident {
            fn read(
                reader: &mut #runtime::json::Reader<'_>,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                reader.message()
            }
        }

        #[automatically_derived]
        impl #runtime::json::ToJson for #ident {
            fn write(&self, writer: &mut #runtime::json::Writer<'_>) {
                writer.message(self);
            }
            #check_value
        }

        #[automatically_derived]
        impl #runtime::message::Message for #ident {
            type Partial = #partial_type;
            const KEYS: &'static [#runtime::message::Key] = &[#(#keys),*];
            #example
            #in_order
            #by_key
            #[allow(unused_variables)]
            fn read_unknown(
                partial: &mut Self::Partial,
                key: &::core::primitive::str,
                reader: &mut #runtime::json::Reader<'_>,
            ) -> ::core::result::Result<(), #runtime::json::BodyError> {
                #unknown
            }
            #[allow(unused_variables)]
            fn finish(
                partial: Self::Partial,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                #finished
            }
            #[allow(unused_variables)]
            fn write_fields(&self, object: &mut #runtime::json::ObjectWriter<'_>) {
                #writes
            }
            #check_own
        }
    }
}

/// The fields read so far: one slot for each field and one for unknown keys, in a tuple, or in a
/// tuple of tuples where there are too many for a tuple's `Default`.
struct Partial {
    ty: TokenStream,
    slots: Vec<TokenStream>,
    has_extra: bool,
}

impl Partial {
    fn of(message: &Message<'_>) -> Self {
        let runtime = &message.runtime;
        let mut types: Vec<_> = message
            .fields
            .iter()
            .map(|Field { ty, .. }| quote!(::core::option::Option<#ty>))
            .collect();
        if !message.extra.is_empty() {
            types.push(quote!(#runtime::json::Extra));
        }
        let mut slots = vec![TokenStream::new(); types.len()];
        let mut size = 1;
        while types.len() > 1 || size == 1 {
            for (index, slot) in slots.iter_mut().enumerate() {
                let position = Literal::usize_unsuffixed(index / size % TUPLE);
                *slot = quote!(.#position #slot);
            }
            types = types
                .chunks(TUPLE)
                .map(|types| quote!((#(#types,)*)))
                .collect();
            size *= TUPLE;
        }
        Self {
            ty: types.pop().unwrap_or_else(|| quote!(())),
            slots,
            has_extra: !message.extra.is_empty(),
        }
    }

    /// The slot of unknown keys.
    fn extra(&self) -> Option<&TokenStream> {
        self.slots.last().filter(|_| self.has_extra)
    }
}

fn key(message: &Message<'_>, field: &Field<'_>) -> TokenStream {
    let runtime = &message.runtime;
    let Field { key, ty, .. } = field;
    let also = field.attributes.also.get().into_iter().flatten();
    quote! {
        #runtime::message::Key {
            name: #key,
            also: &[#(#also),*],
            required: !<#ty as #runtime::json::FromJson>::OPTIONAL,
        }
    }
}

/// The form in which a field is read where that is not its type's own.
fn form(message: &Message<'_>, field: &Field<'_>) -> Option<TokenStream> {
    let runtime = &message.runtime;
    let attributes = &field.attributes;
    let form = match (attributes.lenient.get(), attributes.wire.get()) {
        (Some(Lenient::Number), _) => Some(quote!(#runtime::json::LenientNumber)),
        (Some(Lenient::Bool), _) => Some(quote!(#runtime::json::LenientBool)),
        (None, Some(())) => Some(quote!(#runtime::json::Quoted)),
        (None, None) => None,
    };
    let form = if attributes.empty_is_absent.get().is_some() {
        let form = form.unwrap_or_else(|| quote!(#runtime::json::Plain));
        Some(quote!(#runtime::json::EmptyIsAbsent<#form>))
    } else {
        form
    };
    // A type that has no such form is at fault, not the derive.
    form.map(|form| moved(form, span_of(field.ty)))
}

fn read_in_order(message: &Message<'_>, partial: &Partial) -> TokenStream {
    let runtime = &message.runtime;
    let reads = message
        .fields
        .iter()
        .zip(&partial.slots)
        .map(|(field, slot)| {
            let literal = format!("{}:", json_string(&field.key));
            let ty = field.ty;
            match form(message, field) {
                None => quote!(reader.field::<#ty>(#literal, &mut partial #slot)?;),
                Some(form) => quote!(reader.field_as::<#form, #ty>(#literal, &mut partial #slot)?;),
            }
        });
    quote! {
        #[allow(unused_variables)]
        fn read_in_order(
            partial: &mut Self::Partial,
            reader: &mut #runtime::json::Reader<'_>,
        ) -> ::core::result::Result<(), #runtime::json::BodyError> {
            #(#reads)*
            ::core::result::Result::Ok(())
        }
    }
}

fn read_field(message: &Message<'_>, partial: &Partial) -> TokenStream {
    let runtime = &message.runtime;
    let arms = message
        .fields
        .iter()
        .zip(&partial.slots)
        .map(|(field, slot)| {
            let key = &field.key;
            let also = field.attributes.also.get().into_iter().flatten();
            let read = match form(message, field) {
                None => quote!(reader.value(&mut partial #slot)?),
                Some(form) => quote!(reader.value_as::<#form, _>(&mut partial #slot)?),
            };
            quote!(#key #(| #also)* => #read,)
        });
    let body = if message.fields.is_empty() {
        quote!(::core::result::Result::Ok(false))
    } else {
        quote! {
            match key {
                #(#arms)*
                _ => return ::core::result::Result::Ok(false),
            }
            ::core::result::Result::Ok(true)
        }
    };
    quote! {
        #[allow(unused_variables)]
        fn read_field(
            partial: &mut Self::Partial,
            key: &::core::primitive::str,
            reader: &mut #runtime::json::Reader<'_>,
        ) -> ::core::result::Result<::core::primitive::bool, #runtime::json::BodyError> {
            #body
        }
    }
}

fn finish(message: &Message<'_>, partial: &Partial) -> TokenStream {
    let runtime = &message.runtime;
    let fields = message
        .fields
        .iter()
        .zip(&partial.slots)
        .map(|(field, slot)| {
            let Field { ident, key, ty, .. } = field;
            quote!(#ident: #runtime::json::required::<#ty>(partial #slot, #key)?,)
        });
    let extra = message.extra.first().zip(partial.extra());
    let extra = extra.map(|((ident, ty), slot)| {
        let value = moved(quote!(partial #slot), span_of(ty));
        quote!(#ident: #value,)
    });
    quote!(#(#fields)* #extra)
}

fn write_fields(message: &Message<'_>) -> TokenStream {
    let fields = message.fields.iter().map(|field| {
        let Field { ident, ty, .. } = field;
        let literal = format!(",{}:", json_string(&field.key));
        if field.attributes.wire.get().is_some() {
            quote!(object.quoted_field::<#ty>(#literal, &self.#ident);)
        } else {
            quote!(object.field::<#ty>(#literal, &self.#ident);)
        }
    });
    let extra = message
        .extra
        .first()
        .map(|(ident, _)| quote!(object.extra(&self.#ident);));
    quote!(#(#fields)* #extra)
}

/// The check of what is inside, left out where nothing can be.
fn check_value(message: &Message<'_>) -> Option<TokenStream> {
    let runtime = &message.runtime;
    let inner: Vec<_> = message
        .fields
        .iter()
        .filter(|field| !is_leaf(field.ty))
        .collect();
    let own = message
        .fields
        .iter()
        .any(|field| field.attributes.has_constraints());
    if inner.is_empty() && !own {
        return None;
    }
    let own = own.then(|| quote!(#runtime::message::Message::check_own(self)?;));
    let inner = inner.iter().map(
        |Field { ident, key, ty, .. }| quote!(#runtime::json::inside::<#ty>(#key, &self.#ident)?;),
    );
    Some(quote! {
        fn check_value(&self) -> ::core::result::Result<(), #runtime::json::BodyError> {
            #own
            #(#inner)*
            ::core::result::Result::Ok(())
        }
    })
}

/// Whether a type is known by its name to hold no message. A type of the user's own with such a name
/// is only checked less when it is sent.
fn is_leaf(ty: &Type) -> bool {
    const LEAVES: [&str; 14] = [
        "bool", "i8", "i16", "i32", "i64", "u8", "u16", "u32", "u64", "f32", "f64", "String",
        "Json", "Bytes64",
    ];
    const WRAPPERS: [&str; 2] = ["Option", "Vec"];
    let Type::Path(path) = ty else { return false };
    let Some(last) = path.path.segments.last() else {
        return false;
    };
    match &last.arguments {
        syn::PathArguments::None => LEAVES.iter().any(|leaf| last.ident == leaf),
        syn::PathArguments::AngleBracketed(arguments)
            if WRAPPERS.iter().any(|wrapper| last.ident == wrapper) =>
        {
            arguments
                .args
                .iter()
                .all(|inner| matches!(inner, syn::GenericArgument::Type(ty) if is_leaf(ty)))
        }
        _ => false,
    }
}

fn check_own(message: &Message<'_>) -> Option<TokenStream> {
    let runtime = &message.runtime;
    let checks: Vec<_> = message
        .fields
        .iter()
        .flat_map(|field| constraints(message, field))
        .collect();
    if checks.is_empty() {
        return None;
    }
    Some(quote! {
        fn check_own(&self) -> ::core::result::Result<(), #runtime::json::BodyError> {
            #(#checks)*
            ::core::result::Result::Ok(())
        }
    })
}

fn constraints(message: &Message<'_>, field: &Field<'_>) -> Vec<TokenStream> {
    let runtime = &message.runtime;
    let Field {
        ident,
        key,
        ty,
        attributes,
        ..
    } = field;
    let mut checks = Vec::new();
    if let Some(min) = attributes.min.get() {
        let limit = limit(message, min);
        checks.push(quote!(#runtime::json::min::<#ty>(#key, &self.#ident, #limit)?;));
    }
    if let Some(max) = attributes.max.get() {
        let limit = limit(message, max);
        checks.push(quote!(#runtime::json::max::<#ty>(#key, &self.#ident, #limit)?;));
    }
    if let Some((least, most)) = attributes.length.get() {
        let least = Literal::usize_unsuffixed(*least);
        let most = Literal::usize_unsuffixed(*most);
        checks.push(quote! {
            #runtime::json::length::<#ty>(#key, &self.#ident, #least, #most)?;
        });
    }
    if let Some(pattern) = attributes.pattern.get() {
        checks.push(quote! {{
            static PATTERN: #runtime::json::Pattern = #runtime::json::Pattern::new(#pattern);
            #runtime::json::matches::<#ty>(#key, &self.#ident, &PATTERN)?;
        }});
    }
    checks
}

fn limit(message: &Message<'_>, number: &Number) -> TokenStream {
    let runtime = &message.runtime;
    let tokens = generated(&number.tokens);
    let variant = match number.value {
        NumberValue::Int(_) => format_ident!("Int"),
        NumberValue::Float(_) => format_ident!("Float"),
    };
    quote!(#runtime::json::Limit::#variant(#tokens))
}

/// A key in quotes, as the writer of the runtime escapes it.
fn json_string(text: &str) -> String {
    let mut out = String::from("\"");
    for character in text.chars() {
        match character {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            other => out.push(other),
        }
    }
    out.push('"');
    out
}
