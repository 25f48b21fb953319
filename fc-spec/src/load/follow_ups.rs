//! Suppresses errors that only follow from other errors.
//!
//! A check reports missing, unused or mismatched things. The cause may be a part that was skipped because of an earlier
//! error, or a spelling that an earlier error already corrects. Then the result is unknown and the check stays silent.
//! It reports again after the first error is fixed.

use super::draft::Draft;
use crate::diagnostic::{FaultCode, Faults};
use crate::language::grammar::{COMMON, SOURCE};
use crate::source::{Sources, Span};
use std::collections::HashSet;

/// The earlier errors, in a form that shows which others follow from them.
pub(super) struct Earlier<'s> {
    sources: &'s Sources,
    /// The places of the errors.
    places: Vec<Span>,
    /// The places of errors about missing keys.
    incomplete: Vec<Span>,
    /// The skipped parts of the files.
    hidden: Vec<Span>,
    /// The words in the skipped parts.
    words: HashSet<&'s str>,
    /// The suggested replacements, normalized by [`loosely`].
    suggested: HashSet<String>,
    /// The spans of operations and types.
    entries: Vec<Span>,
}

/// Errors about unknown names. Any other error about such a name would be redundant.
const NAMES_NOTHING: &[FaultCode] = &[FaultCode::UnknownType, FaultCode::UnknownValue];

/// Errors about paths. Each key of a path may be in a skipped part.
const PATHS: &[FaultCode] = &[FaultCode::UnknownField, FaultCode::GovernsNothing];

/// Errors that compare distant parts of one operation or type. The result is unknown if any part is malformed.
const WITHIN_ENTRY: &[FaultCode] = &[
    FaultCode::GovernedFact,
    FaultCode::UnreachedState,
    FaultCode::UnknownField,
];

/// Errors about missing or unused things, in addition to those of [`FaultCode::DECLARED`].
const ABSENT: &[FaultCode] = &[
    FaultCode::UnknownOperation,
    FaultCode::NotAReport,
    FaultCode::NotACommand,
    FaultCode::UnknownConflict,
    FaultCode::UnansweredConflict,
];

impl<'s> Earlier<'s> {
    /// Collects the errors so far.
    pub fn new(draft: &Draft<'_>, sources: &'s Sources, faults: &Faults) -> Self {
        let is_missing =
            |code| matches!(code, FaultCode::MissingKey | FaultCode::MissingTranslation);
        let (missing, places): (Vec<_>, Vec<_>) = faults
            .iter()
            .map(|fault| (fault.code, fault.primary.span))
            .partition(|(code, _)| is_missing(*code));
        let places = places.into_iter().map(|(_, place)| place);
        // A span over several lines contains more than the error.
        let places = places.filter(|place| !sources.slice(*place).contains('\n'));
        let operations = draft.operations.iter().map(|operation| operation.origin);
        let types = draft.types.iter().map(|ty| ty.origin);
        let entries = operations.chain(types);
        let hidden = faults.hidden().to_vec();
        let words = hidden.iter().flat_map(|text| words(sources.slice(*text)));
        Self {
            sources,
            words: words.collect(),
            suggested: suggested(faults).map(|text| loosely(&text)).collect(),
            entries: entries
                .map(|place| place.name().to(place.node.span()))
                .collect(),
            places: places.collect(),
            incomplete: missing.into_iter().map(|(_, place)| place).collect(),
            hidden,
        }
    }

