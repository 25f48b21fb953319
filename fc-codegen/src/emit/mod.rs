//! From the model to artifacts: pure functions, no disk.

pub mod markdown;
pub mod rust;
pub mod schema;
pub mod typescript;
pub mod vectors;

use fc_spec::model::Model;

/// A kind of output; `fc generate --only` names them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Product {
    /// The generated crate's sources.
    Rust,
    /// The documentation's Markdown.
    Markdown,
    /// Golden frames.
    Vectors,
    /// What the TypeScript package knows of the protocol.
    TypeScript,
    /// The JSON Schema of the spec language.
    Schema,
}

/// What makes a product's artifacts.
type Emit = fn(&Model) -> Vec<Artifact>;

/// Every product, its name and what makes it: a new one is a line here.
const PRODUCTS: &[(Product, &str, Emit)] = &[
    (Product::Rust, "rust", rust::emit),
    (Product::Markdown, "markdown", markdown::emit),
    (Product::Vectors, "vectors", vectors::emit),
    (Product::TypeScript, "typescript", typescript::emit),
    (Product::Schema, "schema", schema::emit),
];

impl Product {
    /// Every product, in the order in which they are made.
    pub fn all() -> impl Iterator<Item = Self> {
        PRODUCTS.iter().map(|(product, ..)| *product)
    }

    /// Its name on the command line and in the manifest.
    #[must_use]
    pub fn name(self) -> &'static str {
        let row = PRODUCTS.iter().find(|(product, ..)| *product == self);
        row.map_or("", |(_, name, _)| name)
    }

    /// The product of this name, if there is one.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let row = PRODUCTS.iter().find(|(_, known, _)| *known == name);
        row.map(|(product, ..)| *product)
    }
}

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Artifact {
    /// What it belongs to.
    pub product: Product,
    /// Path from the project's root, `/` between its parts.
    pub path: String,
    /// All of it.
    pub contents: String,
}

/// The artifacts of some products, or of all of them where `only` names none.
#[must_use]
pub fn generate(model: &Model, only: &[Product]) -> Vec<Artifact> {
    PRODUCTS
        .iter()
        .filter(|(product, ..)| only.is_empty() || only.contains(product))
        .flat_map(|(.., emit)| emit(model))
        .collect()
}
