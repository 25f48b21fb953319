//! Builds the packages of a project that other projects install.
//!
//! [`pack`] calls the tools of the language, so that each package is one that its own ecosystem has made. The version
//! of a package contains the release of the spec ([`Edition`]). The result has a bill of materials in `CycloneDX` 1.6,
//! and the list `SHA256SUMS` with the checksums of all files.
//!
//! **Architecture invariant.** The manifests of a project do not change. A version is set in a packed copy of a
//! manifest, or by an option of the tool.

mod cpp;
mod error;
mod files;
mod job;
mod kotlin;
mod language;
mod maven;
mod python;
mod rust;
mod sbom;
mod sums;
mod tool;
mod typescript;

pub use error::PackError;
pub use job::Project;
pub use language::Language;

use error::unwritable;
use fc_codegen::version::Edition;
use job::Job;
use std::path::Path;

/// The result of packing a language.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Packed {
    /// The version of the package, in the form of its ecosystem.
    pub version: String,
    /// The written files, sorted: paths relative to the output directory, with `/` between their parts.
    pub paths: Vec<String>,
}

/// Packs a language of a project into the directory with its name below `out`. Creates `out` if it does not exist.
///
/// The files of the last run are replaced: those that `SHA256SUMS` in `out` lists for this language. Other files stay.
/// The generated files of the project must be up to date.
///
/// # Errors
/// [`PackError`] if a tool is missing or fails, or if a file cannot be read or written. The package must have a manifest
/// with a number such as `0.2.0`. The files of the last run stay, unless an error occurs while they are replaced.
pub fn pack(
    project: Project<'_>,
    language: Language,
    edition: &Edition,
    out: &Path,
) -> Result<Packed, PackError> {
    // Tools run in other directories, where a relative path has another meaning.
    let out = files::directory(&std::path::absolute(out)?)?;
    // On the same file system as the result, so that files can be moved.
    let work = tempfile::tempdir_in(&out).map_err(unwritable(&out))?;
    let job = Job {
        project,
        product: language.product(),
        edition,
        out: files::directory(&work.path().join("out"))?,
        work: files::directory(&work.path().join("work"))?,
    };
    let packages = match language {
        Language::Rust => rust::pack(&job),
        Language::TypeScript => typescript::pack(&job),
        Language::Python => python::pack(&job),
        Language::Kotlin => kotlin::pack(&job),
        Language::Cpp => cpp::pack(&job),
    }?;
    sbom::write(&job.out, &packages)?;
    Ok(Packed {
        paths: sums::replace(&out, language.name(), &job.out)?,
        version: packages.main.component.version,
    })
}

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
