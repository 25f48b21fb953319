//! `when(…)` and `unless(…)`: fields that are present only under conditions on other fields.

use super::ast::{Field, Message};
use crate::attr;
use crate::errors::Errors;
use crate::new::optional;
use crate::span::{generated, span_of};
use proc_macro2::TokenStream;
use quote::{ToTokens as _, quote, quote_spanned};
use syn::ext::IdentExt as _;
use syn::parse::ParseStream;
use syn::{Ident, LitBool, Token};

/// One field in a condition.
pub struct Asked {
    /// The field.
    ident: Ident,
    /// Its values; any of them satisfies the condition.
    values: Vec<Wanted>,
}

/// A value in a condition.
struct Wanted {
    tokens: TokenStream,
    /// Readable form.
    text: String,
}

/// Reads `(mode = 2 | 3, place = "out", on = true)`.
pub fn read(input: ParseStream<'_>) -> syn::Result<Vec<Asked>> {
    attr::listed(input, "expected a field and its value", read_asked)
}

fn read_asked(input: ParseStream<'_>) -> syn::Result<Asked> {
    let ident = input.parse()?;
    input.parse::<Token![=]>()?;
    let mut values = vec![read_wanted(input)?];
    while input.parse::<Option<Token![|]>>()?.is_some() {
        values.push(read_wanted(input)?);
    }
    Ok(Asked { ident, values })
}

fn read_wanted(input: ParseStream<'_>) -> syn::Result<Wanted> {
    if input.peek(LitBool) {
        let literal: LitBool = input.parse()?;
        return Ok(Wanted {
            text: literal.value.to_string(),
            tokens: literal.into_token_stream(),
        });
    }
    let value = attr::scalar(input, "expected an integer, a string or a bool")?;
    Ok(Wanted {
        text: match value.number {
            Some(_) => value.text,
            None => format!("{:?}", value.text),
        },
        tokens: value.tokens,
    })
}

/// Reports invalid conditions and fields that cannot have one.
pub fn check(message: &Message<'_>, field: &Field<'_>, errors: &mut Errors) {
    let attributes = &field.attributes;
    let (when, unless) = (&attributes.when, &attributes.unless);
    if let (Some(_), Some(unless)) = (when.key(), unless.key()) {
        errors.at(unless, "a field has either `when` or `unless`");
    }
    if let (Some(at), None) = (when.key().or(unless.key()), optional(field.ty)) {
        errors.at(
            at,
            "a condition is for an `Option`: it says when there is a value",
        );
    }
    for asked in when.get().into_iter().chain(unless.get()).flatten() {
        let ident = &asked.ident;
        if ident.unraw() == field.ident.unraw() {
            errors.on(ident, "a field cannot depend on its own value");
            continue;
        }
        match find(message, ident) {
            None => errors.on(ident, format!("there is no field `{}`", ident.unraw())),
            Some(beside) if optional(beside.ty).is_some() => {
                errors.on(ident, "a condition asks a field that is always there");
            }
            Some(_) => {}
        }
    }
}

fn find<'m, 'a>(message: &'m Message<'a>, ident: &Ident) -> Option<&'m Field<'a>> {
    let mut fields = message.fields.iter();
    fields.find(|field| field.ident.unraw() == ident.unraw())
}

/// Returns `checked`, if a field has a condition.
pub fn checked(message: &Message<'_>) -> Option<TokenStream> {
    let Message {
        ident,
        vis,
        runtime,
        ..
    } = message;
    let checks = message.fields.iter();
    let checks: Vec<_> = checks.filter_map(|field| code(message, field)).collect();
    if checks.is_empty() {
        return None;
    }
    Some(quote! {
        #[automatically_derived]
        impl #ident {
            /// Returns this message if each field with a condition is present exactly when its condition holds. Sending
            /// and receiving do not check this, and messages inside this one are not checked.
            ///
            /// # Errors
            /// The first field that contradicts its condition.
            #vis fn checked(
                self,
            ) -> ::core::result::Result<Self, #runtime::condition::ConditionError> {
                #(#checks)*
                ::core::result::Result::Ok(self)
            }
        }
    })
}

/// Returns the check of one field, or `None` without a condition.
fn code(message: &Message<'_>, field: &Field<'_>) -> Option<TokenStream> {
    let runtime = &message.runtime;
    let Field {
        ident,
        key,
        attributes,
        ..
    } = field;
    let (kind, asked) = match (attributes.when.get(), attributes.unless.get()) {
        (Some(asked), _) => (quote!(When), asked),
        (None, Some(asked)) => (quote!(Unless), asked),
        (None, None) => return None,
    };
    let (mut said, mut held) = (Vec::new(), Vec::new());
    for asked in asked {
        let beside = find(message, &asked.ident)?;
        let (name, ty, key) = (beside.ident, beside.ty, &beside.key);
        let texts = asked.values.iter().map(|wanted| &wanted.text);
        said.push(quote!(#runtime::condition::Asked { key: #key, values: &[#(#texts),*] }));
        let span = span_of(&asked.ident);
        let values = asked.values.iter().map(|wanted| generated(&wanted.tokens));
        held.push(quote_spanned! {span=>
            <#ty as #runtime::condition::Comparable>::is_among(&self.#name, &[#(#values),*])
        });
    }
    Some(quote! {
        #runtime::condition::check(
            #key,
            &self.#ident,
            #runtime::condition::Condition::#kind(&[#(#said),*]),
            #(#held)&&*,
        )?;
    })
}
