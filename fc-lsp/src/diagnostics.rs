//! What is wrong, as an editor shows it.

use crate::snapshot::Snapshot;
use crate::uri;
use fc_spec::diagnostic::{Diagnostic, Severity};
use fc_spec::model::Lang;
use gen_lsp_types as lsp;
use std::collections::BTreeMap;

/// Who says so.
const SOURCE: &str = "fc";

/// What is wrong in each file of which anything is, by what the client calls it: in those of the spec, and where the project says
/// what the lint is to look for.
#[must_use]
pub fn diagnostics(snapshot: &Snapshot) -> BTreeMap<String, Vec<lsp::Diagnostic>> {
    let mut files: BTreeMap<String, Vec<lsp::Diagnostic>> = BTreeMap::new();
    for fault in &snapshot.analysis().faults {
        if let Some(uri) = snapshot.uri(fault.primary.span.file) {
            let file = files.entry(uri.0.clone()).or_default();
            file.push(diagnostic(snapshot, fault));
        }
    }
    let project = &snapshot.project;
    let lint = project.lint();
    for fault in &lint.faults {
        let span = fault.primary.span;
        if let Some(file) = lint.files.get(span.file) {
            let range = snapshot.settings.encoding.range(file, span);
            let uri = uri::of_path(&project.root.join(&file.path));
            let told = files.entry(uri).or_default();
            told.push(shown(snapshot.settings.lang, fault, range));
        }
    }
    files
}

/// A fault of the spec.
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
        related_information: (!related.is_empty()).then_some(related),
        ..shown(lang, fault, snapshot.range(fault.primary.span))
    }
}

/// A fault with no other places.
fn shown(lang: Lang, fault: &Diagnostic, range: lsp::Range) -> lsp::Diagnostic {
    lsp::Diagnostic {
        range,
        severity: Some(match fault.severity {
            Severity::Error => lsp::DiagnosticSeverity::Error,
            Severity::Warning => lsp::DiagnosticSeverity::Warning,
        }),
        code: Some(fault.code.to_string().into()),
        source: Some(SOURCE.to_owned()),
        message: text(fault, lang).into(),
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
