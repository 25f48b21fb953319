//! Automatic fixes: finds the fixes that need no review, and applies them.
//!
//! Most fixes of an error are guesses, and a person must review them. A few are certain, because only one correction is possible.
//! [`certain`] identifies these. [`fix_all`] applies them and checks again, until no such fix is left.

use crate::diagnostic::{Diagnostic, FaultCode, Faults, Fix};
use crate::format::Revised;
use crate::model::Text;
use crate::source::{Edits, FileId, Sources, Span};
use crate::syntax::quoted;
use std::collections::BTreeMap;

/// The maximum number of rounds. A fix can reveal further errors, but seldom more than twice in a row.
const ROUNDS: usize = 8;

/// Shorter words are similar to too many others.
const SHORTEST: usize = 4;

/// An applied fix.
#[derive(Clone, Debug)]
pub struct Done {
    /// The code of the fixed error.
    pub code: FaultCode,
    /// The path of the file.
    pub path: String,
    /// The line before the fixes, counted from 1.
    pub line: usize,
    /// A description of the fix.
    pub message: Text,
}

/// A spec with fewer errors than before.
#[derive(Clone, Debug)]
pub struct Fixed {
    /// The files.
    pub sources: Sources,
    /// The applied fixes, in the order of application.
    pub done: Vec<Done>,
}

/// Returns the fix of an error that needs no review, if it has one. It is the only fix of the error, and its kind leaves no choice.
#[must_use]
pub fn certain<'f>(fault: &'f Diagnostic, sources: &Sources) -> Option<&'f Fix> {
    let [fix] = fault.fixes.as_slice() else {
        return None;
    };
    let old = sources.slice(fix.span);
    let bare = old.trim_matches(['"', '\'']);
    let new = fix.replacement.as_str();
    let is_certain = match fault.code {
        // Each of these characters has only one possible meaning here.
        FaultCode::ControlCharacter
        | FaultCode::Tab
        | FaultCode::FullWidth
        | FaultCode::MissingSpace
        | FaultCode::TextSpacing => true,
        // The fix only adds quotes, so that every YAML reader parses a string.
        FaultCode::AmbiguousWord | FaultCode::WrongKind | FaultCode::LeadingZero => {
            new == quoted(old)
        }
        // Only two words are valid here, and other formats write one of them this way.
        FaultCode::BadBool => !bare.chars().all(|c| c.is_ascii_digit()),
        // The fix only removes the quotes.
        FaultCode::BadInteger => new == bare,
        FaultCode::BadCode => hex(bare).is_some_and(|code| hex(new) == Some(code)),
        // The year comes first, so month and day are not ambiguous.
        FaultCode::BadDate => new.get(..4).is_some_and(|year| bare.starts_with(year)),
        FaultCode::UnknownKey | FaultCode::BadWord => is_slip(bare, new),
        _ => false,
    };
    is_certain.then_some(fix)
}

/// Returns the number after `0x`.
fn hex(text: &str) -> Option<u16> {
    let digits = text
        .strip_prefix("0x")
        .or_else(|| text.strip_prefix("0X"))?;
    u16::from_str_radix(digits, 16).ok()
}

/// Returns `true` if one letter is wrong, missing or extra, or two neighbouring letters are swapped.
fn is_slip(old: &str, new: &str) -> bool {
    let distance = strsim::damerau_levenshtein(&old.to_lowercase(), &new.to_lowercase());
    distance <= 1 && old.chars().count() >= SHORTEST
}

/// Applies the certain fixes of the errors that `check` finds, then checks and fixes again.
///
/// Returns the round with the fewest errors and warnings. Returns `None` if no round has fewer than the original.
#[must_use]
pub fn fix_all(sources: &Sources, check: impl Fn(&Sources) -> Faults) -> Option<Fixed> {
    let mut faults = check(sources);
    let before = faults.errors() + faults.warnings();
    let mut fewest = before;
    let mut best = None;
    let mut now = sources.clone();
    let mut done = Vec::new();
    for _ in 0..ROUNDS {
        let fixes = in_files(&faults, &now);
        if fixes.is_empty() {
            break;
        }
        for (file, fixes) in fixes {
            now = with(&now, file, &fixes, &mut done);
        }
        faults = check(&now);
        // A fixed YAML error can reveal others, which the next round may fix.
        let left = faults.errors() + faults.warnings();
        if left < fewest {
            fewest = left;
            best = Some((now.clone(), done.len()));
        }
    }
    let (sources, count) = best?;
    done.truncate(count);
    Some(Fixed { sources, done })
}

/// Returns the [`certain`] fixes of each file with their errors, in the order of their places. Of two overlapping fixes, it keeps the
/// first.
#[must_use]
pub fn in_files<'f>(
    faults: &'f Faults,
    sources: &Sources,
) -> BTreeMap<FileId, Vec<(&'f Diagnostic, &'f Fix)>> {
    let mut files: BTreeMap<FileId, Vec<_>> = BTreeMap::new();
    for fault in faults {
        if let Some(fix) = certain(fault, sources) {
            files.entry(fix.span.file).or_default().push((fault, fix));
        }
    }
    for fixes in files.values_mut() {
        fixes.sort_by_key(|(_, fix)| (fix.span.start, fix.span.end));
        let mut last: Option<Span> = None;
        fixes.retain(|(_, fix)| {
            let is_free = last.is_none_or(|last| {
                last.end < fix.span.start || (last.end == fix.span.start && last != fix.span)
            });
            if is_free {
                last = Some(fix.span);
            }
            is_free
        });
    }
    files
}

/// Returns the files with these fixes applied to one of them.
fn with(
    sources: &Sources,
    file: FileId,
    fixes: &[(&Diagnostic, &Fix)],
    done: &mut Vec<Done>,
) -> Sources {
    let Some(source) = sources.get(file) else {
        return sources.clone();
    };
    let mut edits = Edits::default();
    for (fault, fix) in fixes {
        edits.replace(fix.span, fix.replacement.as_str());
        done.push(Done {
            code: fault.code,
            path: source.path.clone(),
            line: source.line(fix.span.start),
            message: fix.message.clone(),
        });
    }
    Revised::new(sources, source, &edits).sources
}
