//! The JSON Schema of the spec language as a file.

use super::{Artifact, Product};
use fc_spec::model::Model;
use fc_spec::schema::schema;

/// Where it is written, from the project's root.
pub const PATH: &str = "spec/fc-spec.schema.json";

/// The schema, which is the same for every spec.
#[must_use]
pub fn emit(_: &Model) -> Vec<Artifact> {
    vec![Artifact {
        product: Product::Schema,
        path: PATH.to_owned(),
        contents: schema(),
    }]
}
