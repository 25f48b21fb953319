//! Sections as Markdown.

use super::target::table;
use super::{Language, Section};
use std::fmt::Write as _;

/// Returns a section for the terminal, in English.
#[must_use]
pub fn terminal(section: &Section) -> String {
    whole(section, Language::English)
}

fn write(out: &mut String, section: &Section, language: Language) {
    let _ = write!(out, "## {}\n\n{}\n", section.title.get(language), section.about.get(language));
    for table in &section.tables {
        let _ = write!(out, "\n### {}\n\n{}", table.title.get(language), table.markdown(language));
    }
    if !section.targets.is_empty() {
        let table = table(&section.targets);
        let _ = write!(out, "\n### {}\n\n{}", table.title.get(language), table.markdown(language));
    }
    out.push('\n');
}

/// Returns a section without its targets, because the page lists all targets at the top.
#[must_use]
pub fn without_targets(section: &Section, language: Language) -> String {
    let mut out = String::new();
    write(&mut out, &Section { targets: Vec::new(), ..section.clone() }, language);
    out
}

/// Returns a section with its targets.
#[must_use]
pub(crate) fn whole(section: &Section, language: Language) -> String {
    let mut out = String::new();
    write(&mut out, section, language);
    out
}
