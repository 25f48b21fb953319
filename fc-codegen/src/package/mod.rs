//! The content of a generated package, independent of the language.
//!
//! These modules turn the model into facts, comments and files under construction. An emitter spells the facts in its
//! language and lays out its files with the language's `Style`.

pub(crate) mod about;
pub(crate) mod conditions;
pub(crate) mod context;
pub(crate) mod cycles;
pub(crate) mod digits;
pub(crate) mod docs;
pub mod expr;
pub(crate) mod facts;
pub(crate) mod group;
pub mod items;
pub(crate) mod joined;
pub mod language;
pub(crate) mod literal;
pub(crate) mod marks;
pub mod name;
pub(crate) mod process;
pub(crate) mod ranges;
pub(crate) mod samples;
pub(crate) mod source;
pub(crate) mod style;
pub(crate) mod template;
pub(crate) mod types;
pub(crate) mod wire;
