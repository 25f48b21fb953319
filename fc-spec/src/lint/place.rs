//! Turns findings into errors and warnings with a place.

use super::finding::Finding;
use super::rule::Level;
use super::settings::Settings;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::index::{DefId, Definitions};
use crate::source::{FileId, Span};
use crate::text;
use std::borrow::Borrow;

/// Returns the findings to show, in the order of their places.
///
/// It leaves out waived findings and findings whose level is off. It calls `places` only if there is a finding to show.
#[must_use]
pub fn faults<P: Borrow<Definitions>>(
    findings: &[Finding],
    settings: &Settings,
    places: impl FnOnce() -> P,
) -> Faults {
    let mut faults = Faults::new();
    let level = |finding: &Finding| settings.level(finding.rule, finding.house.as_deref());
    let shown = findings.iter().filter(|it| it.waived.is_none());
    let shown = shown.map(|finding| (finding, level(finding)));
    let mut shown = shown.filter(|(_, level)| *level != Level::Off).peekable();
    if shown.peek().is_none() {
        return faults;
    }
    let places = places();
    let places = places.borrow();
    faults.extend(shown.map(|(finding, level)| fault(finding, level, places)));
    faults.sort();
    faults
}

fn fault(finding: &Finding, level: Level, places: &Definitions) -> Diagnostic {
    let code = FaultCode::Lint(&finding.rule.code);
    let message = match &finding.house {
        Some(id) => text!("{text}（{id}）", "{text} ({id})", text = finding.message),
        None => finding.message.clone(),
    };
    let at = span(&finding.item, places);
    let mut fault = match level {
        Level::Error => Diagnostic::error(code, at, message),
        Level::Off | Level::Warning => Diagnostic::warning(code, at, message),
    };
    for (item, text) in &finding.also {
        fault = fault.also(span(item, places), text.clone());
    }
    if let Some(note) = &finding.note {
        fault = fault.note(note.clone());
    }
    let id = finding.waiver_id();
    fault.note(text!(
        "要接受这处提示，用编号 {id} 添加豁免",
        "to accept this, add a waiver with the id {id}"
    ))
}

/// Returns the place of a thing. Every thing in a model was read from a file, so the fallback is never used.
fn span(item: &DefId, places: &Definitions) -> Span {
    let place = places.get(item);
    place.map_or(Span::point(FileId(0), 0), |place| place.key)
}
