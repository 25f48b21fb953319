//! The code of a message.

use super::ast::{Field, FieldAttributes, Message, WireForm};
use super::condition;
use crate::span::{moved, span_of};
use proc_macro2::{Literal, Span, TokenStream};
use quote::{quote, quote_spanned};
use syn::{Path, Type};

/// Returns the implementation of `Message`.
pub fn code(message: &Message<'_>) -> TokenStream {
    let Message { ident, runtime, .. } = message;
    let example = message.example.get().map(|literal| {
        quote! { const EXAMPLE: &'static ::core::primitive::str = #literal; }
    });
    let types = message.fields.iter().map(|Field { ty, .. }| ty);
    let empty = message
        .fields
        .iter()
        .map(|_| quote!(::core::option::Option::None));
    let extra = message.extra.first();
    let extra_type = extra.map(|_| quote!(#runtime::json::Extra,));
    let extra_empty = extra.map(|_| quote!(#runtime::json::Extra::new(),));
    let has_slots = !message.fields.is_empty() || extra.is_some();
    let slots = has_slots.then(|| quote!((#(#empty,)* #extra_empty)));
    let reads = read_fields(message);
    let finish = finish(message);
    let writes = write_fields(message);
    let check_own = check_own(message);
    let check = check(message);
    let checked = condition::checked(message);
    quote! {
        #[automatically_derived]
        impl #runtime::message::Message for #ident {
            type Slots = (#(::core::option::Option<#types>,)* #extra_type);
            #example
            fn slots() -> Self::Slots { #slots }
            #[allow(unused_variables)]
            fn read_fields(slots: &mut Self::Slots, reader: &mut #runtime::json::Reader<'_>) {
                #reads
            }
            #[allow(unused_imports)]
            fn finish(slots: Self::Slots) -> ::core::option::Option<Self> {
                #finish
            }
            #[allow(unused_variables)]
            fn write_fields(&self, object: &mut #runtime::json::ObjectWriter<'_>) {
                #writes
            }
            #check_own
            #check
        }
        #checked
    }
}

/// Returns the form in which a field is read, if it is not that of the type.
fn form(runtime: &Path, attributes: &FieldAttributes) -> Option<TokenStream> {
    let form = match (attributes.lenient.get(), attributes.wire.get()) {
        (Some(lenient), _) => Some(quote!(#runtime::json::#lenient)),
        (None, Some(WireForm::String)) => Some(quote!(#runtime::json::Quoted)),
        (None, Some(WireForm::Number)) => Some(quote!(#runtime::json::Numeric)),
        (None, None) => None,
    };
    if attributes.empty_is_absent.get().is_none() {
        return form;
    }
    let form = form.unwrap_or_else(|| quote!(#runtime::json::Plain));
    Some(quote!(#runtime::json::EmptyIsAbsent<#form>))
}

fn read_fields(message: &Message<'_>) -> TokenStream {
    let runtime = &message.runtime;
    let mut out = TokenStream::new();
    for (index, field) in message.fields.iter().enumerate() {
        // Point errors about a type without JSON at the type, not at the derive.
        let ty = field.ty;
        let span = span_of(ty);
        let slot = slot(index, span);
        let name = name(&field.key);
        let form = form(runtime, &field.attributes).map(|form| moved(form, span));
        let also = field.attributes.also.get();
        out.extend(if form.is_none() && also.is_none() {
            quote_spanned!(span=> reader.field(#name, &mut slots.#slot);)
        } else {
            let form = form.unwrap_or_else(|| quote!(#runtime::json::Plain));
            let also = also
                .into_iter()
                .flatten()
                .map(|key| self::name(&key.value()));
            quote_spanned! {span=>
                reader.field_as::<#form, #ty>(&[#name, #(#also),*], &mut slots.#slot);
            }
        });
    }
    if let Some((_, ty)) = message.extra.first() {
        let span = span_of(ty);
        let slot = slot(message.fields.len(), span);
        out.extend(quote_spanned!(span=> reader.extra(&mut slots.#slot);));
    }
    out
}

/// Returns the index of a slot.
fn slot(index: usize, span: Span) -> Literal {
    let mut slot = Literal::usize_unsuffixed(index);
    slot.set_span(span);
    slot
}

fn finish(message: &Message<'_>) -> TokenStream {
    let runtime = &message.runtime;
    let fields = message.fields.iter().map(|field| field.ident);
    let (slots, present) = (fields.clone(), fields.clone());
    let read = message.fields.iter().map(
        |Field { ident, ty, .. }| quote!(#ident.or(<#ty as #runtime::json::FromJson>::absent())),
    );
    let extra = message.extra.first();
    let extra_name = extra.map(|(ident, _)| quote!(#ident,));
    let extra_field = extra.map(|(ident, ty)| {
        let value = moved(ident, span_of(ty));
        quote!(#ident: #value)
    });
    // Without fields, the pattern always matches.
    let otherwise = fields.clone().next().map(|_| quote!(else { return None; }));
    quote! {
        use ::core::option::Option::{None, Some};
        let (#(#slots,)* #extra_name) = slots;
        let (#(Some(#present),)*) = (#(#read,)*) #otherwise;
        Some(Self { #(#fields,)* #extra_field })
    }
}

fn write_fields(message: &Message<'_>) -> TokenStream {
    let mut out = TokenStream::new();
    for Field {
        ident,
        ty,
        key,
        attributes,
        ..
    } in &message.fields
    {
        let name = format!(",{}", name(key));
        let span = span_of(ty);
        let mut ident = (*ident).clone();
        ident.set_span(ident.span().located_at(span));
        out.extend(match attributes.wire.get() {
            None => quote_spanned!(span=> object.field(#name, &self.#ident);),
            Some(WireForm::String) => {
                quote_spanned!(span=> object.quoted_field(#name, &self.#ident);)
            }
            Some(WireForm::Number) => {
                quote_spanned!(span=> object.numeric_field(#name, &self.#ident);)
            }
        });
    }
    if let Some((ident, _)) = message.extra.first() {
        out.extend(quote!(object.extra(&self.#ident);));
    }
    out
}

/// Returns the check of inner values, or `None` if there are none.
fn check(message: &Message<'_>) -> Option<TokenStream> {
    let runtime = &message.runtime;
    let fields = message.fields.iter();
    let inner: Vec<_> = fields.filter(|field| !is_leaf(field.ty)).collect();
    if inner.is_empty() {
        return None;
    }
    let inner = inner.iter().map(
        |Field { ident, key, ty, .. }| quote!(#runtime::json::inside::<#ty>(#key, &self.#ident)?;),
    );
    Some(quote! {
        fn check(&self) -> ::core::result::Result<(), #runtime::json::BodyError> {
            #runtime::message::Message::check_own(self)?;
            #(#inner)*
            ::core::result::Result::Ok(())
        }
    })
}

/// Returns `true` if the name of a type shows that it contains neither a message nor a float, which may be NaN. A user
/// type with such a name is only checked less when it is sent.
fn is_leaf(ty: &Type) -> bool {
    const LEAVES: [&str; 12] = [
        "bool", "i8", "i16", "i32", "i64", "u8", "u16", "u32", "u64", "String", "Json", "Bytes64",
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
    let mut checks = Vec::new();
    for field in &message.fields {
        checks.append(&mut field.attributes.constraints.checks(runtime, field));
    }
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

/// Returns the text in front of a value, escaped like in the writer of the runtime.
fn name(key: &str) -> String {
    let mut out = String::from("\"");
    for character in key.chars() {
        match character {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            other => out.push(other),
        }
    }
    out.push_str("\":");
    out
}
