//! Edits a spec for its next release, and checks the release.

use crate::changelog::{first_section, section};
use crate::finding::Finding;
use crate::release::{Number, Objection, Releases, goes_back, objections};
use crate::waive::is_ours;
use fc_spec::model::{Lang, Model};
use fc_spec::revision::{renumbered, without_waiver};
use fc_spec::source::Sources;

/// A spec with the changes that a release makes.
#[derive(Clone, Debug)]
pub struct NextRelease {
    /// The number.
    pub number: Number,
    /// The model with the new number and with the waivers. It is compared with the last release.
    pub agreed: Model,
    /// The model without the used waivers. The release contains it.
    pub released: Model,
    /// The changed files.
    pub sources: Sources,
    /// The path and the lines of each change, as diffs without line numbers.
    pub diffs: Vec<(String, String)>,
    /// The ids of used waivers that are not on separate lines. The user has to remove them.
    pub left: Vec<String>,
}

impl NextRelease {
    /// Sets the version of a spec and removes the waivers that this release uses up. `check` returns the model of the
    /// changed files, or their errors.
    ///
    /// Returns `None` if no file has the version of the protocol.
    ///
    /// # Errors
    ///
    /// The error of `check`.
    pub fn prepare<E>(
        number: &Number,
        sources: &Sources,
        check: impl Fn(Sources) -> Result<Model, E>,
    ) -> Result<Option<Self>, E> {
        let Some(renumbered) = renumbered(sources, &number.to_string()) else {
            return Ok(None);
        };
        let agreed = check(renumbered.sources.clone())?;
        let (mut sources, mut left) = (renumbered.sources, Vec::new());
        let mut diffs = vec![(renumbered.path, renumbered.diff)];
        for waiver in agreed.waivers.iter().filter(|it| is_ours(it)) {
            match without_waiver(&sources, &waiver.id) {
                Some(without) => {
                    sources = without.sources;
                    diffs.push((without.path, without.diff));
                }
                None => left.push(waiver.id.clone()),
            }
        }
        diffs.retain(|(_, diff)| !diff.is_empty());
        Ok(Some(Self {
            number: number.clone(),
            released: check(sources.clone())?,
            agreed,
            sources,
            diffs,
            left,
        }))
    }

    /// Returns all reasons against the release. `version` is that of the spec before the changes. `findings` are the
    /// changes since the last release, or `None` if there is none.
    #[must_use]
    pub fn objections(
        &self,
        version: &str,
        releases: &Releases,
        findings: Option<&[Finding]>,
    ) -> Vec<Objection> {
        let mut all = match (releases.last(), findings) {
            (Some((last, _)), Some(findings)) => objections(last, &self.number, findings),
            _ => Vec::new(),
        };
        let is_late = |it: &Objection| matches!(it, Objection::NotLater { .. });
        if !all.iter().any(is_late) {
            all.extend(goes_back(&self.number, version));
        }
        all
    }

    /// Returns the section of the changelog. `today` is the date of the release, `YYYY-MM-DD`.
    #[must_use]
    pub fn section(&self, today: &str, findings: Option<&[Finding]>, lang: Lang) -> String {
        let title = format!("{} ({today})", self.number);
        match findings {
            Some(findings) => section(&title, findings, &self.agreed, lang),
            None => first_section(&title, &self.agreed, lang),
        }
    }
}
