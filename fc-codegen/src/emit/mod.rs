//! From the model to artifacts: pure functions, no disk.

mod json;
pub mod markdown;
mod packed;
pub mod rust;
pub mod schema;
pub mod typescript;
pub mod vectors;

use crate::product::{Artifact, Product};
use crate::target::Targets;
use fc_spec::model::Model;

/// The artifacts of all products that a project has.
#[must_use]
pub fn generate(model: &Model, targets: &Targets) -> Vec<Artifact> {
    let products = targets.products();
    products
        .flat_map(|product| {
            let emit = match product {
                Product::Rust => rust::emit,
                Product::Markdown => markdown::emit,
                Product::Vectors => vectors::emit,
                Product::TypeScript => typescript::emit,
                Product::Schema => schema::emit,
            };
            emit(model, targets)
        })
        .collect()
}
