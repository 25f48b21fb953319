//! Applies waivers to findings, and reports waivers that are unused or expired.

use super::finding::Finding;
use super::project_rules::{WAIVER_OVER, WAIVER_UNUSED};
use super::search::of_waiver;
use crate::model::Waiver;
use crate::text;

/// The prefix of the ids of lint waivers. Other checks handle the other waivers.
const OURS: &str = "FC08";

/// Marks the findings that a waiver accepts on a day, `YYYY-MM-DD`. Adds findings about unused and expired waivers.
pub fn waive(findings: &mut Vec<Finding>, waivers: &[Waiver], today: &str) {
    let mut wrong = Vec::new();
    for waiver in waivers.iter().filter(|it| it.id.starts_with(OURS)) {
        let (id, until) = (&waiver.id, &waiver.until);
        let item = of_waiver(id);
        match findings.iter_mut().find(|it| it.waiver_id() == *id) {
            Some(_) if waiver.is_over(today) => wrong.push(Finding::new(
                WAIVER_OVER,
                item,
                text!(
                    "豁免已过期，期限到 {until} 为止",
                    "the waiver expired: it was valid until {until}"
                ),
            )),
            Some(finding) => finding.waived = Some(waiver.clone()),
            None => wrong.push(Finding::new(
                WAIVER_UNUSED,
                item,
                text!(
                    "这条豁免没有对应的提示",
                    "the lint has no finding for this waiver"
                ),
            )),
        }
    }
    findings.append(&mut wrong);
}
