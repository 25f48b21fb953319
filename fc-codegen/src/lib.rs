//! From the model of a protocol to Rust, Markdown and test vectors.
//!
//! A model becomes artifacts ([`emit`]), with the content of all packages ([`package`]), and with values and frames
//! made up for it by `fc-reflect`; one function ([`output`]) touches the disk. [`inspect`] shows the model itself,
//! [`questions`] what its owner has still to say, [`codes`] who has which code; [`check`] finds all that stands in the
//! way of making anything of a spec.

pub mod check;
pub mod codes;
pub mod emit;
pub mod inspect;
pub mod output;
pub mod package;
mod plugin;
pub mod product;
pub mod questions;
pub mod target;
mod yaml_error;

use fc_reflect::sample;

/// Its examples compile.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
