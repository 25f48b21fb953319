//! From the model to artifacts: pure functions, no disk.

pub mod markdown;
pub mod rust;
pub mod schema;
pub mod typescript;
pub mod vectors;

use crate::target::Targets;
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
type Emit = fn(&Model, &Targets) -> Vec<Artifact>;

/// Every product, its name, its usual place from the project's root and what makes it: a new one is a line here.
const PRODUCTS: &[(Product, &str, &str, Emit)] = &[
    (Product::Rust, "rust", "fc-generated", rust::emit),
    (Product::Markdown, "markdown", "docs-site", markdown::emit),
    (
        Product::Vectors,
        "vectors",
        "fc-generated/vectors",
        vectors::emit,
    ),
    (
        Product::TypeScript,
        "typescript",
        "stubs/typescript/generated",
        typescript::emit,
    ),
    (Product::Schema, "schema", "spec", schema::emit),
];

impl Product {
    /// Every product, in the order in which they are made.
    pub fn all() -> impl Iterator<Item = Self> {
        PRODUCTS.iter().map(|(product, ..)| *product)
    }

    /// Its name on the command line, in `fc.yaml` and in the manifest.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().map_or("", |(_, name, ..)| name)
    }

    /// Where it goes unless `fc.yaml` says otherwise.
    #[must_use]
    pub fn usual_place(self) -> &'static str {
        self.row().map_or("", |(_, _, place, _)| place)
    }

    /// The product of this name, if there is one.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let row = PRODUCTS.iter().find(|(_, known, ..)| *known == name);
        row.map(|(product, ..)| *product)
    }

    fn row(self) -> Option<&'static (Product, &'static str, &'static str, Emit)> {
        PRODUCTS.iter().find(|(product, ..)| *product == self)
    }
}

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Artifact {
    /// Name of the target that it belongs to.
    pub target: String,
    /// Path from the project's root, `/` between its parts.
    pub path: String,
    /// All of it.
    pub contents: String,
}

/// The artifacts of all products that a project has.
#[must_use]
pub fn generate(model: &Model, targets: &Targets) -> Vec<Artifact> {
    PRODUCTS
        .iter()
        .filter(|(product, ..)| targets.place(*product).is_some())
        .flat_map(|(.., emit)| emit(model, targets))
        .collect()
}
