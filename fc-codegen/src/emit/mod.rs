//! From the model to artifacts: pure functions, no disk.

pub mod markdown;
pub mod rust;
pub mod site;
pub mod vectors;

/// A kind of output; `fc generate --only` names them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Product {
    /// The generated crate's sources.
    Rust,
    /// The documentation's Markdown.
    Markdown,
    /// Golden frames.
    Vectors,
    /// What the documentation site's laboratory knows of the protocol.
    Site,
    /// The JSON Schema of the spec language.
    Schema,
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
