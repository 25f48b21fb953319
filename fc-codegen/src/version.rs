//! Versions of packages, in the form of each ecosystem.
//!
//! A version consists of the number of the package, and of the spec that the package was generated from.

/// An ecosystem with rules for the versions of packages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ecosystem {
    /// Crates of Rust.
    Cargo,
    /// Packages of npm.
    Npm,
    /// Wheels and source distributions of Python.
    Python,
    /// Artifacts of Maven and Gradle.
    Maven,
    /// Packages of Debian, and archives with the same version.
    Debian,
}

/// The spec of a package.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Edition {
    /// A release of the spec with its number, such as `2024.09`.
    Release(String),
    /// A spec that differs from every release, with its fingerprint.
    Draft(String),
}

impl Edition {
    /// Returns the version of a package with this number, such as `0.2.0`.
    ///
    /// | Ecosystem | Release 2024.09 | Draft | Rules |
    /// |---|---|---|---|
    /// | Cargo, npm | `0.2.0+2024.9` | `0.2.0-dev.x1a2b3c4d5e6f` | Semantic Versioning 2.0, 9 and 10: `-` precedes, `+` has no order |
    /// | Python | `0.2.0+2024.9` | `0.2.0.dev0+x1a2b3c4d5e6f` | PEP 440: local versions follow, `.dev` precedes |
    /// | Maven | `0.2.0-2024.9` | `0.2.0-alpha-x1a2b3c4d5e6f` | `ComparableVersion`: a number follows, `alpha` precedes |
    /// | Debian | `0.2.0+2024.9` | `0.2.0~dev.x1a2b3c4d5e6f` | deb-version(7): `+` follows, `~` precedes |
    ///
    /// A draft precedes every release of the spec with the same number of the package. Cargo and npm do not order two
    /// releases of the spec, and registries refuse the second one: it needs a new number.
    ///
    /// Python drops zeros before a number, so no form has them. The `x` keeps a fingerprint without letters from being
    /// a number.
    #[must_use]
    pub fn version(&self, ecosystem: Ecosystem, number: &str) -> String {
        match self {
            Self::Release(release) => {
                let parts = release.split('.').map(without_zeros);
                let release = parts.collect::<Vec<_>>().join(".");
                let before = match ecosystem {
                    Ecosystem::Maven => "-",
                    Ecosystem::Cargo | Ecosystem::Npm | Ecosystem::Python | Ecosystem::Debian => {
                        "+"
                    }
                };
                format!("{number}{before}{release}")
            }
            Self::Draft(fingerprint) => {
                let before = match ecosystem {
                    Ecosystem::Cargo | Ecosystem::Npm => "-dev.",
                    Ecosystem::Python => ".dev0+",
                    Ecosystem::Maven => "-alpha-",
                    Ecosystem::Debian => "~dev.",
                };
                format!("{number}{before}x{fingerprint}")
            }
        }
    }
}

/// Returns a part of a release number without zeros before it.
fn without_zeros(part: &str) -> &str {
    match part.trim_start_matches('0') {
        "" => "0",
        number => number,
    }
}
