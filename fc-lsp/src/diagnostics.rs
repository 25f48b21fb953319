//! What is wrong, as an editor shows it.

use crate::snapshot::Snapshot;
use fc_spec::diagnostic::{Diagnostic, Severity};
use fc_spec::model::Lang;
use fc_spec::syntax::FileId;
use gen_lsp_types as lsp;
use std::collections::BTreeMap;

/// Who says so.
const SOURCE: &str = "fc";

/// What is wrong in each file of which anything is.
#[must_use]
pub fn diagnostics(snapshot: &Snapshot) -> BTreeMap<FileId, Vec<lsp::Diagnostic>> {
    let mut files: BTreeMap<FileId, Vec<lsp::Diagnostic>> = BTreeMap::new();
    for fault in &snapshot.analysis().faults {
        let file = files.entry(fault.primary.span.file).or_default();
        file.push(diagnostic(snapshot, fault));
    }
    files
}

/// A fault.
pub fn diagnostic(snapshot: &Snapshot, fault: &Diagnostic) -> lsp::Diagnostic {
    let lang = snapshot.settings.lang;
    let related = fault.secondary.iter().filter_map(|label| {
        Some(lsp::DiagnosticRelatedInformation {
            location: snapshot.location(label.span)?,
            message: lang.text(&label.text).to_owned(),
        })
    });
    let related: Vec<_> = related.collect();
    lsp::Diagnostic {
        range: snapshot.range(fault.primary.span),
        severity: Some(match fault.severity {
            Severity::Error => lsp::DiagnosticSeverity::Error,
            Severity::Warning => lsp::DiagnosticSeverity::Warning,
        }),
        code: Some(fault.code.to_string().into()),
        source: Some(SOURCE.to_owned()),
        message: text(fault, lang).into(),
        related_information: (!related.is_empty()).then_some(related),
        ..lsp::Diagnostic::default()
    }
}

/// What a fault says in a language, with what to do about it on lines of its own.
#[must_use]
pub fn text(fault: &Diagnostic, lang: Lang) -> String {
    let mut text = lang.text(&fault.message).to_owned();
    if !fault.primary.text.is_empty() {
        text.push_str(lang.pick("：", ": "));
        text.push_str(lang.text(&fault.primary.text));
    }
    for note in &fault.notes {
        text.push('\n');
        text.push_str(lang.text(note));
    }
    text
}
