//! From the model of a protocol to Rust, Markdown and test vectors.
//!
//! A model becomes artifacts ([`emit`]), with values made up for it ([`sample`]); one function ([`output`])
//! touches the disk. [`inspect`] shows the model itself.

pub mod emit;
pub mod inspect;
pub mod output;
pub mod sample;
pub mod target;
