//! The JSON Schema of the spec language as a file.

use crate::product::{Artifact, Product};
use crate::target::Targets;
use fc_spec::language::schema;
use fc_spec::model::Model;

/// The schema, which is the same for every spec with the same languages.
#[must_use]
pub fn emit(_: &Model, targets: &Targets) -> Vec<Artifact> {
    vec![targets.artifact(
        Product::Schema,
        "fc-spec.schema.json",
        schema(targets.texts),
    )]
}
