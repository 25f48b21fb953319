//! `#[derive(Command)]` and `#[derive(Report)]`: the code and further properties of a message.

use crate::attr::{self, Item, Slot};
use crate::errors::Errors;
use crate::process::{self, SetOff, StateAt, Way};
use crate::span::generated;
use proc_macro2::TokenStream;
use quote::{ToTokens, quote};
use syn::parse::{Parse as _, ParseStream};
use syn::{DeriveInput, Ident, LitInt, LitStr, Path, Type};

/// The attributes of an operation.
#[derive(Default)]
struct Operation {
    runtime: Slot<Path>,
    code: Slot<LitInt>,
    name: Slot<LitStr>,
    effect: Slot<Ident>,
    response: Slot<Type>,
    error: Slot<Type>,
    accepted_in: Slot<Vec<States>>,
    ack: Slot<Ack>,
    sets_off: Slot<Vec<SetOff>>,
    state: Slot<StateAt>,
    failure: Slot<Vec<Way>>,
}

/// `Switch(Open, Closed)`: an enum and its variants.
struct States {
    ty: Path,
    variants: Vec<Ident>,
}

/// `ack(timeout_ms = 2000, retries = 3)`.
struct Ack {
    timeout_ms: u64,
    retries: u32,
}

impl Operation {
    fn read(input: &DeriveInput, errors: &mut Errors) -> Self {
        let mut this = Self::default();
        attr::read(&input.attrs, errors, "an operation", &mut |key, input| {
            this.item(key, input)
        });
        this
    }

    fn item(&mut self, key: &Ident, input: ParseStream<'_>) -> syn::Result<Item> {
        match key.to_string().as_str() {
            "crate" => self.runtime.set(key, attr::path(input)),
            "code" => self.code.set(key, code(input)),
            "name" => self.name.set(key, attr::text(input)),
            "effect" => self.effect.set(key, effect(input)),
            "response" => self.response.set(key, attr::value(input)),
            "error" => self.error.set(key, attr::value(input)),
            "accepted_in" => self.accepted_in.set(key, accepted_in(input)),
            "ack" => self.ack.set(key, ack(input)),
            "sets_off" => self.sets_off.set(key, process::sets_off(input)),
            "state" => self.state.set(key, process::state(input)),
            "failure" => self.failure.set(key, process::ways(input)),
            // `Message` reads all other keys and reports unknown ones.
            _ => Ok(Item::Foreign),
        }
    }
}

/// Reads `= 0x0A03`.
fn code(input: ParseStream<'_>) -> syn::Result<LitInt> {
    let literal: LitInt = attr::value(input)?;
    match attr::plain_integer::<u16>(&literal) {
        Ok(_) => Ok(literal),
        Err(error) => Err(syn::Error::new_spanned(
            literal,
            format!("a code has 16 bits: {error}"),
        )),
    }
}

/// Reads `= "read"`.
fn effect(input: ParseStream<'_>) -> syn::Result<Ident> {
    const EFFECTS: [(&str, &str); 4] = [
        ("read", "Read"),
        ("config", "Config"),
        ("motion", "Motion"),
        ("unknown", "Unknown"),
    ];
    let (literal, variant) = attr::word(input, &EFFECTS)?;
    Ok(Ident::new(variant, literal.span()))
}

/// Reads `(Switch(Open, Closed), Mode(Manual))`.
fn accepted_in(input: ParseStream<'_>) -> syn::Result<Vec<States>> {
    attr::listed(input, "expected an enum of states", |input| {
        Ok(States {
            ty: input.call(Path::parse_mod_style)?,
            variants: attr::listed(input, "expected at least one variant", Ident::parse)?,
        })
    })
}

/// Reads `(timeout_ms = 2000, retries = 3)`.
fn ack(input: ParseStream<'_>) -> syn::Result<Ack> {
    let content;
    let parentheses = syn::parenthesized!(content in input);
    let mut timeout_ms = Slot::default();
    let mut retries = Slot::default();
    let mut errors = Errors::default();
    attr::read_items(&content, &mut errors, "`ack`", &mut |key, input| match key
        .to_string()
        .as_str()
    {
        "timeout_ms" => timeout_ms.set(key, attr::integer(input)),
        "retries" => retries.set(key, attr::integer(input)),
        _ => Ok(Item::Unknown),
    })?;
    errors.into_result()?;
    match (timeout_ms.get(), retries.get()) {
        (Some(&timeout_ms), Some(&retries)) => Ok(Ack {
            timeout_ms,
            retries,
        }),
        _ => Err(syn::Error::new(
            parentheses.span.join(),
            "expected `timeout_ms = …` and `retries = …`",
        )),
    }
}

