//! What changed between two versions of a protocol, and for whom it breaks.
//!
//! ```text
//! old Model ─┐               ┌─ matching: operations, types and fields that are the same thing in both
//!            ├──► diff ──────┼─ judge: the rules, by section; each claims the paths that it has judged
//! new Model ─┘               └─ rest: whatever else differs between the two dumps, so that nothing goes unsaid
//! ```
//!
//! A message has a sender and a receiver: of a command's request the sender is the app, of its response and of a report the
//! robot, of an acknowledgement the app. A rule says whether messages from old senders break at new receivers, or the
//! reverse; a finding says it of the [deployments](Deployment): old apps with new robots, new apps with old robots.
//!
//! **Architecture invariant.** No finding means that the two dumps are equal, but for the places of things in files and for
//! waivers, which are about a comparison and not about the protocol.

mod changelog;
mod finding;
mod history;
mod judge;
mod matching;
pub mod release;
mod render;
mod rest;
mod rule;
mod rules;
mod sunset;
mod version;
mod waive;

pub use changelog::{first_section, section, with_section};
pub use fc_spec::model::Lang;
pub use finding::{Deployment, Finding, Senders, Spot};
pub use render::{Format, render, stands_in};
pub use rule::{About, Language, Rule, Wire};
pub use sunset::gone_early;
pub use version::{Version, VersionError};
pub use waive::{Against, is_ours, waive};

use fc_spec::model::Model;

/// Settings of a project that change its generated packages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Packages {
    /// Rust and Python have a type for the IDs of each entity: `newtypes: true` in `fc.yaml`.
    pub id_types: bool,
}

/// Everything that differs between two models, judged, in the order of the rules.
#[must_use]
pub fn diff(old: &Model, new: &Model) -> Vec<Finding> {
    diff_for(old, new, Packages::default())
}

/// Compares two models as [`diff`] does, for a project with these settings.
#[must_use]
pub fn diff_for(old: &Model, new: &Model, packages: Packages) -> Vec<Finding> {
    diff_since([], old, new, packages)
}

/// Compares two models as [`diff_for`] does, and the new one with earlier releases, by name and the last one first. A key
/// that was removed before `old` and has another meaning in `new` is a finding.
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

/// Its examples compile.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
