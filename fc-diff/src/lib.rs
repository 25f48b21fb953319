//! Compares two versions of a protocol and reports the effects of each change.
//!
//! ```text
//! old Model ─┐         ┌─ matching: pairs of operations, types and fields
//!            ├──► diff ┼─ judge: the rules, by section; each claims the paths that it has judged
//! new Model ─┘         └─ unjudged: all other differences between the two dumps
//! ```
//!
//! Each message has a sender and a receiver. The app sends the request of a command and the acknowledgement of a
//! report. The robot sends the response and the report. A rule defines whether messages from old senders break at new
//! receivers, or the reverse. A finding translates this into [deployments](Deployment): old apps with new robots, new
//! apps with old robots.
//!
//! **Architecture invariant.** No finding means that the two dumps are equal, except for places in files and for
//! waivers. Waivers belong to a comparison and not to the protocol.

mod changelog;
mod explanation;
mod file_diff;
mod finding;
mod git;
mod history;
mod judge;
mod matching;
mod next_release;
mod project;
pub mod release;
mod render;
mod rule;
mod rules;
mod sunset;
mod version;
mod waive;

pub use changelog::{section, with_section};
pub use explanation::{Explanation, UnknownCode, explain, titles};
pub use fc_spec::model::Lang;
pub use file_diff::{FileDiff, FileVersion, file_diff};
pub use finding::{Deployment, Finding, Senders, Spot};
pub use next_release::NextRelease;
pub use project::ProjectSpec;
pub use render::{Format, render};
pub use rule::{About, Language, Rule, Wire};
pub use sunset::gone_early;
pub use version::{Version, VersionError, for_audience};
pub use waive::{Against, waive};

use fc_spec::model::Model;

/// Settings of a project that change its generated packages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Packages {
    /// `true` if the packages have an ID type for each entity: `newtypes: true` in `fc.yaml`.
    pub id_types: bool,
}

/// Returns all differences between two models, judged, in the order of the rules.
#[must_use]
pub fn diff(old: &Model, new: &Model) -> Vec<Finding> {
    diff_for(old, new, Packages::default())
}

/// Compares two models as [`diff`] does, for a project with these settings.
#[must_use]
pub fn diff_for(old: &Model, new: &Model, packages: Packages) -> Vec<Finding> {
    diff_since([], old, new, packages)
}

/// Compares two models as [`diff_for`] does, and the new one with earlier releases. `earlier` has their names and
/// models, the last release first. A key that was removed before `old` and has another meaning in `new` is a finding.
#[must_use]
pub fn diff_since<'m>(
    earlier: impl IntoIterator<Item = (&'m str, &'m Model)>,
    old: &Model,
    new: &Model,
    packages: Packages,
) -> Vec<Finding> {
    let mut found = judge::judge(old, new, packages);
    found.extend(history::reused(earlier, old, new));
    found.extend(judge::unannounced(old, new, &found));
    found.sort_by_key(|finding| (finding.rule.number == 0, finding.rule.number));
    let mut seen = std::collections::HashSet::new();
    found.retain(|finding| seen.insert(finding.fingerprint.clone()));
    found
}

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
