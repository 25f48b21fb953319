//! The relevant parts of the trait. Parsing it with `syn` needs the feature `full`, which costs every user of a
//! generated crate a second.

use crate::attr::{self, Item, Slot};
use crate::errors::Errors;
use proc_macro2::{Group, TokenStream, TokenTree};
use syn::parse::{Parse, ParseStream, Parser as _};
use syn::{Attribute, Ident, Path, Token, Type, Visibility, braced, parenthesized, token};

/// `#[dispatch(protocol = Fc, service = RobotService, partial = PartialRobot)]`.
pub struct Options {
    /// Path of the runtime crate.
    pub runtime: Path,
    /// The protocol.
    pub protocol: Option<Path>,
    /// Name of the service.
    pub service: Option<Ident>,
    /// Name of the trait with optional methods, if there is one.
    pub partial: Option<Ident>,
}

impl Options {
    /// Reads the attribute's arguments.
    pub fn read(arguments: TokenStream, errors: &mut Errors) -> Self {
        let mut runtime = Slot::default();
        let mut protocol = Slot::default();
        let mut service = Slot::default();
        let mut partial = Slot::default();
        let place = "a service's trait";
        let parser =
            |input: ParseStream<'_>| {
                attr::read_items(input, errors, place, &mut |key, input| match key
                    .to_string()
                    .as_str()
                {
                    "crate" => runtime.set(key, attr::path(input)),
                    "protocol" => protocol.set(key, attr::path(input)),
                    "service" => service.set(key, attr::value(input)),
                    "partial" => partial.set(key, attr::value(input)),
                    _ => Ok(Item::Unknown),
                })
            };
        let result = parser.parse2(arguments);
        errors.ok(result);
        // `None` points at the attribute, because there is no other token.
        let nothing = TokenStream::new();
        protocol.required(errors, &nothing, "`protocol = …` is missing");
        service.required(errors, &nothing, "`service = …` is missing");
        Self {
            runtime: attr::runtime(runtime),
            protocol: protocol.into_value(),
            service: service.into_value(),
            partial: partial.into_value(),
        }
    }
}

/// The trait.
pub struct Service {
    pub attributes: Vec<Attribute>,
    pub visibility: Visibility,
    pub trait_token: Token![trait],
    pub ident: Ident,
    /// Tokens between the name and the methods.
    pub bounds: TokenStream,
    pub methods: Vec<Method>,
}

/// A method of the trait.
pub struct Method {
    /// Its attributes without `#[fc(…)]`.
    pub attributes: Vec<Attribute>,
    /// Its `#[fc(…)]`.
    pub role: Vec<Attribute>,
    pub is_async: bool,
    pub ident: Ident,
    /// Everything between the parentheses.
    pub arguments: TokenStream,
    /// Types of the arguments after `&self`.
    pub types: Vec<Type>,
    pub has_self: bool,
    /// Return type.
    pub output: Option<Type>,
    pub body: Option<Group>,
}

impl Parse for Service {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let attributes = input.call(Attribute::parse_outer)?;
        let visibility = input.parse()?;
        let trait_token = input.parse()?;
        let ident = input.parse()?;
        if input.peek(Token![<]) {
            return Err(input.error("a service's trait has no parameters"));
        }
        let mut bounds = TokenStream::new();
        while !input.is_empty() && !input.peek(token::Brace) {
            bounds.extend([input.parse::<TokenTree>()?]);
        }
        let content;
        braced!(content in input);
        let mut methods = Vec::new();
        while !content.is_empty() {
            methods.push(content.parse()?);
        }
        Ok(Self {
            attributes,
            visibility,
            trait_token,
            ident,
            bounds,
            methods,
        })
    }
}

impl Parse for Method {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let attributes = input.call(Attribute::parse_outer)?;
        let (role, attributes) = attributes
            .into_iter()
            .partition(|attribute| attribute.path().is_ident(attr::NAME));
        let is_async = input.parse::<Option<Token![async]>>()?.is_some();
        if !input.peek(Token![fn]) {
            return Err(input.error("a service's trait has methods only: expected `async fn`"));
        }
        input.parse::<Token![fn]>()?;
        let ident = input.parse()?;
        if input.peek(Token![<]) {
            return Err(input.error("a service's method has no parameters of its own"));
        }
        let content;
        parenthesized!(content in input);
        let arguments: TokenStream = content.fork().parse()?;
        let (has_self, types) = parse_arguments(&content)?;
        let output = if input.parse::<Option<Token![->]>>()?.is_some() {
            Some(input.parse()?)
        } else {
            None
        };
        let body = if input.peek(token::Brace) {
            Some(input.parse()?)
        } else {
            input.parse::<Token![;]>()?;
            None
        };
        Ok(Self {
            attributes,
            role,
            is_async,
            ident,
            arguments,
            types,
            has_self,
            output,
            body,
        })
    }
}

/// Reads `&self, name: Type, …`.
fn parse_arguments(input: ParseStream<'_>) -> syn::Result<(bool, Vec<Type>)> {
    let mut types = Vec::new();
    let has_self = input.peek(Token![&]) && input.peek2(Token![self]);
    if has_self {
        input.parse::<Token![&]>()?;
        input.parse::<Token![self]>()?;
        if !input.is_empty() {
            input.parse::<Token![,]>()?;
        }
    }
    while !input.is_empty() {
        // Skips the pattern of an argument.
        while !input.is_empty() && (!input.peek(Token![:]) || input.peek(Token![::])) {
            input.parse::<TokenTree>()?;
        }
        input.parse::<Token![:]>()?;
        types.push(input.parse()?);
        if !input.is_empty() {
            input.parse::<Token![,]>()?;
        }
    }
    Ok((has_self, types))
}

/// Returns the item without `#[fc(…)]`, which is unknown after this macro.
pub fn without_attributes(item: TokenStream) -> TokenStream {
    let mut tokens: Vec<TokenTree> = Vec::new();
    for token in item {
        match token {
            TokenTree::Group(group) if is_attribute(&group) && ends_with_pound(&tokens) => {
                tokens.pop();
            }
            TokenTree::Group(group) => {
                let mut inner = Group::new(group.delimiter(), without_attributes(group.stream()));
                inner.set_span(group.span());
                tokens.push(inner.into());
            }
            other => tokens.push(other),
        }
    }
    tokens.into_iter().collect()
}

fn is_attribute(group: &Group) -> bool {
    let first = group.stream().into_iter().next();
    matches!(first, Some(TokenTree::Ident(name)) if name == attr::NAME)
}

fn ends_with_pound(tokens: &[TokenTree]) -> bool {
    matches!(tokens.last(), Some(TokenTree::Punct(punct)) if punct.as_char() == '#')
}
