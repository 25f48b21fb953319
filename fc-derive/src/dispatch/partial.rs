//! A second trait with the same methods for a service that is not complete yet. Its methods refuse by default.

use super::ast::{Method, Options, Service};
use super::declaration::{method, output};
use crate::span::span_of;
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use syn::Ident;

/// Returns the trait with optional methods, and its implementation for complete services.
pub fn code(options: &Options, service: &Service, partial: &Ident) -> TokenStream {
    let Service {
        visibility,
        trait_token,
        ident,
        bounds,
        methods,
        ..
    } = service;
    let optional = methods.iter().map(|method| optional(options, method));
    let forwarded = methods.iter().map(|method| {
        let Method {
            ident: name, types, ..
        } = method;
        let [context, request] = types.as_slice() else {
            return TokenStream::new();
        };
        let output = output(method);
        quote_spanned! {span_of(name)=>
            fn #name(&self, context: #context, request: #request)
                -> impl ::core::future::Future<Output = #output> + ::core::marker::Send
            {
                <T as #ident>::#name(self, context, request)
            }
        }
    });
    let docs = format!(
        "An incomplete [`{ident}`] with the methods of the commands that it implements. All other \
         commands are refused as not implemented, counted and logged. A new command does not break \
         it. When nothing is missing, `impl {ident}` requires every method."
    );
    let message = format!("`{{Self}}` is neither a `{ident}` nor a `{partial}`");
    let note = format!(
        "implement `{ident}`, or `{partial}` as long as some of its commands are not implemented"
    );
    quote! {
        #[doc = #docs]
        #[diagnostic::on_unimplemented(message = #message, note = #note)]
        #visibility #trait_token #partial #bounds {
            #(#optional)*
        }

        impl<T: #ident> #partial for T {
            #(#forwarded)*
        }
    }
}

/// Returns a method that refuses, unless it has a body.
fn optional(options: &Options, method: &Method) -> TokenStream {
    let Options {
        runtime, protocol, ..
    } = options;
    let Method {
        attributes,
        ident,
        types,
        body: None,
        ..
    } = method
    else {
        return self::method(method);
    };
    let [context, request] = types.as_slice() else {
        return TokenStream::new();
    };
    let output = output(method);
    let refusal = if method.role.is_empty() {
        quote!(#runtime::Context::not_implemented(&context))
    } else {
        // For codes without a command in the spec.
        quote!({
            let _ = context;
            #runtime::Refusal::unknown::<#protocol>()
        })
    };
    quote_spanned! {span_of(ident)=>
        #(#attributes)*
        fn #ident(&self, context: #context, _: #request)
            -> impl ::core::future::Future<Output = #output> + ::core::marker::Send
        {
            ::core::future::ready(::core::result::Result::Err(#refusal))
        }
    }
}
