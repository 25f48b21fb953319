//! Fixes that can be made without asking anybody.
//!
//! Most fixes of a fault are guesses, which a person has to look at. A few are certain: there is one thing that can be meant, and it is the
//! same whoever is asked. [`certain`] says which; [`fix_all`] makes them, looks again, and goes on until there is none left.

use crate::diagnostic::{Diagnostic, FaultCode, Faults, Fix};
use crate::format::edited;
use crate::model::Text;
use crate::source::{Edits, FileId, SourceFile, Sources, Span};
use crate::syntax::quoted;
use std::collections::BTreeMap;

/// Times that faults are looked for and fixed: one hides another seldom more than twice.
const ROUNDS: usize = 8;

/// Shorter words are near to too many others.
const SHORTEST: usize = 4;

/// A fix that was made.
#[derive(Clone, Debug)]
pub struct Done {
    /// Of what.
    pub code: FaultCode,
    /// Path of the file.
    pub path: String,
    /// Line, counted from 1, in the file as it was before.
    pub line: usize,
    /// What it did.
    pub message: Text,
}

/// A spec with fewer faults than before.
#[derive(Clone, Debug)]
pub struct Fixed {
    /// Its files.
    pub sources: Sources,
    /// What was done, in the order in which it was done.
    pub done: Vec<Done>,
}

/// The fix of a fault that nobody has to look at, if it has one: the only one, and of a kind that leaves no choice.
#[must_use]
pub fn certain<'f>(fault: &'f Diagnostic, sources: &Sources) -> Option<&'f Fix> {
    let [fix] = fault.fixes.as_slice() else {
        return None;
    };
    let old = sources.slice(fix.span);
    let bare = old.trim_matches(['"', '\'']);
    let new = fix.replacement.as_str();
    let is_certain = match fault.code {
        // Characters that mean nothing here but one other.
        FaultCode::ControlCharacter
        | FaultCode::Tab
        | FaultCode::FullWidth
        | FaultCode::MissingSpace
        | FaultCode::TextSpacing => true,
        // The same in quotes, so that every reader takes it for a text.
        FaultCode::AmbiguousWord | FaultCode::WrongKind | FaultCode::LeadingZero => {
            new == quoted(old)
        }
        // Only two words may stand there, and this is one of them elsewhere.
        FaultCode::BadBool => !bare.chars().all(|c| c.is_ascii_digit()),
        // The same without quotes.
        FaultCode::BadInteger => new == bare,
        FaultCode::BadCode => hex(bare).is_some_and(|code| hex(new) == Some(code)),
        // The year stands first, so that month and day cannot be taken for one another.
        FaultCode::BadDate => new.get(..4).is_some_and(|year| bare.starts_with(year)),
        FaultCode::UnknownKey | FaultCode::BadWord => is_slip(bare, new),
        _ => false,
    };
    is_certain.then_some(fix)
}

/// The number behind `0x`.
fn hex(text: &str) -> Option<u16> {
    let digits = text
        .strip_prefix("0x")
        .or_else(|| text.strip_prefix("0X"))?;
    u16::from_str_radix(digits, 16).ok()
}

/// Whether one letter is wrong, missing, too many, or has changed places with the next one.
fn is_slip(old: &str, new: &str) -> bool {
    let distance = strsim::damerau_levenshtein(&old.to_lowercase(), &new.to_lowercase());
    distance <= 1 && old.chars().count() >= SHORTEST
}

/// Makes all fixes that are certain, of what `check` finds in the files, and again of what it finds then. `None` if that leaves as
/// many faults as there were.
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
        // Behind a fault of the YAML there may be others, which are only seen now; they may be fixed in the next round.
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

/// The [`certain`] fixes of each file with their faults, in the order of their places; of two that overlap, the first.
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

/// The files with these fixes made in one of them.
fn with(
    sources: &Sources,
    file: FileId,
    fixes: &[(&Diagnostic, &Fix)],
    done: &mut Vec<Done>,
) -> Sources {
    let mut changed = sources.clone();
    let Some(source) = sources.get(file) else {
        return changed;
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
    changed.replace(SourceFile::new(&source.path, edited(source, &edits).text));
    changed
}
