//! From a protocol written in YAML to Rust, Markdown and test vectors.
//!
//! Text becomes a spanned syntax tree ([`syntax`]), becomes a resolved model ([`model`]), is
//! checked, becomes artifacts ([`emit`]); one function ([`output`]) touches the disk.

pub mod diagnostic;
pub mod emit;
pub mod inspect;
pub mod load;
pub mod model;
pub mod output;
mod parallel;
pub mod sample;
pub mod scaffold;
pub mod syntax;
