//! The limits of an item to audiences, machines and releases, as a page shows them.

use super::desk::Desk;
use fc_spec::model::{Available, Declared};
use serde::Serialize;

/// The limits as sentences or badges.
#[derive(Debug, Default, Serialize)]
pub(super) struct AvailableView {
    /// The names of the audiences for the site's filter; empty for all audiences.
    names: String,
    /// The titles of the audiences.
    audiences: Option<String>,
    /// The titles of the lines of machines.
    hardware: Option<String>,
    /// `ADP 3.8 and later`.
    releases: Vec<String>,
}

impl Desk<'_, '_> {
    /// Returns `None` for an item without limits.
    pub(super) fn available(&self, available: Option<&Available>) -> Option<AvailableView> {
        let available = available?;
        let lang = self.lang;
        let words = &self.book.model.availability;
        let title = |name: &String, declared: Option<&Declared>| {
            declared.map_or_else(|| name.clone(), |it| lang.text(&it.title).to_owned())
        };
        let joined =
            |titles: Vec<String>| (!titles.is_empty()).then(|| titles.join(lang.pick("、", ", ")));
        let audiences = available.audiences.iter();
        let audiences = audiences.map(|name| title(name, words.audience(name)));
        let hardware = available.hardware.iter();
        let hardware = hardware.map(|name| title(name, words.machine(name)));
        let releases = available.releases().map(|(series, first, last)| {
            let series = title(&series.to_owned(), words.series(series));
            match (first, last) {
                (Some(first), Some(last)) => lang.pick(
                    format!("{series} {first} 至 {last}"),
                    format!("{series} {first} to {last}"),
                ),
                (Some(first), None) => lang.pick(
                    format!("{series} {first} 起"),
                    format!("{series} {first} and later"),
                ),
                (None, last) => {
                    let last = last.unwrap_or_default();
                    lang.pick(
                        format!("{series} {last} 及以前"),
                        format!("{series} up to {last}"),
                    )
                }
            }
        });
        Some(AvailableView {
            names: available.audiences.join(" "),
            audiences: joined(audiences.collect()),
            hardware: joined(hardware.collect()),
            releases: releases.collect(),
        })
    }
}
