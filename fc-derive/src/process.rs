//! Attributes about processes: the reports that a command sets off, and the state in a report.

use crate::attr;
use proc_macro2::TokenStream;
use quote::quote;
use syn::parse::{Parse, ParseStream};
use syn::{Ident, Path, Token, Type, token};

/// The path to a field inside a message, such as `data?.status`. `?` marks an optional field.
pub struct Way(Vec<(Ident, bool)>);

impl Parse for Way {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let mut steps = Vec::new();
        loop {
            let field = input.parse()?;
            let optional = input.parse::<Option<Token![?]>>()?.is_some();
            steps.push((field, optional));
            if input.parse::<Option<Token![.]>>()?.is_none() {
                return Ok(Self(steps));
            }
        }
    }
}

impl Way {
    /// Returns the value at its end, as an `Option` of a reference.
    fn within(&self, message: &TokenStream) -> TokenStream {
        let steps = self.0.iter().map(|(field, optional)| {
            let step = quote!(.map(|it| &it.#field));
            if *optional {
                quote!(#step.and_then(::core::option::Option::as_ref))
            } else {
                step
            }
        });
        quote!(::core::option::Option::Some(#message)#(#steps)*)
    }
}

/// The field with the state of a report, and its type: `data.status: Status`.
pub struct StateAt {
    way: Way,
    ty: Type,
}

impl Parse for StateAt {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let way = input.parse()?;
        input.parse::<Token![:]>()?;
        let ty = input.parse()?;
        Ok(Self { way, ty })
    }
}

/// A field of the command and a field of the report with the same value: `response.job = job`.
struct Tie {
    /// The message of the command in which the link begins.
    message: TokenStream,
    command: Way,
    report: Way,
}

impl Parse for Tie {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let word: Ident = input.parse()?;
        let message = match word.to_string().as_str() {
            "request" => quote!(self),
            "response" => quote!(answer),
            _ => {
                let message = "expected `request` or `response`";
                return Err(syn::Error::new_spanned(word, message));
            }
        };
        input.parse::<Token![.]>()?;
        let command = input.parse()?;
        input.parse::<Token![=]>()?;
        let report = input.parse()?;
        Ok(Self {
            message,
            command,
            report,
        })
    }
}

/// A report that a command sets off, and its links: `SwitchMoved(response.job = job)`.
pub struct SetOff {
    report: Path,
    ties: Vec<Tie>,
}

impl Parse for SetOff {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let report = input.call(Path::parse_mod_style)?;
        let ties = if input.peek(token::Paren) {
            attr::listed(input, "expected a tie", Tie::parse)?
        } else {
            Vec::new()
        };
        Ok(Self { report, ties })
    }
}

/// Reads `(RechargeProgress, SwitchMoved(response.job = job))`.
pub fn sets_off(input: ParseStream<'_>) -> syn::Result<Vec<SetOff>> {
    attr::listed(input, "expected a report", SetOff::parse)
}

/// Reads `(data.status: Status)`.
pub fn state(input: ParseStream<'_>) -> syn::Result<StateAt> {
    let content;
    syn::parenthesized!(content in input);
    let state = content.parse()?;
    if content.is_empty() {
        Ok(state)
    } else {
        Err(content.error("one field has the state"))
    }
}

/// Reads `(data.error, warning?)`.
pub fn ways(input: ParseStream<'_>) -> syn::Result<Vec<Way>> {
    attr::listed(input, "expected a field", Way::parse)
}

/// Implements `SetsOff` for each report.
pub fn set_off(runtime: &Path, command: &Ident, set_off: &[SetOff]) -> TokenStream {
    let impls = set_off.iter().map(|SetOff { report, ties }| {
        let tests = ties.iter().map(|tie| {
            let command = tie.command.within(&tie.message);
            let report = tie.report.within(&quote!(report));
            // An absent field cannot distinguish calls.
            quote! {
                match (#command, #report) {
                    (::core::option::Option::Some(here), ::core::option::Option::Some(there)) => here == there,
                    _ => true,
                }
            }
        });
        let test = (!ties.is_empty()).then(|| {
            quote! {
                fn has_set_off(&self, answer: &Self::Response, report: &#report) -> ::core::primitive::bool {
                    let _ = answer;
                    #(#tests)&&*
                }
            }
        });
        quote! {
            #[automatically_derived]
            impl #runtime::SetsOff<#report> for #command {
                #test
            }
        }
    });
    quote!(#(#impls)*)
}

/// Returns the items of `Report` about the process.
pub fn stage(runtime: &Path, state: Option<&StateAt>, failures: &[Way]) -> TokenStream {
    let ty = state.map_or_else(
        || quote!(#runtime::Stateless),
        |StateAt { ty, .. }| quote!(#ty),
    );
    let state = state.map(|StateAt { way, .. }| {
        let way = way.within(&quote!(self));
        quote! {
            fn state(&self) -> ::core::option::Option<Self::State> {
                #way.cloned()
            }
        }
    });
    let failure = (!failures.is_empty()).then(|| {
        let own = state.as_ref().map(|_| {
            quote! {
                #runtime::Report::state(self)
                    .is_some_and(|state| #runtime::State::says_failed(&state)) ||
            }
        });
        let failures = failures.iter().map(|way| way.within(&quote!(self)));
        quote! {
            fn is_failure(&self) -> ::core::primitive::bool {
                #own #(#failures.is_some_and(#runtime::State::says_failed))||*
            }
        }
    });
    quote! {
        type State = #ty;

        #state
        #failure
    }
}
