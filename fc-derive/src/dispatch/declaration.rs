//! The declaration of a service: the trait as written, with `Send` futures.

use super::ast::{Method, Service};
use crate::span::span_of;
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};

/// Returns the trait with `Send` futures.
pub fn declaration(service: &Service) -> TokenStream {
    let Service {
        attributes,
        visibility,
        trait_token,
        ident,
        bounds,
        methods,
    } = service;
    let methods = methods.iter().map(method);
    quote! {
        #(#attributes)*
        #visibility #trait_token #ident #bounds {
            #(#methods)*
        }
    }
}

/// Returns a method with a `Send` future, which `async fn` would not guarantee.
pub fn method(method: &Method) -> TokenStream {
    let Method {
        attributes,
        ident,
        arguments,
        body,
        ..
    } = method;
    let output = output(method);
    let body = body
        .as_ref()
        .map_or_else(|| quote!(;), |body| quote!({ async move #body }));
    quote_spanned! {span_of(ident)=>
        #(#attributes)*
        fn #ident(#arguments) -> impl ::core::future::Future<Output = #output> + ::core::marker::Send
        #body
    }
}

pub fn output(method: &Method) -> TokenStream {
    let output = method.output.as_ref();
    output.map_or_else(|| quote!(()), |output| quote!(#output))
}
