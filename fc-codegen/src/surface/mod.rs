//! What every package says of a protocol, with nothing of how a language says it.
//!
//! Between the model and the emitters of packages: facts that each language would otherwise work out for itself. A
//! language casts them into its own words; nothing here knows one.

pub mod cycles;
pub mod expr;
pub mod group;
pub mod language;
pub mod name;
pub mod package;
