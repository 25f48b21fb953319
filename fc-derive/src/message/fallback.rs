//! What stands in for a message with faults.

use super::ast::Message;
use proc_macro2::TokenStream;
use quote::quote;

/// Implementations that do nothing, for a message with faults.
pub fn stub(message: &Message<'_>) -> TokenStream {
    // With parameters it would need bounds that the struct may not have.
    if !message.generics.params.is_empty() {
        return TokenStream::new();
    }
    let Message { ident, runtime, .. } = message;
    let error = quote!(#runtime::json::BodyError);
    let reader = quote!(#runtime::json::Reader<'_>);
    let result = quote!(::core::result::Result);
    let todo = quote!(::core::unimplemented!());
    quote! {
        #[automatically_derived]
        impl #runtime::json::FromJson for #ident {
            fn read(_: &mut #reader) -> #result<Self, #error> { #todo }
        }

        #[automatically_derived]
        impl #runtime::json::ToJson for #ident {
            fn write(&self, _: &mut #runtime::json::Writer<'_>) { #todo }
        }

        #[automatically_derived]
        impl #runtime::message::Message for #ident {
            type Partial = ();
            const KEYS: &'static [#runtime::message::Key] = &[];
            fn read_in_order(_: &mut (), _: &mut #reader) -> #result<(), #error> { #todo }
            fn read_field(
                _: &mut (),
                _: &::core::primitive::str,
                _: &mut #reader,
            ) -> #result<::core::primitive::bool, #error> { #todo }
            fn read_unknown(
                _: &mut (),
                _: &::core::primitive::str,
                _: &mut #reader,
            ) -> #result<(), #error> { #todo }
            fn finish(_: ()) -> #result<Self, #error> { #todo }
            fn write_fields(&self, _: &mut #runtime::json::ObjectWriter<'_>) { #todo }
        }
    }
}
