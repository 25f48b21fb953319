//! JSON Schemas (draft 2020-12): of the spec language, for editors, and of the dump, for other programs. And the
//! reference of the language, for people.
//!
//! **Architecture invariant.** What is said of the language is read off the tables by which the loader checks the shape of a spec, so what an
//! editor accepts and what the generator accepts cannot drift apart; the one of the dump is derived from the model. Both depend on the language
//! alone, not on any spec.

mod convert;
mod example;
mod faults;
mod reference;

use crate::model::{Dump, Languages};

pub use reference::{Key, Part, Takes, Word, reference};

#[cfg(test)]
pub(crate) use reference::tables;
pub(crate) use reference::words;

/// The schema of the language for specs whose texts are in these languages, indented, with a newline at its end.
#[must_use]
pub fn schema(texts: Languages) -> String {
    let mut out = convert::schema(texts).pretty();
    out.push('\n');
    out
}

/// The schema of what `fcproto inspect` prints and `fcproto generate --from` reads, indented, with a newline at its end. Keys that
/// are worked out from others for the reader's comfort are not in it.
#[must_use]
pub fn dump() -> String {
    // Nothing of a schema has keys that are no texts, which is all that can fail.
    let schema = serde_json::to_string_pretty(&schemars::schema_for!(Dump));
    schema.unwrap_or_default() + "\n"
}
