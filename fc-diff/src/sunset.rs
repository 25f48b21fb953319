//! Reports operations that were removed before their `sunset`.

use crate::finding::Finding;
use crate::matching::{Pair, operations};
use crate::rules::process::RELEASE;
use fc_spec::model::{Model, is_past};

/// Returns a finding for each operation that the new version lacks although its `sunset` is not over on a day,
/// `YYYY-MM-DD`.
#[must_use]
pub fn gone_early(old: &Model, new: &Model, today: &str) -> Vec<Finding> {
    let gone = operations(old, new).into_iter().filter_map(|pair| {
        let Pair::Removed(operation) = pair else {
            return None;
        };
        let sunset = operation.deprecated.as_ref()?.sunset.as_deref()?;
        let finding = Finding::new(&RELEASE, &operation.name, [sunset, ""]);
        let finding = finding.was(operation.kind().name(), &operation.name);
        (!is_past(sunset, today)).then_some(finding)
    });
    gone.collect()
}
