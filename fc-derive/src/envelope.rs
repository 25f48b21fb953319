//! `#[derive(Envelope)]`.

use crate::attr::{self, Item, Slot};
use crate::errors::Errors;
use crate::item;
use proc_macro2::{Span, TokenStream};
use quote::quote;
use syn::parse::ParseStream;
use syn::{DeriveInput, Field, Ident, LitStr, Path, Type};

/// Writes the envelope trait, or errors and a stub.
pub fn expand(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let envelope = Envelope::read(input, &mut errors);
    errors.finish(|| code(&envelope), || stub(&envelope))
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
    fn read(input: &'a DeriveInput, errors: &mut Errors) -> Self {
        let mut side = Slot::default();
        let runtime = item::read_attributes(input, errors, "an envelope", &mut |key, input| {
            if key == "envelope" {
                return side.set(key, read_side(input));
            }
            // `Message` reads all other keys and reports unknown ones.
            Ok(Item::Foreign)
        });
        let message = "the side is missing: `#[fc(envelope = \"request\")]` or `\"response\"`";
        let side = side.required(errors, &input.ident, message).copied();
        let mut envelope = Self {
            ident: &input.ident,
            runtime,
            side,
            time: None,
            result_code: None,
            result_text: None,
            rest: Vec::new(),
        };
        if let Some(fields) = item::fields(input, errors, "an envelope is a struct", "") {
            for field in fields {
                envelope.add(field, errors);
            }
        }
        if envelope.result_text.is_some() && envelope.result_code.is_none() {
            errors.on(
                &input.ident,
                "a result text says what a result code means, and no field has the role `result_code`",
            );
        }
        envelope
    }

    fn add(&mut self, field: &'a Field, errors: &mut Errors) {
        let Some(ident) = &field.ident else { return };
        let role = attr::read_own(&field.attrs, errors, "role", read_role);
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
            errors.on(
                &literal,
                format!("another field has the role `{}`", literal.value()),
            );
        }
        if of_response && self.side == Some(Side::Request) {
            errors.on(&literal, "a request has no result");
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
    let text =
        |(field, ty): Part<'_>| quote!(<#ty as #runtime::envelope::Text>::as_text(&self.#field));
    implement(
        envelope,
        &Bodies {
            at: quote! {
                Self {
                    #make_time
                    #make_code
                    #make_text
                    #(#make_rest)*
                }
            },
            time_ms: take_time,
            has_result: result_code.is_some(),
            result_code: take_number(result_code),
            result_text: result_text.map_or_else(|| quote!(""), text),
        },
    )
}

/// Returns an implementation that does nothing, for an envelope with errors.
fn stub(envelope: &Envelope<'_>) -> TokenStream {
    if envelope.side.is_none() {
        return TokenStream::new();
    }
    let todo = quote!(::core::unimplemented!());
    implement(
        envelope,
        &Bodies {
            at: todo.clone(),
            time_ms: todo.clone(),
            has_result: false,
            result_code: todo.clone(),
            result_text: todo,
        },
    )
}

/// The bodies of the methods of an envelope. A request has no result.
struct Bodies {
    at: TokenStream,
    time_ms: TokenStream,
    has_result: bool,
    result_code: TokenStream,
    result_text: TokenStream,
}

/// Implements the envelope trait.
fn implement(envelope: &Envelope<'_>, bodies: &Bodies) -> TokenStream {
    let Envelope { ident, runtime, .. } = envelope;
    let Bodies {
        at,
        time_ms,
        has_result,
        result_code,
        result_text,
    } = bodies;
    let is_response = envelope.side == Some(Side::Response);
    let name = if is_response {
        "ResponseEnvelope"
    } else {
        "RequestEnvelope"
    };
    let trait_name = Ident::new(name, Span::call_site());
    let result_arguments = is_response.then(|| {
        quote! {
            code: ::core::primitive::i64,
            text: &::core::primitive::str,
        }
    });
    let results = is_response.then(|| {
        quote! {
            const HAS_RESULT: ::core::primitive::bool = #has_result;

            fn result_code(&self) -> ::core::option::Option<::core::primitive::i64> {
                #result_code
            }

            fn result_text(&self) -> &::core::primitive::str {
                #result_text
            }
        }
    });
    quote! {
        #[automatically_derived]
        impl #runtime::#trait_name for #ident {
            #[allow(unused_variables)]
            fn at(time_ms: ::core::primitive::i64, #result_arguments) -> Self {
                #at
            }

            fn time_ms(&self) -> ::core::option::Option<::core::primitive::i64> {
                #time_ms
            }

            #results
        }
    }
}
