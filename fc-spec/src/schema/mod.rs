//! The JSON Schema (draft 2020-12) of the spec language, for editors.
//!
//! **Architecture invariant.** It is read off the tables by which the loader checks the shape of a spec, so what an
//! editor accepts and what the generator accepts cannot drift apart. It depends on the language
//! alone, not on any spec.

mod convert;

/// The schema, indented, with a newline at its end.
#[must_use]
pub fn schema() -> String {
    let mut out = convert::schema().pretty();
    out.push('\n');
    out
}
