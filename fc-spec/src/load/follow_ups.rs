//! Faults that follow from others.
//!
//! A step reports what is missing, unused or does not fit. What it looks for may stand in a text that is not read because
//! of a fault of an earlier step, or is what an earlier fault says to write: then nothing is known, and nothing is said.
//! Once the first fault is mended, what is left shows up.

use super::draft::Draft;
use crate::diagnostic::{FaultCode, Faults};
use crate::language::grammar::{COMMON, SOURCE};
use crate::source::{Sources, Span};
use std::collections::HashSet;

/// What has been reported, as far as others may follow from it.
pub(super) struct Earlier<'s> {
    sources: &'s Sources,
    /// Where the faults are.
    places: Vec<Span>,
    /// The names of what lacks a key.
    incomplete: Vec<Span>,
    /// Texts that are not read.
    hidden: Vec<Span>,
    /// The words in those texts.
    words: HashSet<&'s str>,
    /// What the faults say to write, [`loosely`].
    suggested: HashSet<String>,
    /// Operations and types.
    entries: Vec<Span>,
}

/// Names that stand for nothing: whatever else is said of them is said in vain.
const NAMES_NOTHING: &[FaultCode] = &[FaultCode::UnknownType, FaultCode::UnknownValue];

/// Faults of paths, each part of which may be in a text that is not read.
const PATHS: &[FaultCode] = &[FaultCode::UnknownField, FaultCode::GovernsNothing];

/// Faults that compare parts of an operation or type that stand far apart in it: what one of them says is not known
/// where any is malformed.
const WITHIN_ENTRY: &[FaultCode] = &[
    FaultCode::GovernedFact,
    FaultCode::UnreachedState,
    FaultCode::UnknownField,
];

/// What is unknown, and what may be meant by it if it is unused.
const UNKNOWN: [(FaultCode, FaultCode); 5] = [
    (
        FaultCode::UnknownAvailability,
        FaultCode::UnusedAvailability,
    ),
    (FaultCode::UnknownType, FaultCode::UnusedType),
    (FaultCode::UnknownEntity, FaultCode::UnusedEntity),
    (FaultCode::UnknownStore, FaultCode::UnusedStore),
    (FaultCode::UnknownCoordinates, FaultCode::UnusedCoordinates),
];

/// Faults that say that something is missing, or not used.
const ABSENT: &[FaultCode] = &[
    FaultCode::UnknownType,
    FaultCode::UnusedType,
    FaultCode::UnknownOperation,
    FaultCode::NotAReport,
    FaultCode::NotACommand,
    FaultCode::UnknownEntity,
    FaultCode::UnusedEntity,
    FaultCode::UnknownStore,
    FaultCode::UnusedStore,
    FaultCode::UnknownCoordinates,
    FaultCode::UnusedCoordinates,
    FaultCode::UnknownAvailability,
    FaultCode::UnusedAvailability,
    FaultCode::UnknownConflict,
    FaultCode::UnansweredConflict,
];

impl<'s> Earlier<'s> {
    /// Of the faults so far.
    pub fn new(draft: &Draft<'_>, sources: &'s Sources, faults: &Faults) -> Self {
        let is_missing =
            |code| matches!(code, FaultCode::MissingKey | FaultCode::MissingTranslation);
        let (missing, places): (Vec<_>, Vec<_>) = faults
            .iter()
            .map(|fault| (fault.code, fault.primary.span))
            .partition(|(code, _)| is_missing(*code));
        let places = places.into_iter().map(|(_, place)| place);
        // What stretches over lines has more in it than its own fault.
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

    /// Takes out of the faults found since those that follow from others.
    pub fn suppress(mut self, found: &mut Faults) {
        // What each name that stands for nothing is taken for, if for anything.
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
            let is_meant = UNKNOWN.iter().any(|(unknown, unused)| {
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

    /// Whether what is missing at a place may be in what is not read, or is what a fault says to write.
    fn is_absent_only_here(&self, code: FaultCode, at: Span) -> bool {
        let subject = subject(self.sources.slice(at));
        let is_known = self.words.contains(subject) || self.suggested.contains(&loosely(subject));
        ABSENT.contains(&code) && is_known
    }

    /// Takes out the types of which only such types make use that may be used in what is not read.
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

/// The name that a fault is about, of the text that it points at.
fn subject(text: &str) -> &str {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    text.trim_matches(|c| !is_part(c))
}

/// A name without regard to how its words are joined.
fn loosely(name: &str) -> String {
    name.replace('_', "").to_lowercase()
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .filter(|word| !word.is_empty())
}

/// Whether one stretch lies in another. An empty one lies in nothing but itself.
fn is_within(inner: Span, outer: Span) -> bool {
    let is_empty = inner.start == inner.end;
    inner.file == outer.file
        && outer.start <= inner.start
        && inner.end <= outer.end
        && (!is_empty || inner == outer)
}
