//! Constraints of a field: their attributes, and the checks that they become.

use super::ast::Field;
use crate::attr::{self, Item, Number, NumberValue, Slot};
use crate::errors::Errors;
use crate::span::generated;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::parse::ParseStream;
use syn::{Ident, LitInt, LitStr, Path, Token};

/// The constraints of a field.
#[derive(Default)]
pub struct Constraints {
    /// `min = …`.
    min: Slot<Number>,
    /// `max = …`.
    max: Slot<Number>,
    /// `length = …`.
    length: Slot<(usize, usize)>,
    /// `pattern = "…"`.
    pattern: Slot<LitStr>,
    /// `only(…, …)`.
    only: Slot<Vec<TokenStream>>,
}

impl Constraints {
    /// Reads the attribute of a constraint.
    pub fn read(&mut self, key: &Ident, input: ParseStream<'_>) -> syn::Result<Item> {
        match key.to_string().as_str() {
            "min" => self.min.set(key, attr::number(input)),
            "max" => self.max.set(key, attr::number(input)),
            "length" => self.length.set(key, length(input)),
            "pattern" => self.pattern.set(key, pattern(input)),
            "only" => self.only.set(key, wire_values(input)),
            _ => Ok(Item::Unknown),
        }
    }

    /// Returns `true` without a valid constraint.
    pub fn is_empty(&self) -> bool {
        self.min.get().is_none()
            && self.max.get().is_none()
            && self.length.get().is_none()
            && self.pattern.get().is_none()
            && self.only.get().is_none()
    }

    /// Reports limits that exclude every number.
    pub fn check_limits(&self, errors: &mut Errors) {
        if let (Some(min), Some(max)) = (self.min.get(), self.max.get())
            && min.as_f64() > max.as_f64()
        {
            errors.on(&max.tokens, "no number is possible: `max` is below `min`");
        }
    }

    /// Returns a statement for each constraint, in the order of the spec.
    pub fn checks(&self, runtime: &Path, field: &Field<'_>) -> Vec<TokenStream> {
        let Field { ident, key, ty, .. } = field;
        let mut checks = Vec::new();
        if let Some(min) = self.min.get() {
            let limit = limit(runtime, min);
            checks.push(quote!(#runtime::json::min::<#ty>(#key, &self.#ident, #limit)?;));
        }
        if let Some(max) = self.max.get() {
            let limit = limit(runtime, max);
            checks.push(quote!(#runtime::json::max::<#ty>(#key, &self.#ident, #limit)?;));
        }
        if let Some((least, most)) = self.length.get() {
            let least = Literal::usize_unsuffixed(*least);
            let most = Literal::usize_unsuffixed(*most);
            checks.push(quote! {
                #runtime::json::length::<#ty>(#key, &self.#ident, #least, #most)?;
            });
        }
        if let Some(pattern) = self.pattern.get() {
            checks.push(quote! {{
                static PATTERN: #runtime::json::Pattern = #runtime::json::Pattern::new(#pattern);
                #runtime::json::matches::<#ty>(#key, &self.#ident, &PATTERN)?;
            }});
        }
        if let Some(only) = self.only.get() {
            let taken = only.iter().map(generated);
            checks.push(quote!(#runtime::json::only::<#ty>(#key, &self.#ident, &[#(#taken),*])?;));
        }
        checks
    }
}

fn limit(runtime: &Path, number: &Number) -> TokenStream {
    let tokens = generated(&number.tokens);
    let variant = match number.value {
        NumberValue::Int(_) => format_ident!("Int"),
        NumberValue::Float(_) => format_ident!("Float"),
    };
    quote!(#runtime::json::Limit::#variant(#tokens))
}

/// Reads `= 15` or `= 1..=32`.
fn length(input: ParseStream<'_>) -> syn::Result<(usize, usize)> {
    input.parse::<Token![=]>()?;
    if input.peek2(Token![..]) {
        return attr::range(input);
    }
    let literal: LitInt = input.parse()?;
    let length = attr::plain_integer(&literal)?;
    Ok((length, length))
}

/// Reads `= "regular expression"`.
fn pattern(input: ParseStream<'_>) -> syn::Result<LitStr> {
    let literal = attr::text(input)?;
    match regex_lite::Regex::new(&literal.value()) {
        Ok(_) => Ok(literal),
        Err(error) => Err(syn::Error::new_spanned(literal, error)),
    }
}

/// Reads `(1, 6)` or `("day", "night")`.
fn wire_values(input: ParseStream<'_>) -> syn::Result<Vec<TokenStream>> {
    attr::listed(input, "expected a value of the enum", |input| {
        let value = attr::scalar(input, "expected an integer or a string")?;
        Ok(value.tokens)
    })
}
