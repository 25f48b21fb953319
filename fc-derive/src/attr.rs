//! The grammar of `#[fc(…)]`: `key`, `key = value`, `key(values)`, separated by commas.

use crate::errors::Errors;
use proc_macro2::{Span, TokenStream, TokenTree};
use quote::{ToTokens, quote};
use std::fmt::Display;
use std::str::FromStr;
use syn::ext::IdentExt as _;
use syn::parse::{Parse, ParseStream};
use syn::{Attribute, Ident, LitFloat, LitInt, LitStr, Path, Token, parenthesized, parse_quote};

/// Name of the attribute.
pub const NAME: &str = "fc";

/// The result of reading a key.
pub enum Item {
    /// Its value has been read.
    Read,
    /// Another derive reads it.
    Foreign,
    /// No derive reads it.
    Unknown,
}

/// Reads the value of a key.
// Dynamic, because a type parameter would compile the parser again for every macro, and every user of messages waits
// for that.
pub type ItemReader<'r> = dyn FnMut(&Ident, ParseStream<'_>) -> syn::Result<Item> + 'r;

/// Reads every key of every `#[fc(…)]` in `attributes` with `item`, which gets the key before its value. After an error
/// it continues after the next comma.
pub fn read(attributes: &[Attribute], errors: &mut Errors, place: &str, item: &mut ItemReader<'_>) {
    for attribute in attributes {
        if attribute.path().is_ident(NAME) {
            let result = attribute
                .parse_args_with(|input: ParseStream<'_>| read_items(input, errors, place, item));
            errors.ok(result);
        }
    }
}

/// Reads a key with `value`. Another derive reads all other keys and reports unknown ones.
pub fn read_own<T>(
    attributes: &[Attribute],
    errors: &mut Errors,
    own: &str,
    value: fn(ParseStream<'_>) -> syn::Result<T>,
) -> Slot<T> {
    let mut slot = Slot::default();
    read(attributes, errors, "a field", &mut |key, input| {
        if key == own {
            slot.set(key, value(input))
        } else {
            Ok(Item::Foreign)
        }
    });
    slot
}

/// Reads the keys of one attribute.
pub fn read_items(
    input: ParseStream<'_>,
    errors: &mut Errors,
    place: &str,
    item: &mut ItemReader<'_>,
) -> syn::Result<()> {
    while !input.is_empty() {
        let key = input.call(Ident::parse_any)?;
        match item(&key, input) {
            Ok(Item::Read) if !input.is_empty() && !input.peek(Token![,]) => {
                errors.push(input.error("expected `,`"));
            }
            Ok(Item::Read | Item::Foreign) => {}
            Ok(Item::Unknown) => {
                errors.on(&key, format!("`{key}` is not an attribute of {place}"));
            }
            Err(error) => errors.push(error),
        }
        skip(input)?;
        input.parse::<Option<Token![,]>>()?;
    }
    Ok(())
}

/// Skips to the next comma.
fn skip(input: ParseStream<'_>) -> syn::Result<()> {
    while !input.is_empty() && !input.peek(Token![,]) {
        input.parse::<TokenTree>()?;
    }
    Ok(())
}

/// The value of a key that may be given once.
pub struct Slot<T> {
    key: Option<Span>,
    value: Option<T>,
}

impl<T> Default for Slot<T> {
    fn default() -> Self {
        Self {
            key: None,
            value: None,
        }
    }
}

impl<T> Slot<T> {
    /// Keeps a value. A key with an invalid value counts as given.
    pub fn set(&mut self, key: &Ident, value: syn::Result<T>) -> syn::Result<Item> {
        once(&mut self.key, key)?;
        self.value = Some(value?);
        Ok(Item::Read)
    }

    /// Returns the value if it was given and valid.
    pub fn get(&self) -> Option<&T> {
        self.value.as_ref()
    }

    /// Returns the value if it was given and valid.
    pub fn into_value(self) -> Option<T> {
        self.value
    }

    /// Returns the position of the key if it was given.
    pub fn key(&self) -> Option<Span> {
        self.key
    }

    /// Returns the value. Reports an error at `place` if the key was not given.
    pub fn required(&self, errors: &mut Errors, place: &dyn ToTokens, message: &str) -> Option<&T> {
        if self.key.is_none() {
            errors.on(place, message);
        }
        self.get()
    }
}

/// Notes the position of a key, or reports that it is given twice.
fn once(given: &mut Option<Span>, key: &Ident) -> syn::Result<()> {
    if given.is_some() {
        let message = format!("`{key}` is given twice");
        return Err(syn::Error::new_spanned(key, message));
    }
    *given = Some(key.span());
    Ok(())
}

/// Reads `(…, …)` with `each` for each item. An empty list is an error with the text `none`.
pub fn listed<T>(
    input: ParseStream<'_>,
    none: &str,
    each: fn(ParseStream<'_>) -> syn::Result<T>,
) -> syn::Result<Vec<T>> {
    let content;
    let parentheses = parenthesized!(content in input);
    if content.is_empty() {
        return Err(syn::Error::new(parentheses.span.join(), none));
    }
    let items = content.parse_terminated(each, Token![,])?;
    Ok(items.into_iter().collect())
}

/// Reads `= value`.
pub fn value<T: Parse>(input: ParseStream<'_>) -> syn::Result<T> {
    input.parse::<Token![=]>()?;
    input.parse()
}

/// Reads `= "text"`.
pub fn text(input: ParseStream<'_>) -> syn::Result<LitStr> {
    value(input)
}

/// Reads `= path`.
pub fn path(input: ParseStream<'_>) -> syn::Result<Path> {
    input.parse::<Token![=]>()?;
    input.call(Path::parse_mod_style)
}

/// Reads `= "one of these words"`.
pub fn word<T: Copy>(input: ParseStream<'_>, words: &[(&str, T)]) -> syn::Result<(LitStr, T)> {
    let literal = text(input)?;
    let given = literal.value();
    if let Some((_, value)) = words.iter().find(|(name, _)| *name == given) {
        return Ok((literal, *value));
    }
    let names: Vec<String> = words.iter().map(|(name, _)| format!("{name:?}")).collect();
    let message = format!("expected {}", names.join(" or "));
    Err(syn::Error::new_spanned(literal, message))
}

/// Reads `= 5` as an integer that fits `T`.
pub fn integer<T: FromStr<Err: Display>>(input: ParseStream<'_>) -> syn::Result<T> {
    plain_integer(&value(input)?)
}

/// Returns the value of a literal without suffix.
pub fn plain_integer<T: FromStr<Err: Display>>(literal: &LitInt) -> syn::Result<T> {
    no_suffix(literal, literal.suffix())?;
    if literal.base10_digits().starts_with('-') {
        return Err(syn::Error::new_spanned(
            literal,
            "a number here is not negative",
        ));
    }
    literal.base10_parse()
}

fn no_suffix(literal: impl ToTokens, suffix: &str) -> syn::Result<()> {
    if suffix.is_empty() {
        return Ok(());
    }
    let message = format!("a number here has no suffix `{suffix}`");
    Err(syn::Error::new_spanned(literal, message))
}

/// A number with a sign, as written.
pub struct Number {
    /// Sign and literal.
    pub tokens: TokenStream,
    /// Value.
    pub value: NumberValue,
}

/// A number of an attribute.
#[derive(Clone, Copy)]
pub enum NumberValue {
    /// An integer.
    Int(i128),
    /// A decimal fraction.
    Float(f64),
}

impl Number {
    /// Returns the nearest float.
    #[allow(
        clippy::cast_precision_loss,
        reason = "only for comparing limits with each other"
    )]
    pub fn as_f64(&self) -> f64 {
        match self.value {
            NumberValue::Int(value) => value as f64,
            NumberValue::Float(value) => value,
        }
    }
}

/// Reads `= -0.5`.
pub fn number(input: ParseStream<'_>) -> syn::Result<Number> {
    input.parse::<Token![=]>()?;
    signed(input)
}

/// Reads `-0.5`.
pub fn signed(input: ParseStream<'_>) -> syn::Result<Number> {
    let minus: Option<Token![-]> = input.parse()?;
    let sign = if minus.is_some() { "-" } else { "" };
    if input.peek(LitFloat) {
        let literal: LitFloat = input.parse()?;
        no_suffix(&literal, literal.suffix())?;
        let value: f64 = literal.base10_parse()?;
        return Ok(Number {
            tokens: quote!(#minus #literal),
            value: NumberValue::Float(if minus.is_some() { -value } else { value }),
        });
    }
    if !input.peek(LitInt) {
        return Err(input.error("expected a number"));
    }
    let literal: LitInt = input.parse()?;
    no_suffix(&literal, literal.suffix())?;
    let value = format!("{sign}{}", literal.base10_digits())
        .parse()
        .map_err(|error| syn::Error::new_spanned(&literal, error))?;
    Ok(Number {
        tokens: quote!(#minus #literal),
        value: NumberValue::Int(value),
    })
}

/// An integer or a string, as written.
pub struct Scalar {
    /// Tokens as written.
    pub tokens: TokenStream,
    /// Decimal digits, or the content of the string.
    pub text: String,
    /// `None` for a string.
    pub number: Option<i128>,
}

/// Reads `6` or `"night"`. A decimal fraction is an error with the text `expected`.
pub fn scalar(input: ParseStream<'_>, expected: &str) -> syn::Result<Scalar> {
    if input.peek(LitStr) {
        let literal: LitStr = input.parse()?;
        return Ok(Scalar {
            text: literal.value(),
            tokens: literal.into_token_stream(),
            number: None,
        });
    }
    let Number { tokens, value } = signed(input)?;
    match value {
        NumberValue::Int(number) => Ok(Scalar {
            tokens,
            text: number.to_string(),
            number: Some(number),
        }),
        NumberValue::Float(_) => Err(syn::Error::new_spanned(tokens, expected)),
    }
}

/// Reads `first..=last` of `T`.
pub fn range<T: FromStr<Err: Display> + PartialOrd>(input: ParseStream<'_>) -> syn::Result<(T, T)> {
    let first: LitInt = input.parse()?;
    input.parse::<Token![..=]>()?;
    let last: LitInt = input.parse()?;
    let range = (plain_integer(&first)?, plain_integer(&last)?);
    if range.0 > range.1 {
        return Err(syn::Error::new_spanned(
            last,
            "the range is empty: its end is below its start",
        ));
    }
    Ok(range)
}

/// Returns the path of the runtime crate: `#[fc(crate = path)]`, or `::fc_runtime`.
pub fn runtime(given: Slot<Path>) -> Path {
    given
        .into_value()
        .unwrap_or_else(|| parse_quote!(::fc_runtime))
}
