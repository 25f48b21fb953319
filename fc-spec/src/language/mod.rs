//! The spec language: declares its keys and words once, and builds a reference and a JSON Schema from them.
//!
//! **Architecture invariant.** The loader, the reference and the schema read the same tables, so they cannot disagree. The module depends
//! on the language only, not on any spec.

pub(crate) mod ambiguous_scalar;
mod cursor;
mod example;
mod faults;
pub(crate) mod grammar;
mod occurrence;
mod reference;
pub(crate) mod scalar;
mod schema;

pub(crate) use cursor::Cursor;
pub(crate) use occurrence::references;
pub use occurrence::{Occurrence, OtherKey, Reference, Role, occurrence_at, visit};
#[cfg(test)]
pub(crate) use reference::tables;
pub use reference::{Key, Part, Takes, Word, reference};
pub use schema::{project_schema, schema};
