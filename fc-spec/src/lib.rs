//! The spec language: reads a protocol in YAML and returns its model, or all of its errors.
//!
//! The source text ([`source`]) becomes a syntax tree with spans ([`syntax`]). [`load`] compares the tree with the grammar ([`language`])
//! and builds a resolved model ([`model`]).
//!
//! Other modules edit a spec. [`scaffold`] adds an operation, [`retire`] removes one, [`rename`] renames a thing, and [`revision`] changes
//! the version. [`mod@format`] formats a file, and [`mod@merge`] merges three versions of it.
//!
//! **Architecture invariant:** this crate does not know the products made from a model, and it writes no files. The crates that make
//! products depend on this crate and never see YAML.

pub mod amend;
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
pub mod project;
pub mod rename;
pub mod retire;
pub mod revision;
pub mod scaffold;
pub mod source;
pub mod syntax;
mod vocabulary;

/// Compiles the examples in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
