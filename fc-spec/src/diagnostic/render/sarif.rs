//! Errors as a SARIF 2.1.0 log (OASIS, 2020), which code hosts and editors show next to the lines.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::super::{Diagnostic, FaultCode, Faults};
use crate::model::Lang;
use crate::source::{Sources, Span};

const SCHEMA: &str =
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json";

pub(super) fn render(faults: &Faults, sources: &Sources, lang: Lang) -> String {
    let rules = rules(faults);
    let results: Vec<_> = faults
        .iter()
        .map(|fault| result(fault, &rules, sources, lang))
        .collect();
    let rules: Vec<_> = rules.into_iter().map(|code| rule(code, lang)).collect();
    let log = json!({
        "$schema": SCHEMA,
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "fcproto",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": rules,
            }},
            "columnKind": "unicodeCodePoints",
            "results": results,
        }],
    });
    format!("{log:#}\n")
}

/// Returns the codes that occur, in order.
fn rules(faults: &Faults) -> Vec<FaultCode> {
    let mut codes: Vec<_> = faults.iter().map(|fault| fault.code).collect();
    codes.sort_unstable();
    codes.dedup();
    codes
}

fn rule(code: FaultCode, lang: Lang) -> Value {
    json!({
        "id": code.as_str(),
        "shortDescription": { "text": code.title(lang) },
        "help": {
            "text": match lang {
                Lang::Zh => format!("运行 `fcproto explain {code}`。"),
                Lang::En => format!("Run `fcproto explain {code}`."),
            },
            "markdown": code.explain(lang),
        },
    })
}

fn result(fault: &Diagnostic, rules: &[FaultCode], sources: &Sources, lang: Lang) -> Value {
    let mut text = lang.text(&fault.message).to_owned();
    for line in std::iter::once(&fault.primary.text).chain(&fault.notes) {
        if !line.is_empty() {
            text.push('\n');
            text.push_str(lang.text(line));
        }
    }
    let related: Vec<_> = fault
        .secondary
        .iter()
        .map(|label| {
            json!({
                "physicalLocation": location(label.span, sources),
                "message": { "text": lang.text(&label.text) },
            })
        })
        .collect();
    let fixes: Vec<_> = fault
        .fixes
        .iter()
        .map(|fix| {
            json!({
                "description": { "text": lang.text(&fix.message) },
                "artifactChanges": [{
                    "artifactLocation": artifact(fix.span, sources),
                    "replacements": [{
                        "deletedRegion": region(fix.span, sources),
                        "insertedContent": { "text": fix.replacement },
                    }],
                }],
            })
        })
        .collect();
    json!({
        "ruleId": fault.code.as_str(),
        "ruleIndex": rules.binary_search(&fault.code).unwrap_or_default(),
        "level": fault.severity.name(),
        "message": { "text": text },
        "locations": [{ "physicalLocation": location(fault.primary.span, sources) }],
        "relatedLocations": related,
        "fixes": fixes,
    })
}

fn location(span: Span, sources: &Sources) -> Value {
    json!({
        "artifactLocation": artifact(span, sources),
        "region": region(span, sources),
    })
}

fn artifact(span: Span, sources: &Sources) -> Value {
    json!({ "uri": percent_encoded(sources.path(span)) })
}

fn region(span: Span, sources: &Sources) -> Value {
    let (first, last) = sources.ends(span);
    json!({
        "startLine": first.line,
        "startColumn": first.column,
        "endLine": last.line,
        "endColumn": last.column,
    })
}

/// Returns a path as a relative URI reference (RFC 3986).
fn percent_encoded(path: &str) -> String {
    let mut uri = String::with_capacity(path.len());
    for byte in path.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                uri.push(char::from(byte));
            }
            _ => {
                // Writing to a String cannot fail.
                let _ = write!(uri, "%{byte:02X}");
            }
        }
    }
    uri
}
