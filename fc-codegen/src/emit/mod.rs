//! From the model to artifacts: pure functions, no disk.

pub mod cpp;
mod json;
pub mod kotlin;
pub mod markdown;
mod packed;
pub mod python;
pub mod rust;
pub mod schema;
pub mod typescript;
pub mod vectors;
pub mod wireshark;

use crate::product::{Artifact, Product};
use crate::target::{TargetError, Targets, part};
use fc_spec::model::Model;

/// Returns the artifacts of all products of a project, each with the content for its audience.
///
/// # Errors
///
/// [`TargetError::Audience`].
pub fn generate(model: &Model, targets: &Targets) -> Result<Vec<Artifact>, TargetError> {
    let mut artifacts = Vec::new();
    for product in targets.products() {
        let emit = match product {
            Product::Rust => rust::emit,
            Product::Markdown => markdown::emit,
            Product::Vectors => vectors::emit,
            Product::TypeScript => typescript::emit,
            Product::Python => python::emit,
            Product::Kotlin => kotlin::emit,
            Product::Cpp => cpp::emit,
            Product::Schema => schema::emit,
            Product::Wireshark => wireshark::emit,
        };
        let part = part(model, targets.audience(product))?;
        artifacts.extend(emit(&part, targets));
    }
    Ok(artifacts)
}
