//! `#[derive(Envelope)]`.

use crate::attr::{self, Item, Slot};
use crate::faults::Faults;
use crate::item;
use proc_macro2::{Span, TokenStream};
use quote::quote;
use syn::parse::ParseStream;
use syn::{DeriveInput, Field, Ident, LitStr, Path, Type};

/// Writes the envelope trait, or errors and a stub.
pub fn expand(input: &DeriveInput, mut faults: Faults) -> TokenStream {
    let envelope = Envelope::read(input, &mut faults);
    faults.finish(|| code(&envelope), || stub(&envelope))
}

struct Envelope<'a> {
    ident: &'a Ident,
    runtime: Path,
    /// `None` if it is missing or invalid.
    side: Option<Side>,
    time: Option<Part<'a>>,
    result_code: Option<Part<'a>>,
    result_text: Option<Part<'a>>,
    /// Fields without a role.
    rest: Vec<&'a Ident>,
}

/// A field with a role.
type Part<'a> = (&'a Ident, &'a Type);

#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Request,
    Response,
}

#[derive(Clone, Copy)]
enum Role {
    Time,
    ResultCode,
    ResultText,
}

impl<'a> Envelope<'a> {
    fn read(input: &'a DeriveInput, faults: &mut Faults) -> Self {
        let mut side = Slot::default();
        let runtime = item::read_attributes(input, faults, "an envelope", &mut |key, input| {
            if key == "envelope" {
                return side.set(key, read_side(input));
            }
            // `Message` reads all other keys and reports unknown ones.
            Ok(Item::Foreign)
        });
        let message = "the side is missing: `#[fc(envelope = \"request\")]` or `\"response\"`";
        let side = side.required(faults, &input.ident, message).copied();
        let mut envelope = Self {
            ident: &input.ident,
            runtime,
            side,
            time: None,
            result_code: None,
            result_text: None,
            rest: Vec::new(),
        };
        if let Some(fields) = item::fields(input, faults, "an envelope is a struct", "") {
            for field in fields {
                envelope.add(field, faults);
            }
        }
        if envelope.result_text.is_some() && envelope.result_code.is_none() {
            faults.on(
                &input.ident,
                "a result text says what a result code means, and no field has the role `result_code`",
            );
        }
        envelope
    }

    fn add(&mut self, field: &'a Field, faults: &mut Faults) {
        let Some(ident) = &field.ident else { return };
        let mut role = Slot::default();
        attr::read(
            &field.attrs,
            faults,
            "an envelope's field",
            &mut |key, input| {
                if key == "role" {
                    return role.set(key, read_role(input));
                }
                // `Message` reads all other keys and reports unknown ones.
                Ok(Item::Foreign)
            },
        );
        let Some((literal, role)) = role.into_value() else {
            self.rest.push(ident);
            return;
        };
        let (slot, of_response) = match role {
            Role::Time => (&mut self.time, false),
            Role::ResultCode => (&mut self.result_code, true),
            Role::ResultText => (&mut self.result_text, true),
        };
        if slot.is_some() {
            faults.on(
                &literal,
                format!("another field has the role `{}`", literal.value()),
            );
        }
        if of_response && self.side == Some(Side::Request) {
            faults.on(&literal, "a request has no result");
        }
        *slot = Some((ident, &field.ty));
    }
}

fn read_side(input: ParseStream<'_>) -> syn::Result<Side> {
    const SIDES: [(&str, Side); 2] = [("request", Side::Request), ("response", Side::Response)];
    attr::word(input, &SIDES).map(|(_, side)| side)
}

fn read_role(input: ParseStream<'_>) -> syn::Result<(LitStr, Role)> {
    const ROLES: [(&str, Role); 3] = [
        ("time", Role::Time),
        ("result_code", Role::ResultCode),
        ("result_text", Role::ResultText),
    ];
    attr::word(input, &ROLES)
}

