//! What can be made of a model, and the files that it comes to.

/// A kind of output; `fcproto generate --only` names them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Product {
    /// The generated crate's sources.
    Rust,
    /// The documentation's Markdown.
    Markdown,
    /// Golden frames.
    Vectors,
    /// The generated part of the TypeScript package.
    TypeScript,
    /// That of the Python package.
    Python,
    /// That of the Kotlin package.
    Kotlin,
    /// That of the C++ package.
    Cpp,
    /// The JSON Schema of the spec language.
    Schema,
}

impl Product {
    /// Every product, in the order in which they are made.
    pub const ALL: [Self; 8] = [
        Self::Rust,
        Self::Markdown,
        Self::Vectors,
        Self::TypeScript,
        Self::Python,
        Self::Kotlin,
        Self::Cpp,
        Self::Schema,
    ];

    /// Its name on the command line, in `fc.yaml` and in the manifest.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.facts().0
    }

    /// Where it goes unless `fc.yaml` says otherwise.
    #[must_use]
    pub fn usual_place(self) -> &'static str {
        self.facts().1
    }

    /// The product of this name, if there is one.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|product| product.name() == name)
    }

    /// Its name, and its usual place from the project's root.
    fn facts(self) -> (&'static str, &'static str) {
        match self {
            Self::Rust => ("rust", "fc-generated"),
            Self::Markdown => ("markdown", "docs-site"),
            Self::Vectors => ("vectors", "fc-generated/vectors"),
            Self::TypeScript => ("typescript", "stubs/typescript/generated"),
            Self::Python => ("python", "stubs/python"),
            Self::Kotlin => ("kotlin", "stubs/kotlin"),
            Self::Cpp => ("cpp", "stubs/cpp"),
            Self::Schema => ("schema", "spec"),
        }
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
