//! The languages with packages.

use fc_codegen::product::Product;

/// A language with packages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// `.crate` files and a directory source of Cargo.
    Rust,
    /// An npm tarball.
    TypeScript,
    /// A wheel and a source distribution.
    Python,
    /// A Maven repository for Kotlin and Java.
    Kotlin,
    /// An install tree as `.tar.gz` and, on Linux, as `.deb`.
    Cpp,
}

impl Language {
    /// All languages.
    pub const ALL: [Self; 5] = [
        Self::Rust,
        Self::TypeScript,
        Self::Python,
        Self::Kotlin,
        Self::Cpp,
    ];

    /// Returns the product with the sources of the package.
    #[must_use]
    pub fn product(self) -> Product {
        match self {
            Self::Rust => Product::Rust,
            Self::TypeScript => Product::TypeScript,
            Self::Python => Product::Python,
            Self::Kotlin => Product::Kotlin,
            Self::Cpp => Product::Cpp,
        }
    }

    /// Returns the name of the product, which is also the name of the directory with the packages.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.product().name()
    }
}
