//! A message with its attributes.

use super::condition::{self, Asked};
use super::constraint::Constraints;
use crate::attr::{self, Item, Slot};
use crate::errors::Errors;
use crate::item;
use proc_macro2::{Span, TokenStream};
use quote::format_ident;
use syn::ext::IdentExt as _;
use syn::parse::{Parse, ParseStream};
use syn::{DeriveInput, Fields, Generics, Ident, LitStr, Path, Type, Visibility};

/// A struct with `#[derive(Message)]`.
pub struct Message<'a> {
    /// Its name.
    pub ident: &'a Ident,
    /// Visibility.
    pub vis: &'a Visibility,
    /// Generic parameters, which a message must not have.
    pub generics: &'a Generics,
    /// Path of the runtime crate.
    pub runtime: Path,
    /// `example`.
    pub example: Slot<LitStr>,
    /// Fields with keys, in the order in which they are sent.
    pub fields: Vec<Field<'a>>,
    /// Fields that keep unknown keys; at most one is allowed.
    pub extra: Vec<(&'a Ident, &'a Type)>,
}

/// A field with a key.
pub struct Field<'a> {
    /// Its name.
    pub ident: &'a Ident,
    /// Its type.
    pub ty: &'a Type,
    /// Its key on the wire.
    pub key: String,
    /// Position of the key.
    pub key_span: Span,
    /// Other attributes.
    pub attributes: FieldAttributes,
}

/// The attributes of a field.
#[derive(Default)]
pub struct FieldAttributes {
    /// `key = "…"`.
    pub key: Slot<LitStr>,
    /// `also("…", …)`.
    pub also: Slot<Vec<LitStr>>,
    /// `wire = "…"`.
    pub wire: Slot<WireForm>,
    /// The form of `lenient(…)`.
    pub lenient: Slot<Ident>,
    /// `empty_is_absent`.
    pub empty_is_absent: Slot<()>,
    /// Constraints.
    pub constraints: Constraints,
    /// `when(…)`.
    pub when: Slot<Vec<Asked>>,
    /// `unless(…)`.
    pub unless: Slot<Vec<Asked>>,
    /// `sensitive`.
    sensitive: Slot<()>,
    /// `extra`.
    extra: Slot<()>,
}

/// A wire form other than that of the type.
#[derive(Clone, Copy)]
pub enum WireForm {
    /// `wire = "string"`.
    String,
    /// `wire = "number"`.
    Number,
}

impl<'a> Message<'a> {
    /// Reads the struct and its attributes.
    pub fn read(input: &'a DeriveInput, errors: &mut Errors) -> Self {
        let mut example = Slot::default();
        let runtime =
            item::read_attributes(input, errors, "a message", &mut |key, input| match key
                .to_string()
                .as_str()
            {
                "example" => example.set(key, attr::text(input)),
                "code" | "name" | "effect" | "response" | "error" | "ack" | "accepted_in"
                | "envelope" | "sets_off" | "state" | "failure" => Ok(Item::Foreign),
                _ => Ok(Item::Unknown),
            });
        let mut message = Self {
            ident: &input.ident,
            vis: &input.vis,
            generics: &input.generics,
            runtime,
            example,
            fields: Vec::new(),
            extra: Vec::new(),
        };
        let hint = "; a choice of messages is `OneOf`, a choice of values `OpenEnum`";
        match item::fields(input, errors, "a message is a struct", hint) {
            Some(Fields::Named(fields)) => {
                for field in &fields.named {
                    message.add(field, errors);
                }
            }
            Some(Fields::Unnamed(fields)) => {
                errors.on(fields, "the fields of a message have names");
            }
            Some(Fields::Unit) | None => {}
        }
        message
    }

    fn add(&mut self, field: &'a syn::Field, errors: &mut Errors) {
        let Some(ident) = &field.ident else { return };
        let attributes = FieldAttributes::read(field, errors);
        if let Some(extra) = attributes.extra.key() {
            if attributes.says_more_than_extra() {
                errors.at(
                    extra,
                    "`extra` keeps all unknown keys; nothing else can be said of it",
                );
            }
            self.extra.push((ident, &field.ty));
            return;
        }
        let (key, key_span) = match attributes.key.get() {
            Some(literal) => (literal.value(), literal.span()),
            None => (ident.unraw().to_string(), ident.span()),
        };
        self.fields.push(Field {
            ident,
            ty: &field.ty,
            key,
            key_span,
            attributes,
        });
    }
}

impl FieldAttributes {
    fn read(field: &syn::Field, errors: &mut Errors) -> Self {
        let mut this = Self::default();
        attr::read(
            &field.attrs,
            errors,
            "a message's field",
            &mut |key, input| this.item(key, input),
        );
        this
    }

    fn item(&mut self, key: &Ident, input: ParseStream<'_>) -> syn::Result<Item> {
        match key.to_string().as_str() {
            "key" => self.key.set(key, attr::text(input)),
            "also" => self.also.set(key, literals(input)),
            "wire" => self.wire.set(key, wire_form(input)),
            "lenient" => self.lenient.set(key, lenient(input)),
            "empty_is_absent" => self.empty_is_absent.set(key, Ok(())),
            "when" => self.when.set(key, condition::read(input)),
            "unless" => self.unless.set(key, condition::read(input)),
            "sensitive" => self.sensitive.set(key, Ok(())),
            "extra" => self.extra.set(key, Ok(())),
            "default" | "role" => Ok(Item::Foreign),
            _ => self.constraints.read(key, input),
        }
    }

    fn says_more_than_extra(&self) -> bool {
        !self.constraints.is_empty()
            || self.key.get().is_some()
            || self.also.get().is_some()
            || self.wire.get().is_some()
            || self.lenient.get().is_some()
            || self.empty_is_absent.get().is_some()
            || self.when.get().is_some()
            || self.unless.get().is_some()
    }
}

/// Reads `("a", "b")`.
fn literals(input: ParseStream<'_>) -> syn::Result<Vec<LitStr>> {
    attr::listed(input, "expected a key in quotes", <LitStr as Parse>::parse)
}

/// Reads `= "string"` or `= "number"`.
fn wire_form(input: ParseStream<'_>) -> syn::Result<WireForm> {
    let words = [("string", WireForm::String), ("number", WireForm::Number)];
    attr::word(input, &words).map(|(_, form)| form)
}

/// Reads `(number)` or `(bool)`. Returns the name of the form in the runtime.
fn lenient(input: ParseStream<'_>) -> syn::Result<Ident> {
    let content;
    syn::parenthesized!(content in input);
    let word: Ident = content.parse()?;
    // Read the rest here, because a leftover would be reported separately.
    let rest: TokenStream = content.parse()?;
    match word.to_string().as_str() {
        _ if !rest.is_empty() => Err(syn::Error::new_spanned(rest, "expected `)`")),
        "number" => Ok(format_ident!("LenientNumber")),
        "bool" => Ok(format_ident!("LenientBool")),
        _ => Err(syn::Error::new(word.span(), "expected `number` or `bool`")),
    }
}
