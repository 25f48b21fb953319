//! The kinds of output, and the generated files.

/// A kind of output, which `fcproto generate --only` selects by name.
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
    /// The generated part of the Python package.
    Python,
    /// The generated part of the Kotlin package.
    Kotlin,
    /// The generated part of the C++ package.
    Cpp,
    /// The JSON Schema of the spec language.
    Schema,
    /// The dissector for Wireshark.
    Wireshark,
}

impl Product {
    /// All products, in the order of generation.
    pub const ALL: [Self; 9] = [
        Self::Rust,
        Self::Markdown,
        Self::Vectors,
        Self::TypeScript,
        Self::Python,
        Self::Kotlin,
        Self::Cpp,
        Self::Schema,
        Self::Wireshark,
    ];

    /// Returns the name on the command line, in `fc.yaml` and in the manifest.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.facts().0
    }

    /// Returns the directory of the product, unless `fc.yaml` sets another one.
    #[must_use]
    pub fn usual_place(self) -> &'static str {
        self.facts().1
    }

    /// Returns the product with this name; `None` if there is none.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|product| product.name() == name)
    }

    /// Returns the name, and the default directory relative to the project's root.
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
            Self::Wireshark => ("wireshark", "stubs/wireshark"),
        }
    }
}

/// A generated file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Artifact {
    /// The name of its target.
    pub target: String,
    /// The path from the project's root, with `/` between its parts.
    pub path: String,
    /// The complete contents.
    pub contents: String,
}

/// Returns a path below a directory, which may be the root itself.
pub(crate) fn below(directory: &str, path: &str) -> String {
    match directory.trim_end_matches('/') {
        "" | "." => path.to_owned(),
        directory => format!("{directory}/{path}"),
    }
}
