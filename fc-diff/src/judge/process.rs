//! Judges the announcement of a change.

use super::Judge;
use crate::finding::Finding;
use crate::release::VERSION;
use crate::rules::process::RELEASE;
use fc_spec::model::{Model, Operation, is_past};

impl Judge<'_> {
    /// Reports a `sunset` that moved to an earlier date. A later date and a missing date need no finding.
    pub(super) fn sunset(&mut self, old: &Operation, new: &Operation) {
        let sunset = |it: &Operation| it.deprecated.clone().and_then(|it| it.sunset);
        let (Some(before), Some(after)) = (sunset(old), sunset(new)) else {
            return;
        };
        // A month lasts until its end, so a day in it is earlier.
        let is_within = after.len() > before.len() && after.starts_with(&before);
        if is_past(&after, &before) || is_within {
            let subject = format!("{}.deprecated.sunset", new.name);
            let finding = Finding::new(&RELEASE, subject, [&before, &after]);
            self.report(finding.between(old, new));
            self.claim(&["operations", &new.name, "deprecated", "sunset"]);
        }
    }
}

/// Returns a finding if messages break and the version of the protocol is the same.
pub(crate) fn unannounced(old: &Model, new: &Model, found: &[Finding]) -> Option<Finding> {
    let (old, new) = (&old.protocol.version, &new.protocol.version);
    let is_broken = found.iter().any(|it| !it.wire.is_empty());
    (old == new && is_broken).then(|| {
        let finding = Finding::new(&RELEASE, VERSION, [old, new]);
        finding.at("protocol", "protocol")
    })
}
