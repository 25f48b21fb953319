//! The limits of an item to audiences, machines and releases, as a page shows them.

use super::desk::Desk;
use fc_spec::model::{Available, Declared};
use minijinja::{Value, context};

impl Desk<'_, '_> {
    /// Returns the limits as sentences or badges, and the names of the audiences for the site's filter.
    pub(super) fn available(&self, available: Option<&Available>) -> Option<Value> {
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
        Some(context! {
            names => available.audiences.join(" "),
            audiences => joined(audiences.collect()),
            hardware => joined(hardware.collect()),
            releases => releases.collect::<Vec<_>>(),
        })
    }
}
