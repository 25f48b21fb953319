//! Diagnostics in the form of the protocol.

use crate::snapshot::Snapshot;
use crate::uri;
use fc_spec::diagnostic::{Diagnostic, Severity};
use fc_spec::model::Lang;
use fc_spec::source::Span;
use gen_lsp_types as lsp;
use std::collections::BTreeMap;

/// The source that diagnostics name.
const SOURCE: &str = "fcproto";

/// Returns the diagnostics of each file that has any, by the file's URI. The files are those of the spec and those with
/// lint settings.
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
    let locate = |span: Span| {
        let file = lint.files.get(span.file)?;
        Some(lsp::Location {
            uri: uri::of_path(&project.root.join(&file.path)).into(),
            range: snapshot.settings.encoding.range(file, span),
        })
    };
    for fault in &lint.faults {
        if let Some(location) = locate(fault.primary.span) {
            let file = files.entry(location.uri.0).or_default();
            file.push(shown(fault, snapshot.settings.lang, locate));
        }
    }
    files
}

pub fn diagnostic(snapshot: &Snapshot, fault: &Diagnostic) -> lsp::Diagnostic {
    shown(fault, snapshot.settings.lang, |span| {
        snapshot.location(span)
    })
}

/// Converts a diagnostic. `locate` maps each of its spans to a location.
fn shown(
    fault: &Diagnostic,
    lang: Lang,
    locate: impl Fn(Span) -> Option<lsp::Location>,
) -> lsp::Diagnostic {
    let related = fault.secondary.iter().filter_map(|label| {
        Some(lsp::DiagnosticRelatedInformation {
            location: locate(label.span)?,
            message: lang.text(&label.text).to_owned(),
        })
    });
    let related: Vec<_> = related.collect();
    lsp::Diagnostic {
        range: locate(fault.primary.span).map_or_else(lsp::Range::default, |it| it.range),
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

/// Returns the message of a diagnostic in a language, followed by its notes on separate lines.
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
