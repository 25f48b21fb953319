//! The project of the edited spec.

use fc_codegen::project::{self, ProjectDirs};
use fc_codegen::target::{FILE, Targets};
use fc_diff::release::{DIRECTORY, Releases};
use fc_diff::{Packages, Version};
use fc_spec::diagnostic::Faults;
use fc_spec::index::Definitions;
use fc_spec::lint::{self, faults, lint, waive};
use fc_spec::model::{Model, Text};
use fc_spec::source::Sources;
use fc_spec::text;
use std::path::{Path, PathBuf, absolute};
use std::sync::OnceLock;

/// A project.
#[derive(Debug)]
pub struct Project {
    /// The project's directory.
    pub root: PathBuf,
    /// The directory of the spec, relative to `root`.
    pub spec: PathBuf,
    /// The targets that the project generates.
    pub targets: Targets,
    lint: Lint,
    releases: OnceLock<Vec<Version>>,
}

/// The lint settings of the project.
#[derive(Debug)]
pub struct Lint {
    settings: lint::Settings,
    /// `fc.yaml` and the rule files that it names.
    pub files: Sources,
    /// The diagnostics of these files.
    pub faults: Faults,
}

impl Project {
    /// Returns the named project, or the nearest one upwards from a directory.
    ///
    /// # Errors
    /// A sentence for the user if there is no project.
    pub fn find(dirs: &ProjectDirs, directory: &Path) -> Result<Self, Text> {
        let found = project::Project::find_from(dirs, directory).map_err(|error| error.text())?;
        // Clients name files by absolute paths, independent of the server's directory.
        let root = absolute(&found.root).map_err(|error| text!("{error}", "{error}"))?;
        Ok(Self::new(root, found.spec, found.targets))
    }

    /// Creates a project and reads its lint settings.
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

    /// Returns the lint settings.
    #[must_use]
    pub fn lint(&self) -> &Lint {
        &self.lint
    }

    /// Returns the lint findings of a model on a day, `YYYY-MM-DD`. Returns none while the lint settings have errors.
    pub fn linted<'p>(
        &self,
        model: &Model,
        today: &str,
        places: impl FnOnce() -> &'p Definitions,
    ) -> Faults {
        if !self.lint.faults.is_empty() {
            return Faults::new();
        }
        let settings = &self.lint.settings;
        let mut findings = lint(model, settings, today);
        waive(&mut findings, &model.waivers, today);
        faults(&findings, settings, places)
    }

    /// Returns the last release, whose name is its number, if it is readable. The first call reads the releases.
    #[must_use]
    pub fn release(&self) -> Option<&Version> {
        self.releases().first()
    }

    /// Returns the readable releases, the last one first. Returns none if the last release is unreadable. The first call
    /// reads them.
    #[must_use]
    pub fn releases(&self) -> &[Version] {
        self.releases
            .get_or_init(|| self.read_releases().unwrap_or_default())
    }

    /// Returns `true` if the releases have been read and there are none.
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

    fn read_releases(&self) -> Option<Vec<Version>> {
        let releases = Releases::beside(&self.root.join(&self.spec)).ok()?;
        let mut numbers: Vec<String> = releases.numbers().map(ToString::to_string).collect();
        let read = |number: String| Version::read(&number, &self.root, &self.spec).ok();
        let last = read(numbers.pop()?)?;
        let earlier = numbers.into_iter().rev().filter_map(read);
        Some(std::iter::once(last).chain(earlier).collect())
    }

    /// Returns `true` for a file that configures the project: `fc.yaml`, a rule file or a release.
    #[must_use]
    pub fn is_about(&self, file: &Path) -> bool {
        let releases = self.root.join(&self.spec).join(DIRECTORY);
        let mut rules = self.lint.files.iter();
        file == self.root.join(FILE)
            || rules.any(|(_, rules)| file == self.root.join(&rules.path))
            || file.starts_with(releases)
    }
}
