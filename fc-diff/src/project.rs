//! Compares versions of a project's spec, with its releases and waivers.

use crate::finding::Finding;
use crate::release::Releases;
use crate::sunset::gone_early;
use crate::version::{Version, VersionError};
use crate::waive::{Against, waive};
use crate::{Packages, diff_since};
use std::path::Path;

/// The spec of a project on the disk.
#[derive(Clone, Copy, Debug)]
pub struct ProjectSpec<'p> {
    /// The project's directory.
    pub root: &'p Path,
    /// The directory of the spec, relative to `root`.
    pub spec: &'p Path,
    /// The settings of the packages.
    pub packages: Packages,
}

impl ProjectSpec<'_> {
    /// Returns the name of the working tree for [`Version::read`].
    #[must_use]
    pub fn working_tree(&self) -> String {
        self.root.display().to_string()
    }

    /// Loads a version by name, as [`Version::read`] does.
    ///
    /// # Errors
    ///
    /// [`VersionError`].
    pub fn read(&self, name: &str) -> Result<Version, VersionError> {
        Version::read(name, self.root, self.spec)
    }

    /// Compares two versions, and the new one with the releases before both. Applies its waivers as of `today`,
    /// `YYYY-MM-DD`.
    ///
    /// An unused waiver is an error only in the working tree compared with the last release.
    ///
    /// # Errors
    ///
    /// [`VersionError`] if an earlier release cannot be read.
    pub fn compare(
        &self,
        releases: &Releases,
        [old, new]: [&Version; 2],
        today: &str,
    ) -> Result<Vec<Finding>, VersionError> {
        let earlier = releases.before([&old.name, &new.name]);
        let earlier = earlier.map(|number| self.read(&number.to_string()));
        let earlier: Vec<Version> = earlier.collect::<Result<_, _>>()?;
        let earlier = earlier.iter().map(|it| (it.name.as_str(), &it.model));
        let mut findings = diff_since(earlier, &old.model, &new.model, self.packages);
        findings.extend(gone_early(&old.model, &new.model, today));
        let last = releases.last().map(|(number, _)| number.to_string());
        let is_since_release = last.as_ref() == Some(&old.name) && new.name == self.working_tree();
        let against = if is_since_release {
            Against::Release
        } else {
            Against::Other
        };
        waive(&mut findings, &new.model.waivers, today, against);
        Ok(findings)
    }
}
