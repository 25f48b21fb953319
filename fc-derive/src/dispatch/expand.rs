//! The code of a service.

use super::ast::{Method, Options, Service};
use super::declaration::declaration;
use super::partial;
use super::valid::{Range, Roles};
use crate::codes::distinct;
use crate::span::{generated, span_of};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use syn::{Ident, Visibility};

/// Returns the trait with `Send` futures and its service.
pub fn code(options: &Options, service: &Service, roles: &Roles<'_>) -> TokenStream {
    let Options {
        runtime,
        protocol,
        service: name,
        partial,
    } = options;
    let declaration = declaration(service);
    let partial_code = partial
        .as_ref()
        .map(|partial| partial::code(options, service, partial));
    let Service {
        ident: complete,
        visibility,
        ..
    } = service;
    // The served trait. Every complete service is also a partial one.
    let ident = partial.as_ref().unwrap_or(complete);

    // Calls by full path, because a method may have the name of one of `Arc`.
    let call = |name: &Ident| quote_spanned!(span_of(name)=> <T as #ident>::#name);
    let requests: Vec<_> = roles
        .commands
        .iter()
        .filter_map(|method| Some((method, method.types.get(1)?)))
        .collect();
    let codes: Vec<_> = requests
        .iter()
        .map(
            |(_, request)| quote_spanned!(span_of(request)=> <#request as #runtime::Command>::CODE),
        )
        .collect();
    let distinct = distinct(
        runtime,
        &codes,
        requests.iter().map(|(method, _)| span_of(&method.ident)),
    );
    let commands = requests
        .iter()
        .zip(&codes)
        .map(|((method, request), code)| {
            let name = &method.ident;
            let call = call(name);
            quote_spanned! {span_of(name)=>
                #code => {
                    let service = ::std::sync::Arc::clone(&self.0);
                    request.handle::<#request, _, _>(move |context, request| async move {
                        #call(&service, context, request).await
                    })
                }
            }
        });
    let raw = |method: &Method| {
        let name = &method.ident;
        let call = call(name);
        quote_spanned! {span_of(name)=> {
            let service = ::std::sync::Arc::clone(&self.0);
            request.handle_raw(move |context, request| async move {
                #call(&service, context, request).await
            })
        }}
    };
    let ranges = roles.ranges.iter().map(|(method, Range { first, last })| {
        let handle = raw(method);
        let (first, last) = (generated(first), generated(last));
        quote!(#first..=#last => #handle)
    });
    let unknown = raw(roles.unknown);
    let service_type = service_type(visibility, name.as_ref(), ident);
    quote! {
        #declaration

        #partial_code

        #distinct

        #service_type

        #[automatically_derived]
        impl<T> #runtime::Service<#protocol> for #name<T>
        where
            T: #ident + ::core::marker::Send + ::core::marker::Sync + 'static,
        {
            fn call(&self, request: #runtime::Request<'_, #protocol>) -> #runtime::Handling {
                match request.code() {
                    #(#commands)*
                    #(#ranges)*
                    _ => #unknown
                }
            }
        }
    }
}

/// Returns the type of the service with its constructors.
fn service_type(visibility: &Visibility, name: Option<&Ident>, ident: &Ident) -> TokenStream {
    let docs = format!("Serves a [`{ident}`]: hands each request to the method of its command.");
    quote! {
        #[doc = #docs]
        #visibility struct #name<T>(::std::sync::Arc<T>);

        impl<T: #ident> #name<T> {
            /// Serves `service`.
            #[must_use]
            #visibility fn new(service: T) -> Self {
                Self(::std::sync::Arc::new(service))
            }

            /// Serves a service that is used elsewhere too.
            #[must_use]
            #visibility fn shared(service: ::std::sync::Arc<T>) -> Self {
                Self(service)
            }
        }

        #[automatically_derived]
        impl<T> ::core::clone::Clone for #name<T> {
            fn clone(&self) -> Self {
                Self(::std::sync::Arc::clone(&self.0))
            }
        }

        #[automatically_derived]
        impl<T> ::core::fmt::Debug for #name<T> {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                f.write_str(::core::stringify!(#name))
            }
        }
    }
}
