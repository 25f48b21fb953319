//! Findings as faults: each with its level and its place.

use super::finding::Finding;
use super::rule::Level;
use super::settings::Settings;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::{Item, Places};
use crate::model::Text;
use crate::syntax::{FileId, Span};

/// A language of the texts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lang {
    /// English.
    #[default]
    En,
    /// Chinese.
    Zh,
}

impl Lang {
    fn of(self, text: &Text) -> &str {
        match self {
            Self::En => &text.en,
            Self::Zh => &text.zh,
        }
    }
}

/// What is to be shown of the findings: those that no waiver accepts and whose level is not off, in the order of their places. Places
/// are only asked for if there is anything to be shown.
#[must_use]
pub fn faults(
    findings: &[Finding],
    settings: &Settings,
    places: impl FnOnce() -> Places,
    lang: Lang,
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
    faults.extend(shown.map(|(finding, level)| fault(finding, level, &places, lang)));
    faults.sort();
    faults
}

fn fault(finding: &Finding, level: Level, places: &Places, lang: Lang) -> Diagnostic {
    let code = FaultCode::Lint(finding.rule);
    let message = lang.of(&finding.message);
    let message = match &finding.house {
        Some(id) => format!("{message} ({id})"),
        None => message.to_owned(),
    };
    let at = span(&finding.item, places);
    let mut fault = match level {
        Level::Error => Diagnostic::error(code, at, message),
        Level::Off | Level::Warning => Diagnostic::warning(code, at, message),
    };
    for (item, text) in &finding.also {
        fault = fault.also(span(item, places), lang.of(text));
    }
    if let Some(note) = &finding.note {
        fault = fault.note(lang.of(note));
    }
    let id = finding.waiver_id();
    fault.note(match lang {
        Lang::En => format!("a waiver of this has the id {id}"),
        Lang::Zh => format!("豁免编号：{id}"),
    })
}

/// Where a thing is written. All that a model has is in the files that it was read from.
fn span(item: &Item, places: &Places) -> Span {
    let place = places.get(item);
    place.map_or(Span::point(FileId(0), 0), |place| place.key)
}
