//! The last line.

use super::super::{Faults, Severity};

/// How many faults there are, in how many files, and how to read more about the first one. `None` if
/// there are none.
#[must_use]
pub fn summary(faults: &Faults) -> Option<String> {
    let first = faults
        .iter()
        .min_by_key(|fault| (fault.severity, fault.primary.span))?;
    let mut files: Vec<_> = faults.iter().map(|fault| fault.primary.span.file).collect();
    files.sort_unstable();
    files.dedup();

    let mut counts = Vec::new();
    for (count, one) in [(faults.errors(), "error"), (faults.warnings(), "warning")] {
        if count > 0 {
            counts.push(counted(count, one));
        }
    }
    let level = match first.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    let shown = match faults.omitted() {
        0 => String::new(),
        _ => format!(", the first {} of them shown", faults.len()),
    };
    Some(format!(
        "{level}: {} in {}{shown}; run `fc explain {}` to read more about the first",
        counts.join(" and "),
        counted(files.len(), "file"),
        first.code,
    ))
}

fn counted(count: usize, one: &str) -> String {
    match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {one}s"),
    }
}
