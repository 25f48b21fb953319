//! An enum of values with its attributes.

use crate::attr::{self, Item, Scalar, Slot};
use crate::errors::Errors;
use crate::item;
use quote::ToTokens;
use std::collections::HashSet;
use syn::parse::{Parse as _, ParseStream};
use syn::{DeriveInput, Fields, Ident, Path, Token, Variant};

/// An enum with `#[derive(OpenEnum)]`.
pub struct OpenEnum<'a> {
    /// Its name.
    pub ident: &'a Ident,
    /// Path of the runtime crate.
    pub runtime: Path,
    /// The wire type.
    pub repr: Repr,
    /// The order of values.
    pub order: Option<Order>,
    /// Variants with a value, as written.
    pub values: Vec<(&'a Ident, Scalar)>,
    /// States of the variants with a value, in the same order.
    pub states: Vec<State>,
    /// Variants that keep an unknown value; at most one is allowed.
    pub other: Vec<&'a Ident>,
}

/// The order of values.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// The normal order; other changes may occur.
    Normal,
    /// The complete order; no other change occurs.
    Complete,
}

/// A variant as the state of a process.
#[derive(Default)]
pub struct State {
    /// Variants that may follow it.
    pub then: Vec<Ident>,
    /// `true` for a final state.
    pub is_final: bool,
    /// `true` for a failure.
    pub is_error: bool,
}

/// The wire type.
pub enum Repr {
    /// An integer type with its smallest and largest value.
    Int(Ident, i128, i128),
    /// A string.
    Str,
}

impl<'a> OpenEnum<'a> {
    /// Reads the enum and its attributes.
    pub fn read(input: &'a DeriveInput, errors: &mut Errors) -> Self {
        let mut repr = Slot::default();
        let mut order = Slot::default();
        let runtime = item::read_attributes(input, errors, "an enum", &mut |key, input| match key
            .to_string()
            .as_str()
        {
            "repr" => repr.set(key, read_repr(input)),
            "order" => order.set(key, read_order(input)),
            _ => Ok(Item::Unknown),
        });
        let message = "what travels must be given: `#[fc(repr = u8)]` or `#[fc(repr = str)]`";
        let readable = repr.required(errors, &input.ident, message).is_some();
        let mut this = Self {
            ident: &input.ident,
            runtime,
            repr: repr.into_value().unwrap_or(Repr::Str),
            order: order.into_value(),
            values: Vec::new(),
            states: Vec::new(),
            other: Vec::new(),
        };
        item::forbid_parameters(&input.generics, errors, "an enum of values");
        let hint = "; a struct is a `Message`";
        if let Some(variants) = item::variants(input, errors, "`OpenEnum` is for enums", hint) {
            for variant in variants {
                this.add(variant, readable, errors);
            }
        }
        this
    }

    fn add(&mut self, variant: &'a Variant, readable: bool, errors: &mut Errors) {
        let mut value = Slot::default();
        let mut other = Slot::default();
        let mut then = Slot::default();
        let mut is_final = Slot::default();
        let mut is_error = Slot::default();
        attr::read(
            &variant.attrs,
            errors,
            "a variant",
            &mut |key, input| match key.to_string().as_str() {
                "value" => value.set(key, read_value(input)),
                "other" => other.set(key, Ok(())),
                "then" => then.set(key, read_names(input)),
                "final" => is_final.set(key, Ok(())),
                "error" => is_error.set(key, Ok(())),
                _ => Ok(Item::Unknown),
            },
        );
        if let Some((_, tokens)) = &variant.discriminant {
            errors.on(tokens, "the value stands in `#[fc(value = …)]`");
        }
        if let Some(other) = other.key() {
            if value.key().is_some() {
                errors.at(other, "the variant `other` has no value of its own");
            }
            let said = [then.key(), is_final.key(), is_error.key()];
            if let Some(said) = said.into_iter().flatten().next() {
                errors.at(said, "of unknown values nothing is said as states");
            }
            self.check_payload(variant, readable, errors);
            self.other.push(&variant.ident);
            return;
        }
        let message = "the variant needs `#[fc(value = …)]` or `#[fc(other)]`";
        value.required(errors, &variant.ident, message);
        if !matches!(variant.fields, Fields::Unit) {
            errors.on(&variant.fields, "a variant with a value holds nothing");
        }
        if let Some(value) = value.into_value() {
            if readable {
                self.repr.check(&value, errors);
            }
            self.values.push((&variant.ident, value));
            self.states.push(State {
                is_final: is_final.key().is_some(),
                is_error: is_error.key().is_some(),
                then: then.into_value().unwrap_or_default(),
            });
        }
    }

