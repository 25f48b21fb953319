//! The content of a package, without the words of a language.
//!
//! Between the model and the emitters of packages: facts that each language would otherwise work out for itself, the
//! comments on them, and a file under construction. An emitter spells them in its language. A language writes its files
//! in its [`Style`](style::Style).

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
pub mod language;
pub(crate) mod marks;
pub mod name;
pub(crate) mod process;
pub(crate) mod ranges;
pub(crate) mod samples;
pub(crate) mod source;
pub(crate) mod style;
pub(crate) mod wire;
