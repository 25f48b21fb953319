//! The limits of an item to audiences, machines and releases, as a page shows them.

use fc_spec::model::Lang;
use fc_spec::model::{Available, Declared, Model};
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

impl AvailableView {
    /// Returns `None` for an item without limits.
    pub(super) fn of(model: &Model, available: Option<&Available>, lang: Lang) -> Option<Self> {
        let available = available?;
        let words = &model.availability;
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
        Some(Self {
            names: available.audiences.join(" "),
            audiences: joined(audiences.collect()),
            hardware: joined(hardware.collect()),
            releases: releases.collect(),
        })
    }
}
