//! Applies waivers to findings, and reports waivers without effect.

use crate::finding::Finding;
use crate::rules::operations::CODE_REUSED;
use crate::rules::process::{RELEASE, WAIVER_OVER, WAIVER_REFUSED, WAIVER_UNUSED};
use fc_spec::model::Waiver;

/// The prefix of waiver ids for comparisons of versions.
const OURS: &str = "FC07";

/// Returns `true` if a waiver is about a change between versions.
pub(crate) fn is_ours(waiver: &Waiver) -> bool {
    waiver.id.starts_with(OURS)
}

/// The base of the comparison. It decides whether an unused waiver is an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The last release. The findings contain all changes since then.
    Release,
    /// Another version. It may already contain the accepted change.
    Other,
}

/// Marks the findings that waivers accept on a day, `YYYY-MM-DD`. Adds findings about invalid waivers.
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
    // An accepted break counts as announced.
    if !findings.iter().any(Finding::is_break) {
        findings.retain(|it| it.rule.number != RELEASE.number);
    }
    findings.append(&mut wrong);
}

/// Returns `true` for a reused code. Every old peer reads it with its old meaning, and this never ends.
fn is_never_waived(finding: &Finding) -> bool {
    finding.rule.number == CODE_REUSED.number
}
