//! The project whose spec is edited, and who finds it.

use fc_codegen::target::{FILE, Targets};
use fc_diff::release::{DIRECTORY, Releases};
use fc_diff::{Packages, Version};
use fc_spec::diagnostic::Faults;
use fc_spec::index::Places;
use fc_spec::lint::{self, faults, lint, waive};
use fc_spec::model::Model;
use fc_spec::source::Sources;
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
    lint: Lint,
    releases: OnceLock<Vec<Release>>,
}

/// What the project says of the lint, and where.
#[derive(Debug)]
pub struct Lint {
    settings: lint::Settings,
    /// `fc.yaml` and the files of rules that it names.
    pub files: Sources,
    /// What is wrong in them.
    pub faults: Faults,
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
        let mut faults = Faults::new();
        let (settings, files) = lint::settings(&root, FILE, &mut faults);
        let lint = Lint {
            settings,
            files,
            faults,
        };
        Self {
            root,
            spec,
            targets,
            lint,
            releases: OnceLock::new(),
        }
    }

    /// What it says of the lint.
    #[must_use]
    pub fn lint(&self) -> &Lint {
        &self.lint
    }

    /// What the lint finds in a model on a day, `YYYY-MM-DD`: nothing while something is wrong with its settings, as then nobody knows
    /// what it is to look for.
    pub fn linted<'p>(
        &self,
        model: &Model,
        today: &str,
        places: impl FnOnce() -> &'p Places,
    ) -> Faults {
        if !self.lint.faults.is_empty() {
            return Faults::new();
        }
        let settings = &self.lint.settings;
        let mut findings = lint(model, settings, today);
        waive(&mut findings, &model.waivers, today);
        faults(&findings, settings, places)
    }

    /// The last release, if there is one that can be read. It is read when it is asked for first.
    #[must_use]
    pub fn release(&self) -> Option<&Release> {
        self.releases().first()
    }

    /// Returns the readable releases, the last one first. Returns none if the last release is unreadable. The first call
    /// reads them.
    #[must_use]
    pub fn releases(&self) -> &[Release] {
        self.releases
            .get_or_init(|| self.read_releases().unwrap_or_default())
    }

    /// Whether it is known that there is none.
    #[must_use]
    pub fn is_unreleased(&self) -> bool {
        self.releases.get().is_some_and(Vec::is_empty)
    }

    /// Returns the settings of the packages for a comparison.
    #[must_use]
    pub fn packages(&self) -> Packages {
        Packages {
            id_types: self.targets.has_id_types(),
        }
    }

    fn read_releases(&self) -> Option<Vec<Release>> {
        let releases = Releases::beside(&self.root.join(&self.spec)).ok()?;
        let mut numbers: Vec<String> = releases.numbers().map(ToString::to_string).collect();
        let read = |number: String| {
            let version = Version::read(&number, &self.root, &self.spec).ok()?;
            Some(Release {
                number,
                model: version.model,
            })
        };
        let last = read(numbers.pop()?)?;
        let earlier = numbers.into_iter().rev().filter_map(read);
        Some(std::iter::once(last).chain(earlier).collect())
    }

    /// Whether a file says something of the project beside its spec: what is made of it, what the lint looks for, what is released.
    #[must_use]
    pub fn is_about(&self, file: &Path) -> bool {
        let releases = self.root.join(&self.spec).join(DIRECTORY);
        let mut rules = self.lint.files.iter();
        file == self.root.join(FILE)
            || rules.any(|(_, rules)| file == self.root.join(&rules.path))
            || file.starts_with(releases)
    }
}