    /// Removes new errors that follow from others.
    pub fn suppress(mut self, found: &mut Faults) {
        // Error codes and the suggested name, if any.
        let names: Vec<(FaultCode, Option<String>)> = found
            .iter()
            .map(|fault| {
                (
                    fault.code,
                    fault.fixes.first().map(|fix| fix.replacement.clone()),
                )
            })
            .collect();
        let unknown: Vec<Span> = found
            .iter()
            .filter(|fault| NAMES_NOTHING.contains(&fault.code))
            .map(|fault| fault.primary.span)
            .collect();
        let faulty: Vec<Span> = self
            .entries
            .iter()
            .filter(|entry| {
                let mut places = self.places.iter().chain(&unknown);
                places.any(|place| is_within(*place, **entry))
            })
            .copied()
            .collect();
        found.retain(|fault| {
            let (code, at) = (fault.code, fault.primary.span);
            let lies_in = |places: &[Span]| places.iter().any(|place| is_within(at, *place));
            let is_said = lies_in(&self.places)
                || lies_in(&self.hidden)
                || (code == FaultCode::EmptyEnum && lies_in(&self.incomplete))
                || (!NAMES_NOTHING.contains(&code) && lies_in(&unknown));
            let is_meant = FaultCode::DECLARED.iter().any(|[unknown, unused]| {
                let name = subject(self.sources.slice(at));
                *unused == code
                    && names.iter().any(|(code, meant)| {
                        code == unknown && meant.as_deref().is_none_or(|meant| meant == name)
                    })
            });
            let is_of_section = match code {
                FaultCode::SectionGap => self.words.contains(SOURCE.sections.name),
                FaultCode::UnusedAvailability => self.words.contains(COMMON.available.name),
                _ => false,
            };
            let is_of_entry = WITHIN_ENTRY.contains(&code) && lies_in(&faulty);
            let is_path = PATHS.contains(&code)
                && words(self.sources.slice(at)).any(|word| self.words.contains(word));
            let follows = is_said || is_meant || is_of_section || is_of_entry || is_path;
            !(follows || self.is_absent_only_here(code, at))
        });
        self.keep_used(found);
    }

    /// Returns `true` if a missing thing may be in a skipped part, or is a suggested replacement.
    fn is_absent_only_here(&self, code: FaultCode, at: Span) -> bool {
        let subject = subject(self.sources.slice(at));
        let is_known = self.words.contains(subject) || self.suggested.contains(&loosely(subject));
        let is_absent =
            ABSENT.contains(&code) || FaultCode::DECLARED.as_flattened().contains(&code);
        is_absent && is_known
    }

    /// Removes errors about unused types that a skipped part may use, directly or through another unused type.
    fn keep_used(&mut self, found: &mut Faults) {
        if self.hidden.is_empty() {
            return;
        }
        let unused = |found: &Faults| -> HashSet<Span> {
            let unused = found
                .iter()
                .filter(|fault| fault.code == FaultCode::UnusedType);
            unused.map(|fault| fault.primary.span).collect()
        };
        let mut known = HashSet::new();
        loop {
            let left = unused(found);
            let used: Vec<Span> = self
                .entries
                .iter()
                .filter(|entry| {
                    let mut words = words(self.sources.slice(**entry));
                    let is_named = words.next().is_some_and(|name| self.words.contains(name));
                    is_named && known.insert(**entry)
                })
                .copied()
                .collect();
            for entry in used {
                self.words.extend(words(self.sources.slice(entry)));
            }
            found.retain(|fault| {
                fault.code != FaultCode::UnusedType
                    || !self
                        .words
                        .contains(subject(self.sources.slice(fault.primary.span)))
            });
            if unused(found) == left {
                return;
            }
        }
    }
}

fn suggested(faults: &Faults) -> impl Iterator<Item = String> {
    let fixes = faults.iter().flat_map(|fault| &fault.fixes);
    fixes.map(|fix| fix.replacement.clone())
}

/// Returns the name in the text that an error points at.
fn subject(text: &str) -> &str {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    text.trim_matches(|c| !is_part(c))
}

/// Returns a name without underscores and in lower case.
fn loosely(name: &str) -> String {
    name.replace('_', "").to_lowercase()
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .filter(|word| !word.is_empty())
}

/// Returns `true` if `inner` lies in `outer`. An empty span lies only in an equal one.
fn is_within(inner: Span, outer: Span) -> bool {
    let is_empty = inner.start == inner.end;
    inner.file == outer.file
        && outer.start <= inner.start
        && inner.end <= outer.end
        && (!is_empty || inner == outer)
}
