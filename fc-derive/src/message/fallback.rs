//! The stub of a message with errors.

use super::ast::Message;
use proc_macro2::TokenStream;
use quote::quote;

/// Returns implementations that do nothing, for a message with errors.
pub fn stub(message: &Message<'_>) -> TokenStream {
    // With generic parameters, it would need bounds that the struct may not have.
    if !message.generics.params.is_empty() {
        return TokenStream::new();
    }
    let Message { ident, runtime, .. } = message;
    let todo = quote!(::core::unimplemented!());
    quote! {
        #[automatically_derived]
        impl #runtime::message::Message for #ident {
            type Slots = ();
            fn slots() {}
            fn read_fields(_: &mut (), _: &mut #runtime::json::Reader<'_>) { #todo }
            fn finish(_: ()) -> ::core::option::Option<Self> { #todo }
            fn write_fields(&self, _: &mut #runtime::json::ObjectWriter<'_>) { #todo }
        }
    }
}
