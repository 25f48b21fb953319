//! The codes that each method serves, and requirements of the trait.

use super::ast::{Method, Service};
use crate::attr::{self, Item, Slot};
use crate::errors::Errors;
use syn::{LitInt, Token};

/// The methods by their codes.
pub struct Roles<'s> {
    /// Methods for the command of their request type.
    pub commands: Vec<&'s Method>,
    /// Methods for a range of codes.
    pub ranges: Vec<(&'s Method, Range)>,
    /// The method for all other codes.
    pub unknown: &'s Method,
}

/// A range of codes as written, both ends included.
pub struct Range {
    pub first: LitInt,
    pub last: LitInt,
}

impl Range {
    fn bounds(&self) -> (u16, u16) {
        let value = |literal: &LitInt| literal.base10_parse().unwrap_or_default();
        (value(&self.first), value(&self.last))
    }
}

/// Reports invalid method signatures.
pub fn check(service: &Service, errors: &mut Errors) {
    for method in &service.methods {
        let message = if !method.is_async {
            "a service's method is `async`"
        } else if !method.has_self {
            "a service's method takes `&self`"
        } else if method.types.len() != 2 {
            "a service's method takes `&self`, a context and a request"
        } else if method.output.is_none() {
            "a service's method answers `Result<Response, Refusal>`"
        } else {
            continue;
        };
        errors.on(&method.ident, message);
    }
}

/// Returns the codes of each method, or `None` after an error.
pub fn roles<'s>(service: &'s Service, errors: &mut Errors) -> Option<Roles<'s>> {
    let mut commands = Vec::new();
    let mut ranges: Vec<(&Method, Range)> = Vec::new();
    let mut unknown: Option<&Method> = None;
    for method in &service.methods {
        let mut range = Slot::default();
        let mut rest = Slot::default();
        attr::read(
            &method.role,
            errors,
            "a service's method",
            &mut |key, input| match key.to_string().as_str() {
                "range" => range.set(key, read_range(input)),
                "unknown" => rest.set(key, Ok(())),
                _ => Ok(Item::Unknown),
            },
        );
        match (range.key(), rest.key()) {
            (Some(_), Some(key)) => {
                errors.at(key, "a method serves a range or what is unknown, not both");
            }
            (Some(_), None) => {
                if let Some(range) = range.into_value() {
                    check_overlap(&range, &ranges, errors);
                    ranges.push((method, range));
                }
            }
            (None, Some(key)) if unknown.is_some() => {
                errors.at(key, "another method serves what is unknown");
            }
            (None, Some(_)) => unknown = Some(method),
            (None, None) => commands.push(method),
        }
    }
    if unknown.is_none() {
        errors.on(
            &service.ident,
            "one method must serve the codes that no other does: mark it `#[fc(unknown)]`",
        );
    }
    Some(Roles {
        commands,
        ranges,
        unknown: unknown?,
    })
}

fn check_overlap(range: &Range, earlier: &[(&Method, Range)], errors: &mut Errors) {
    let (first, last) = range.bounds();
    for (method, other) in earlier {
        let (other_first, other_last) = other.bounds();
        if first <= other_last && other_first <= last {
            let message = format!("the range overlaps that of `{}`", method.ident);
            errors.on(&range.first, message);
        }
    }
}

/// Reads `= 0x0200..=0x0300`.
fn read_range(input: syn::parse::ParseStream<'_>) -> syn::Result<Range> {
    input.parse::<Token![=]>()?;
    let ahead = input.fork();
    attr::range::<u16>(&ahead)?;
    let first = input.parse()?;
    input.parse::<Token![..=]>()?;
    let last = input.parse()?;
    Ok(Range { first, last })
}
