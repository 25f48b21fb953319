//! The code of an enum of values.

use super::ast::{OpenEnum, Order, Repr, State};
use crate::json::{self, Bodies};
use crate::span::generated;
use proc_macro2::{Span, TokenStream};
use quote::quote;
use syn::Ident;

/// Returns values, conversions and wire forms.
pub fn code(choice: &OpenEnum<'_>) -> TokenStream {
    let inherent = inherent(choice);
    let convert = if choice.other.is_empty() {
        try_from(choice)
    } else {
        from(choice)
    };
    let json = implement_json(choice);
    let forms = match &choice.repr {
        Repr::Int(int, ..) => number_forms(choice, int),
        Repr::Str => TokenStream::new(),
    };
    let chosen = chosen(choice);
    let states = states(choice);
    quote!(#inherent #convert #json #forms #chosen #states)
}

/// Returns the methods and the implementation for states, if there are any.
fn states(choice: &OpenEnum<'_>) -> TokenStream {
    let ident = choice.ident;
    let marked = |mark: fn(&State) -> bool| {
        let states = choice.values.iter().zip(&choice.states);
        let names = states.filter(|(_, state)| mark(state));
        let names: Vec<&Ident> = names.map(|((name, _), _)| *name).collect();
        (!names.is_empty()).then(|| quote!(::core::matches!(self, #(Self::#names)|*)))
    };
    let is_final = marked(|state| state.is_final).map(|test| {
        quote! {
            /// Returns `true` if the spec marks this value as final.
            #[must_use]
            pub const fn is_final(&self) -> bool {
                #test
            }
        }
    });
    let is_error = marked(|state| state.is_error).map(|test| {
        quote! {
            /// Returns `true` if the spec marks this value as a failure.
            #[must_use]
            pub const fn is_error(&self) -> bool {
                #test
            }
        }
    });
    let follows = choice.order.map(|order| follows(choice, order));
    let is_said = is_final.is_some() || is_error.is_some() || follows.is_some();
    let state = is_said.then(|| {
        let runtime = &choice.runtime;
        let mark = |is_marked: bool, mark: TokenStream| {
            if is_marked { mark } else { quote!(false) }
        };
        let end = mark(is_final.is_some(), quote!(Self::is_final(self)));
        let failed = mark(is_error.is_some(), quote!(Self::is_error(self)));
        let in_order = in_order(choice, &failed);
        quote! {
            #[automatically_derived]
            impl #runtime::State for #ident {
                fn is_end(&self) -> ::core::primitive::bool {
                    #end
                }

                fn says_failed(&self) -> ::core::primitive::bool {
                    #failed
                }

                fn is_in_order(&self, previous: &Self) -> ::core::primitive::bool {
                    #in_order
                }
            }
        }
    });
    quote! {
        #[automatically_derived]
        impl #ident {
            #is_final
            #is_error
            #follows
        }

        #state
    }
}

/// The expression that checks whether the spec allows `self` after `previous`.
fn in_order(choice: &OpenEnum<'_>, failed: &TokenStream) -> TokenStream {
    let of_order = match choice.order {
        None => {
            return quote!({
                let _ = previous;
                true
            });
        }
        Some(Order::Complete) => quote!(Self::may_follow(self, previous)),
        Some(Order::Normal) => {
            // The spec lists no successors of these values, so any successor is allowed.
            let states = choice.values.iter().zip(&choice.states);
            let silent = states.filter(|(_, state)| state.then.is_empty() && !state.is_final);
            let silent = silent.map(|((name, _), _)| quote!(Self::#name));
            let other = choice.other.first();
            let other = other.map(|name| quote!(Self::#name(_)));
            let free: Vec<TokenStream> = silent.chain(other.clone()).collect();
            let free =
                (!free.is_empty()).then(|| quote!(::core::matches!(previous, #(#free)|*) ||));
            let other = other.map(|other| quote!(::core::matches!(self, #other) ||));
            quote!(#free #other Self::normally_follows(self, previous))
        }
    };
    // Compares the values that are sent: the enum need not be comparable.
    quote!(self.wire() == previous.wire() || #failed || #of_order)
}

/// The method that checks the order of two values.
fn follows(choice: &OpenEnum<'_>, order: Order) -> TokenStream {
    let states = choice.values.iter().zip(&choice.states);
    let arms = states.filter(|(_, state)| !state.then.is_empty());
    let arms = arms
        .map(|((name, _), State { then, .. })| quote!((Self::#name, #(Self::#then)|*) => true,));
    match order {
        Order::Normal => quote! {
            /// Returns `true` if this value follows `previous` in the normal order. Other changes may occur as well.
            #[must_use]
            pub const fn normally_follows(&self, previous: &Self) -> bool {
                match (previous, self) {
                    #(#arms)*
                    _ => false,
                }
            }
        },
        Order::Complete => {
            let other = choice
                .other
                .first()
                .map(|name| quote!((Self::#name(_), _) | (_, Self::#name(_)) => true,));
            quote! {
                /// Returns `true` if the spec lists the change from `previous` to this value. No other change occurs.
                /// A value that is not in the spec may follow and precede any value.
                #[must_use]
                pub const fn may_follow(&self, previous: &Self) -> bool {
                    match (previous, self) {
                        #other
                        #(#arms)*
                        _ => false,
                    }
                }
            }
        }
    }
}

/// Returns the type from which a value is created.
fn source(choice: &OpenEnum<'_>) -> TokenStream {
    match &choice.repr {
        Repr::Int(int, ..) => quote!(::core::primitive::#int),
        Repr::Str => quote!(&::core::primitive::str),
    }
}

/// Returns names and wire values of the variants in the same order.
fn arms(choice: &OpenEnum<'_>) -> (Vec<TokenStream>, Vec<TokenStream>) {
    let names = choice
        .values
        .iter()
        .map(|(name, _)| quote!(Self::#name))
        .collect();
    let wires = choice
        .values
        .iter()
        .map(|(_, value)| generated(&value.tokens))
        .collect();
    (names, wires)
}

/// `VALUES` and `wire`.
fn inherent(choice: &OpenEnum<'_>) -> TokenStream {
    let ident = choice.ident;
    let (names, wires) = arms(choice);
    let other = choice.other.first();
    let (constant, wire, shown) = match (&choice.repr, other) {
        (Repr::Int(int, ..), _) => (
            quote!(const),
            quote!(::core::primitive::#int),
            quote!(*wire),
        ),
        (Repr::Str, None) => (
            quote!(const),
            quote!(&'static ::core::primitive::str),
            quote!(),
        ),
        (Repr::Str, Some(_)) => (quote!(), quote!(&::core::primitive::str), quote!(wire)),
    };
    let other = other.map(|name| quote!(Self::#name(wire) => #shown,));
    quote! {
        #[automatically_derived]
        impl #ident {
            /// Every value of the spec, in its order.
            pub const VALUES: &'static [Self] = &[#(#names),*];

            /// Returns the value on the wire.
            #[must_use]
            pub #constant fn wire(&self) -> #wire {
                match self {
                    #(#names => #wires,)*
                    #other
                }
            }
        }
    }
}

/// Implements `From` for an open enum, which accepts every value.
fn from(choice: &OpenEnum<'_>) -> TokenStream {
    let ident = choice.ident;
    let source = source(choice);
    let (names, wires) = arms(choice);
    let other = choice.other.first();
    let kept = match choice.repr {
        Repr::Int(..) => quote!(wire),
        Repr::Str => quote!(::core::convert::From::from(wire)),
    };
    quote! {
        #[automatically_derived]
        impl ::core::convert::From<#source> for #ident {
            fn from(wire: #source) -> Self {
                match wire {
                    #(#wires => #names,)*
                    _ => Self::#other(#kept),
                }
            }
        }
    }
}

/// Implements `TryFrom` for a closed enum, which rejects unknown values.
fn try_from(choice: &OpenEnum<'_>) -> TokenStream {
    let OpenEnum { ident, runtime, .. } = choice;
    let source = source(choice);
    let (names, wires) = arms(choice);
    // Not `Self::Error`, which may be a variant.
    quote! {
        #[automatically_derived]
        impl ::core::convert::TryFrom<#source> for #ident {
            type Error = #runtime::json::BodyError;

            fn try_from(
                wire: #source,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                match wire {
                    #(#wires => ::core::result::Result::Ok(#names),)*
                    _ => ::core::result::Result::Err(#runtime::json::unknown_value(wire)),
                }
            }
        }
    }
}

/// Reads the enum in a form of its wire type.
fn read(choice: &OpenEnum<'_>, form: &str) -> TokenStream {
    let runtime = &choice.runtime;
    let open = !choice.other.is_empty();
    let function = match (&choice.repr, open) {
        (Repr::Int(..), true) => "open",
        (Repr::Int(..), false) => "closed",
        (Repr::Str, true) => "open_str",
        (Repr::Str, false) => "closed_str",
    };
    let function = Ident::new(function, Span::call_site());
    match &choice.repr {
        Repr::Int(int, ..) => {
            let form = Ident::new(form, Span::call_site());
            quote! {
                #runtime::json::#function::<#runtime::json::#form, ::core::primitive::#int, Self>(reader)
            }
        }
        Repr::Str => quote!(#runtime::json::#function(reader)),
    }
}

/// `FromJson` and `ToJson`.
fn implement_json(choice: &OpenEnum<'_>) -> TokenStream {
    let write = match choice.repr {
        Repr::Int(..) => quote!(integer),
        Repr::Str => quote!(string),
    };
    let bodies = Bodies {
        read: read(choice, "Plain"),
        write: quote!(writer.#write(self.wire());),
        check_value: None,
    };
    json::implement(choice.ident, &choice.runtime, &bodies)
}

/// Implements the trait for the attribute `only(…)` of a field.
fn chosen(choice: &OpenEnum<'_>) -> TokenStream {
    let OpenEnum { ident, runtime, .. } = choice;
    let wire = match &choice.repr {
        Repr::Int(int, ..) => quote!(::core::primitive::#int),
        Repr::Str => quote!(&'static ::core::primitive::str),
    };
    quote! {
        #[automatically_derived]
        impl #runtime::json::Chosen for #ident {
            type Wire = #wire;

            fn all_among(&self, taken: &[#wire]) -> ::core::primitive::bool {
                taken.contains(&self.wire())
            }
        }
    }
}

/// Implements the traits for the attributes `wire = "string"` and `lenient(number)` of a field.
fn number_forms(choice: &OpenEnum<'_>, int: &Ident) -> TokenStream {
    let OpenEnum { ident, runtime, .. } = choice;
    let quoted = read(choice, "Quoted");
    let lenient = read(choice, "LenientNumber");
    quote! {
        #[automatically_derived]
        impl ::core::convert::From<#ident> for ::core::primitive::#int {
            fn from(value: #ident) -> Self {
                value.wire()
            }
        }

        #[automatically_derived]
        impl #runtime::json::Quotable for #ident {
            fn read_quoted(
                reader: &mut #runtime::json::Reader<'_>,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                #quoted
            }

            fn write_quoted(&self, writer: &mut #runtime::json::Writer<'_>) {
                #runtime::json::Quotable::write_quoted(&self.wire(), writer);
            }
        }

        #[automatically_derived]
        impl #runtime::json::ReadLenientNumber for #ident {
            fn read_lenient(
                reader: &mut #runtime::json::Reader<'_>,
            ) -> ::core::result::Result<Self, #runtime::json::BodyError> {
                #lenient
            }
        }
    }
}
