//! The spec language: from a protocol written in YAML to its model, or to every fault in it.
//!
//! Source text ([`source`]) becomes a spanned syntax tree ([`syntax`]), is compared with the grammar ([`language`]), and
//! becomes a resolved model ([`model`], [`load`]). [`scaffold`] begins a new operation, [`retire`] takes one out, [`rename`] gives a thing another name, [`revision`] gives the whole another number, [`mod@format`] lays out the text of a file, and
//! [`mod@merge`] makes one of three versions of it.
//!
//! **Architecture invariant:** nothing here knows what is made of a model, and nothing writes. What makes
//! products depends on this crate and sees no YAML.

pub mod diagnostic;
pub mod fix;
pub mod format;
pub mod index;
pub mod language;
pub mod lint;
pub mod load;
pub mod merge;
pub mod model;
mod names;
pub mod rename;
pub mod retire;
pub mod revision;
pub mod scaffold;
pub mod source;
pub mod syntax;
mod vocabulary;

/// Its examples compile.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