fn code(envelope: &Envelope<'_>) -> TokenStream {
    let Envelope {
        ident,
        runtime,
        time,
        result_code,
        result_text,
        rest,
        ..
    } = envelope;
    let part = |part: &Option<Part<'_>>, argument: TokenStream, source: TokenStream| {
        part.map(|(field, ty)| {
            quote!(#field: <#ty as #runtime::envelope::Part<#source>>::make(#argument),)
        })
    };
    let number = quote!(::core::primitive::i64);
    let str_type = quote!(&::core::primitive::str);
    let make_time = part(time, quote!(time_ms), number.clone());
    let make_code = part(result_code, quote!(code), number.clone());
    let make_text = part(result_text, quote!(text), str_type);
    let make_rest = rest
        .iter()
        .map(|field| quote!(#field: ::core::default::Default::default(),));
    let take_number = |part: &Option<Part<'_>>| {
        part.map_or_else(
            || quote!(::core::option::Option::None),
            |(field, ty)| {
                let number = quote!(::core::option::Option<::core::primitive::i64>);
                quote!(<#ty as #runtime::envelope::Taken<#number>>::take(&self.#field))
            },
        )
    };
    let take_time = take_number(time);
    let trait_name = trait_name(envelope);
    let (arguments, results) = if envelope.side == Some(Side::Response) {
        let has_result = result_code.is_some();
        let take_code = take_number(result_code);
        let text = |(field, ty): Part<'_>| quote!(<#ty as #runtime::envelope::Text>::as_text(&self.#field));
        let take_text = result_text.map_or_else(|| quote!(""), text);
        let arguments = quote! {
            time_ms: ::core::primitive::i64,
            code: ::core::primitive::i64,
            text: &::core::primitive::str,
        };
        let results = quote! {
            const HAS_RESULT: ::core::primitive::bool = #has_result;

            fn result_code(&self) -> ::core::option::Option<::core::primitive::i64> {
                #take_code
            }

            fn result_text(&self) -> &::core::primitive::str {
                #take_text
            }
        };
        (arguments, Some(results))
    } else {
        (quote!(time_ms: ::core::primitive::i64), None)
    };
    quote! {
        #[automatically_derived]
        impl #runtime::#trait_name for #ident {
            #[allow(unused_variables)]
            fn at(#arguments) -> Self {
                Self {
                    #make_time
                    #make_code
                    #make_text
                    #(#make_rest)*
                }
            }

            fn time_ms(&self) -> ::core::option::Option<::core::primitive::i64> {
                #take_time
            }

            #results
        }
    }
}

fn trait_name(envelope: &Envelope<'_>) -> Ident {
    let name = match envelope.side {
        Some(Side::Response) => "ResponseEnvelope",
        Some(Side::Request) | None => "RequestEnvelope",
    };
    Ident::new(name, Span::call_site())
}

/// Returns an implementation that does nothing, for an envelope with errors.
fn stub(envelope: &Envelope<'_>) -> TokenStream {
    let Envelope { ident, runtime, .. } = envelope;
    if envelope.side.is_none() {
        return TokenStream::new();
    }
    let trait_name = trait_name(envelope);
    let todo = quote!(::core::unimplemented!());
    let (arguments, results) = if envelope.side == Some(Side::Response) {
        let arguments = quote!(
            _: ::core::primitive::i64,
            _: ::core::primitive::i64,
            _: &::core::primitive::str,
        );
        let results = quote! {
            const HAS_RESULT: ::core::primitive::bool = false;
            fn result_code(&self) -> ::core::option::Option<::core::primitive::i64> { #todo }
            fn result_text(&self) -> &::core::primitive::str { #todo }
        };
        (arguments, Some(results))
    } else {
        (quote!(_: ::core::primitive::i64), None)
    };
    quote! {
        #[automatically_derived]
        impl #runtime::#trait_name for #ident {
            fn at(#arguments) -> Self { #todo }
            fn time_ms(&self) -> ::core::option::Option<::core::primitive::i64> { #todo }
            #results
        }
    }
}
