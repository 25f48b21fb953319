//! How the change is made.

use super::Judge;
use crate::finding::Finding;
use crate::rules::process::RELEASE;

impl Judge<'_> {
    /// A break without another version of the protocol.
    pub(super) fn process(&mut self) {
        let (old, new) = (&self.old.protocol.version, &self.new.protocol.version);
        if old == new && self.found.iter().any(|it| !it.wire.is_empty()) {
            let finding = Finding::new(&RELEASE, "protocol.version", [old, new]);
            self.report(finding.at("protocol", "protocol"));
        }
    }
}