/// Returns the error of a missing attribute, with an example.
fn missing(key: &str, example: &str) -> String {
    format!("`{key}` is missing: `#[fc({key} = {example})]`")
}

/// Writes `Command`, or errors and a stub.
pub fn expand_command(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let operation = Operation::read(input, &mut errors);
    let runtime = attr::runtime(operation.runtime);
    let ident = &input.ident;
    let code = operation
        .code
        .required(&mut errors, ident, &missing("code", "0x0A03"));
    let name = operation
        .name
        .required(&mut errors, ident, &missing("name", "\"get_station\""));
    let effect = operation
        .effect
        .required(&mut errors, ident, &missing("effect", "\"read\""));
    let response = operation.response.required(
        &mut errors,
        ident,
        &missing("response", "GetStationResponse"),
    );
    if let Some(key) = operation.ack.key() {
        errors.at(key, "`ack` is for reports; a command is answered");
    }
    let states = [operation.state.key(), operation.failure.key()];
    for key in states.into_iter().flatten() {
        errors.at(key, "what says how far a process has come is a report");
    }
    let set_off = operation.sets_off.get().map(Vec::as_slice);
    let set_off = process::set_off(&runtime, ident, set_off.unwrap_or_default());
    let error = match operation.error.get() {
        None => quote!(#runtime::Undeclared),
        Some(error) => quote!(#error),
    };
    let mut states = TokenStream::new();
    for States { ty, variants } in operation.accepted_in.get().map_or(&[][..], Vec::as_slice) {
        states.extend(quote! {
            #[automatically_derived]
            impl #runtime::AcceptedIn<#ty> for #ident {
                const STATES: &'static [#ty] = &[#(#ty::#variants),*];
            }
        });
    }
    let effect = effect.map_or_else(|| quote!(Read), ToTokens::to_token_stream);
    let response = response.map_or_else(
        || quote!(#runtime::message::Empty),
        ToTokens::to_token_stream,
    );
    let write = |code: TokenStream, name: TokenStream| {
        quote! {
            #states

            #[automatically_derived]
            impl #runtime::Command for #ident {
                type Response = #response;
                type Error = #error;
                const CODE: ::core::primitive::u16 = #code;
                const NAME: &'static ::core::primitive::str = #name;
                const EFFECT: #runtime::Effect = #runtime::Effect::#effect;
            }

            #set_off
        }
    };
    errors.finish(
        || write(generated(code), quote!(#name)),
        || write(quote!(0), quote!("")),
    )
}

/// Writes `Report`, or errors and a stub.
pub fn expand_report(input: &DeriveInput, mut errors: Errors) -> TokenStream {
    let operation = Operation::read(input, &mut errors);
    let runtime = attr::runtime(operation.runtime);
    let ident = &input.ident;
    let code = operation
        .code
        .required(&mut errors, ident, &missing("code", "0x0B01"));
    let name = operation.name.required(
        &mut errors,
        ident,
        &missing("name", "\"recharge_progress\""),
    );
    if let Some(key) = operation.effect.key() {
        errors.at(key, "`effect` is for commands");
    }
    if let Some(key) = operation.response.key() {
        errors.at(key, "`response` is for commands; a report is acknowledged");
    }
    if let Some(key) = operation.error.key() {
        errors.at(key, "`error` is for commands; a report is acknowledged");
    }
    if let Some(key) = operation.accepted_in.key() {
        errors.at(key, "`accepted_in` is for commands");
    }
    if let Some(key) = operation.sets_off.key() {
        errors.at(
            key,
            "`sets_off` is for commands; a report is what is set off",
        );
    }
    let failures = operation.failure.get().map(Vec::as_slice);
    let process = process::stage(
        &runtime,
        operation.state.get(),
        failures.unwrap_or_default(),
    );
    let ack = match operation.ack.get() {
        None => quote!(::core::option::Option::None),
        Some(Ack {
            timeout_ms,
            retries,
        }) => quote! {
            ::core::option::Option::Some(#runtime::AckPolicy {
                timeout: ::core::time::Duration::from_millis(#timeout_ms),
                retries: #retries,
            })
        },
    };
    let write = |code: TokenStream, name: TokenStream| {
        quote! {
            #[automatically_derived]
            impl #runtime::Report for #ident {
                const CODE: ::core::primitive::u16 = #code;
                const NAME: &'static ::core::primitive::str = #name;
                const ACK: ::core::option::Option<#runtime::AckPolicy> = #ack;

                #process
            }
        }
    };
    errors.finish(
        || write(generated(code), quote!(#name)),
        || write(quote!(0), quote!("")),
    )
}
