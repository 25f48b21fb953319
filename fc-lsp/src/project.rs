//! The project whose spec is edited, and who finds it.

use fc_codegen::target::Targets;
use fc_diff::Version;
use fc_diff::release::{DIRECTORY, Releases};
use fc_spec::model::Model;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// What the server asks of the program it is part of.
pub trait Host {
    /// The project at a directory or above it.
    ///
    /// # Errors
    /// Why there is none: a sentence for the user.
    fn find(&self, directory: &Path) -> Result<Project, String>;

    /// The day for which waivers are looked at, `YYYY-MM-DD`.
    fn today(&self) -> String;
}

/// A project.
#[derive(Debug)]
pub struct Project {
    /// Its directory.
    pub root: PathBuf,
    /// The directory of its spec, from there.
    pub spec: PathBuf,
    /// What is made of the spec.
    pub targets: Targets,
    release: OnceLock<Option<Release>>,
}

/// A version of the spec that is out.
#[derive(Debug)]
pub struct Release {
    /// Its number, such as `2024.09`.
    pub number: String,
    /// What it means.
    pub model: Model,
}

impl Project {
    /// A project that has been found.
    #[must_use]
    pub fn new(root: PathBuf, spec: PathBuf, targets: Targets) -> Self {
        Self {
            root,
            spec,
            targets,
            release: OnceLock::new(),
        }
    }

    /// The last release, if there is one that can be read. It is read when it is asked for first.
    #[must_use]
    pub fn release(&self) -> Option<&Release> {
        self.release.get_or_init(|| self.read_release()).as_ref()
    }

    /// Whether it is known that there is none.
    #[must_use]
    pub fn is_unreleased(&self) -> bool {
        matches!(self.release.get(), Some(None))
    }

    fn read_release(&self) -> Option<Release> {
        let releases = Releases::beside(&self.root.join(&self.spec)).ok()?;
        let number = releases.last()?.0.to_string();
        let version = Version::read(&number, &self.root, &self.spec).ok()?;
        Some(Release {
            number,
            model: version.model,
        })
    }

    /// Whether a file says something of the project beside its spec: what is made of it, what is released.
    #[must_use]
    pub fn is_about(&self, file: &Path) -> bool {
        let releases = self.root.join(&self.spec).join(DIRECTORY);
        file == self.root.join(fc_codegen::target::FILE) || file.starts_with(releases)
    }
}
