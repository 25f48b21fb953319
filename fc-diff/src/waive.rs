//! Waivers applied: which findings the owner has accepted, and which waivers accept nothing.

use crate::finding::Finding;
use crate::rules::operations::CODE_REUSED;
use crate::rules::process::{RELEASE, WAIVER_OVER, WAIVER_REFUSED, WAIVER_UNUSED};
use fc_spec::model::Waiver;

/// What the ids of waivers for this comparison begin with; those of others are for others.
const OURS: &str = "FC07";

/// Whether a waiver is about a change between versions.
#[must_use]
pub fn is_ours(waiver: &Waiver) -> bool {
    waiver.id.starts_with(OURS)
}

/// Against what was compared, which decides what can be said of a waiver that accepts nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The last release. All that has changed since is among the findings.
    Release,
    /// Another version, in which the accepted change may have happened already.
    Other,
}

/// Marks the findings that waivers accept on a day, `YYYY-MM-DD`, and adds what is wrong with the waivers.
pub fn waive(findings: &mut Vec<Finding>, waivers: &[Waiver], today: &str, against: Against) {
    let mut wrong = Vec::new();
    for waiver in waivers.iter().filter(|it| is_ours(it)) {
        let about = |rule| Finding::new(rule, &waiver.id, ["", ""]).is("waiver", &waiver.id);
        let finding = findings.iter_mut().find(|it| it.waiver_id() == waiver.id);
        match finding {
            Some(finding) if is_never_waived(finding) => wrong.push(about(&WAIVER_REFUSED)),
            Some(_) if waiver.is_over(today) => wrong.push(
                Finding::new(&WAIVER_OVER, &waiver.id, ["", &waiver.until])
                    .is("waiver", &waiver.id),
            ),
            Some(finding) => finding.waived = Some(waiver.clone()),
            None if against == Against::Release => wrong.push(about(&WAIVER_UNUSED)),
            None => {}
        }
    }
    // Breaks that are accepted are announced.
    if !findings.iter().any(Finding::is_break) {
        findings.retain(|it| it.rule.number != RELEASE.number);
    }
    findings.append(&mut wrong);
}

/// A code that once meant something else is read as that by every old peer, and no date ends that.
fn is_never_waived(finding: &Finding) -> bool {
    finding.rule.number == CODE_REUSED.number
}
