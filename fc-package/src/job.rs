//! The package of one language, and the places to build it.

use crate::error::PackError;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_codegen::version::{Ecosystem, Edition};
use std::path::{Path, PathBuf};

/// A project with packages.
#[derive(Clone, Copy, Debug)]
pub struct Project<'p> {
    /// The directory of the project.
    pub root: &'p Path,
    /// The targets of the project, which name the directories of the generated files.
    pub targets: &'p Targets,
}

/// The package of one language, and the places to build it.
pub struct Job<'p> {
    pub project: Project<'p>,
    pub product: Product,
    pub edition: &'p Edition,
    /// An empty directory for the packages.
    pub out: PathBuf,
    /// An empty directory for other files.
    pub work: PathBuf,
}

impl Job<'_> {
    /// Returns the directory of the package: the nearest one with this file, from the generated files upwards.
    pub fn package(&self, manifest: &str) -> Result<PathBuf, PackError> {
        let Project { root, targets } = self.project;
        let root = std::path::absolute(root)?;
        let usual = self.product.usual_place();
        let place = targets.place(self.product).unwrap_or(usual);
        let generated = root.join(place);
        let inside = generated.ancestors().take_while(|it| it.starts_with(&root));
        let mut found = inside.filter(|it| it.join(manifest).is_file());
        let found = found.next().map(Path::to_owned);
        found.ok_or_else(|| PackError::NoManifest {
            place: place.to_owned(),
            manifest: manifest.to_owned(),
            usual,
        })
    }

    /// Returns the version of the package from its number, which must be like `0.2.0`.
    pub fn version(&self, ecosystem: Ecosystem, number: &str) -> Result<String, PackError> {
        let is_part = |part: &str| !part.is_empty() && part.bytes().all(|it| it.is_ascii_digit());
        if number.split('.').count() > 3 || !number.split('.').all(is_part) {
            return Err(PackError::Number(number.to_owned()));
        }
        Ok(self.edition.version(ecosystem, number))
    }
}
