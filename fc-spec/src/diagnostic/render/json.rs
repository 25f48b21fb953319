//! Errors for machines: one JSON object per line.

use serde::Serialize;

use super::super::{Diagnostic, Faults};
use crate::model::Lang;
use crate::source::{Sources, Span};

pub(super) fn render(faults: &Faults, sources: &Sources, lang: Lang) -> String {
    let mut out = String::new();
    for fault in faults {
        // Strings and numbers always serialize.
        let line = serde_json::to_string(&Fault::new(fault, sources, lang)).unwrap_or_default();
        out.push_str(&line);
        out.push('\n');
    }
    out
}

#[derive(Serialize)]
struct Fault<'a> {
    code: &'static str,
    severity: &'static str,
    title: &'static str,
    message: &'a str,
    primary: Location<'a>,
    secondary: Vec<Location<'a>>,
    notes: Vec<&'a str>,
    fixes: Vec<Fix<'a>>,
}

#[derive(Serialize)]
struct Location<'a> {
    path: &'a str,
    line: usize,
    column: usize,
    end_line: usize,
    end_column: usize,
    start: usize,
    end: usize,
    label: &'a str,
}

#[derive(Serialize)]
struct Fix<'a> {
    message: &'a str,
    replacement: &'a str,
    place: Location<'a>,
}

impl<'a> Fault<'a> {
    fn new(fault: &'a Diagnostic, sources: &'a Sources, lang: Lang) -> Self {
        Self {
            code: fault.code.as_str(),
            severity: fault.severity.name(),
            title: fault.code.title(lang),
            message: lang.text(&fault.message),
            primary: Location::new(fault.primary.span, lang.text(&fault.primary.text), sources),
            secondary: fault
                .secondary
                .iter()
                .map(|label| Location::new(label.span, lang.text(&label.text), sources))
                .collect(),
            notes: fault.notes.iter().map(|note| lang.text(note)).collect(),
            fixes: fault
                .fixes
                .iter()
                .map(|fix| Fix {
                    message: lang.text(&fix.message),
                    replacement: &fix.replacement,
                    place: Location::new(fix.span, "", sources),
                })
                .collect(),
        }
    }
}

impl<'a> Location<'a> {
    fn new(span: Span, label: &'a str, sources: &'a Sources) -> Self {
        let (first, last) = sources.ends(span);
        Self {
            path: sources.path(span),
            line: first.line,
            column: first.column,
            end_line: last.line,
            end_column: last.column,
            start: span.start,
            end: span.end,
            label,
        }
    }
}
