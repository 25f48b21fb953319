//! Generates packages, Markdown and test vectors from the model of a protocol.
//!
//! [`emit`] turns a model into artifacts. [`package`] contains the content that all packages share, and `fc-reflect`
//! invents values and frames. Only [`output`] writes to the disk. [`inspect`] dumps the model, [`questions`] lists the
//! questions for its owner, and [`codes`] lists its codes. [`version`] makes versions of packages. [`check`] finds all errors that prevent generating.
//! [`project`] finds a project and reads its settings, and [`input`] finds changes of the files that are read.

pub mod check;
pub mod codes;
pub mod emit;
pub mod input;
pub mod inspect;
pub mod output;
pub mod package;
mod plugin;
pub mod product;
pub mod project;
pub mod questions;
pub mod target;
mod target_error;
pub mod version;

use fc_reflect::sample;

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
