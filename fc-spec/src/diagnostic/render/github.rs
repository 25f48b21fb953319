//! Errors as GitHub workflow commands. A job prints them, and the pull request shows them.

use std::fmt::Write as _;

use super::super::Faults;
use crate::model::Lang;
use crate::source::Sources;

pub(super) fn render(faults: &Faults, sources: &Sources, lang: Lang) -> String {
    let mut out = String::new();
    for fault in faults {
        let (first, last) = sources.ends(fault.primary.span);
        let command = fault.severity.name();
        let path = property(sources.path(fault.primary.span));
        let colon = lang.pick("：", ": ");
        let title = fault.code.title(lang);
        let title = property(&format!("{}{colon}{title}", fault.code));
        let place = if first.line == last.line {
            format!(
                "line={},col={},endColumn={}",
                first.line, first.column, last.column
            )
        } else {
            // The format has columns only for annotations of one line.
            format!("line={},endLine={}", first.line, last.line)
        };

        let mut text = lang.text(&fault.message).to_owned();
        if !fault.primary.text.is_empty() {
            text += colon;
            text += lang.text(&fault.primary.text);
        }
        for label in &fault.secondary {
            let at = sources.line_col(label.span);
            let path = sources.path(label.span);
            text = format!(
                "{text}\n{path}:{}:{}: {}",
                at.line,
                at.column,
                lang.text(&label.text)
            );
        }
        for note in fault
            .notes
            .iter()
            .chain(fault.fixes.iter().map(|fix| &fix.message))
        {
            text = format!("{text}\n{}", lang.text(note));
        }
        let text = data(&text);
        // Writing to a String cannot fail.
        let _ = writeln!(out, "::{command} file={path},{place},title={title}::{text}");
    }
    out
}

fn data(text: &str) -> String {
    text.replace('%', "%25")
        .replace('\r', "%0D")
        .replace('\n', "%0A")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}