    /// Checks the payload of the variant `other`.
    fn check_payload(&self, variant: &Variant, readable: bool, errors: &mut Errors) {
        let wanted = match &self.repr {
            Repr::Int(int, ..) => int.to_string(),
            Repr::Str => "String".to_owned(),
        };
        let payload = item::payload(&variant.fields);
        let name = payload.and_then(item::last_name);
        if readable && name.is_none_or(|name| *name != wanted) {
            let place: &dyn ToTokens = match payload {
                Some(ty) => ty,
                None => item::place(variant),
            };
            errors.on(
                place,
                format!("the variant `other` holds the value: `({wanted})`"),
            );
        }
    }

    /// Reports all conflicts between variants.
    pub fn check(&self, errors: &mut Errors) {
        for other in self.other.iter().skip(1) {
            errors.on(
                other,
                "unknown values are kept by one variant; `other` is given twice",
            );
        }
        for name in self.states.iter().flat_map(|state| &state.then) {
            if self.order.is_none() {
                errors.on(name, "what follows needs `order` on the enum: `order = \"normal\"` or `order = \"complete\"`");
            }
            if !self.values.iter().any(|(known, _)| *known == name) {
                errors.on(name, "no variant with a value has this name");
            }
        }
        let mut seen = HashSet::new();
        for (_, value) in &self.values {
            if !seen.insert(&value.text) {
                errors.on(&value.tokens, "another variant has this value");
            }
        }
    }
}

impl Repr {
    fn check(&self, value: &Scalar, errors: &mut Errors) {
        let message = match (self, value.number) {
            (Self::Str, None) => return,
            (Self::Str, Some(_)) => "the value must be a string, as `repr` says".to_owned(),
            (Self::Int(..), None) => "the value must be an integer, as `repr` says".to_owned(),
            (Self::Int(_, min, max), Some(number)) if (*min..=*max).contains(&number) => return,
            (Self::Int(name, min, max), Some(_)) => {
                format!("the value must fit `{name}`: from {min} to {max}")
            }
        };
        errors.on(&value.tokens, message);
    }
}

/// Reads `= u8` or `= str`.
fn read_repr(input: ParseStream<'_>) -> syn::Result<Repr> {
    input.parse::<Token![=]>()?;
    let name: Ident = input.parse()?;
    let range = |min: i128, max: i128| Ok(Repr::Int(name.clone(), min, max));
    match name.to_string().as_str() {
        "i8" => range(i8::MIN.into(), i8::MAX.into()),
        "i16" => range(i16::MIN.into(), i16::MAX.into()),
        "i32" => range(i32::MIN.into(), i32::MAX.into()),
        "i64" => range(i64::MIN.into(), i64::MAX.into()),
        "u8" => range(0, u8::MAX.into()),
        "u16" => range(0, u16::MAX.into()),
        "u32" => range(0, u32::MAX.into()),
        "u64" => range(0, u64::MAX.into()),
        "str" => Ok(Repr::Str),
        _ => Err(syn::Error::new_spanned(
            name,
            "expected `str` or an integer type from `i8` to `u64`",
        )),
    }
}

/// Reads `= "normal"` or `= "complete"`.
fn read_order(input: ParseStream<'_>) -> syn::Result<Order> {
    let words = [("normal", Order::Normal), ("complete", Order::Complete)];
    attr::word(input, &words).map(|(_, order)| order)
}

/// Reads `(Ready, Done)`.
fn read_names(input: ParseStream<'_>) -> syn::Result<Vec<Ident>> {
    attr::listed(input, "expected a variant", Ident::parse)
}

/// Reads `= 4` or `= "gate"`.
fn read_value(input: ParseStream<'_>) -> syn::Result<Scalar> {
    input.parse::<Token![=]>()?;
    attr::scalar(input, "expected an integer or a string")
}
