//! The JSON Schema (draft 2020-12) of the spec language, for editors.
//!
//! **Architecture invariant.** It is read off the tables by which the loader checks the shape of a spec, so what an
//! editor accepts and what the generator accepts cannot drift apart. It depends on the language
//! alone, not on any spec.

mod convert;

use super::{Artifact, Product};
use crate::model::Model;

/// Where it is written, from the project's root.
pub const PATH: &str = "spec/fc-spec.schema.json";

/// The schema as a file.
#[must_use]
pub fn emit(_: &Model) -> Vec<Artifact> {
    vec![Artifact {
        product: Product::Schema,
        path: PATH.to_owned(),
        contents: schema(),
    }]
}

/// The schema, indented, with a newline at its end.
#[must_use]
pub fn schema() -> String {
    let mut out = convert::schema().pretty();
    out.push('\n');
    out
}
