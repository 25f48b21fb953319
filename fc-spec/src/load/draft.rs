//! A spec on its way to the model: model items, each with the place that says it.
//!
//! Names are not looked up yet and texts may be missing; what the syntax got wrong has been reported
//! and is left out or flagged, so that checks find only what is new.

use crate::diagnostic::Faults;
use crate::language::Occurrence;
use crate::language::grammar::{Form, Key};
use crate::model::{
    Ack, Answer, Availability, ByteOrder, CallDefaults, Change, CodeRange, Conflict,
    CoordinateSystem, Declared, Encoding, Entity, EnvelopeField, FrameKind, Group, HeaderField,
    JsonRule, Languages, Limits, MissingSection, Operation, Protocol, Question, ResultCode,
    RetiredCode, Store, Table, Term, Text, Transport, TypeDef, Waiver,
};
use crate::source::Span;
use crate::syntax::Node;
use std::collections::{BTreeMap, HashMap, HashSet};

/// The nodes of a file that an item is read from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Origin<'a> {
    /// What names it: its key, or the list item itself.
    pub key: Node<'a>,
    /// What it says.
    pub node: Node<'a>,
}

impl Origin<'_> {
    /// Span of its name.
    pub fn name(self) -> Span {
        self.key.span()
    }

    /// Span of the value under `key`; its name's where it has no such key.
    pub fn at<F: Form>(self, key: Key<F>) -> Span {
        key.of(self.node).map_or(self.key.span(), Node::span)
    }

    /// Span of `key` itself; its name's where it has no such key.
    pub fn key_at<F: Form>(self, key: Key<F>) -> Span {
        key.entry(self.node)
            .map_or(self.key.span(), |entry| entry.key.span())
    }
}

/// A model item with its origin.
#[derive(Clone, Debug)]
pub(crate) struct Sourced<'a, T> {
    /// The item.
    pub item: T,
    /// Its origin.
    pub origin: Origin<'a>,
}

/// A type and the places of what it is made of.
#[derive(Clone, Debug)]
pub(crate) struct TypeDraft<'a> {
    /// The type. Every struct has the same number of fields as `parts`, every enum of values,
    /// every one-of of variants.
    pub def: TypeDef,
    /// Its origin; that of the operation, the field or the variant for a made type.
    pub origin: Origin<'a>,
    /// Places of its fields, values or variants.
    pub parts: Vec<Part<'a>>,
}

/// The place of a field, value or variant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'a> {
    /// The origin.
    pub origin: Origin<'a>,
    /// Where its type stands; the name where it has none of its own (an inline object).
    pub ty: Span,
    /// Whether it is too broken to be checked further.
    pub broken: bool,
    /// Whether it is in the short form and takes its text from its type.
    pub borrows_text: bool,
}

/// `frame:`.
#[derive(Clone, Debug)]
pub(crate) struct FrameDraft<'a> {
    pub origin: Origin<'a>,
    pub byte_order: ByteOrder,
    pub header: Vec<Sourced<'a, HeaderField>>,
    pub request_head: Vec<u8>,
    pub response_head: Vec<u8>,
    pub kinds: Vec<Sourced<'a, FrameKind>>,
    pub encodings: Vec<Sourced<'a, Encoding>>,
    pub data: Text,
}

/// `envelope:`.
#[derive(Clone, Debug)]
pub(crate) struct EnvelopeDraft<'a> {
    pub origin: Origin<'a>,
    pub request: Vec<Sourced<'a, EnvelopeField>>,
    pub response: Vec<Sourced<'a, EnvelopeField>>,
}

/// `availability:`.
#[derive(Clone, Debug, Default)]
pub(crate) struct AvailabilityDraft<'a> {
    /// Whether it cannot be told what is declared.
    pub is_broken: bool,
    pub audiences: Vec<Sourced<'a, Declared>>,
    pub hardware: Vec<Sourced<'a, Declared>>,
    pub releases: Vec<Sourced<'a, Declared>>,
}

impl AvailabilityDraft<'_> {
    /// Without the places.
    pub fn model(self) -> Availability {
        let items = |placed: Vec<Sourced<'_, Declared>>| {
            placed.into_iter().map(|placed| placed.item).collect()
        };
        Availability {
            audiences: items(self.audiences),
            hardware: items(self.hardware),
            releases: items(self.releases),
        }
    }
}

/// An answer and what it stands in.
#[derive(Clone, Debug)]
pub(crate) struct AnswerDraft<'a> {
    /// The answer.
    pub item: Answer,
    /// Its origin.
    pub origin: Origin<'a>,
    /// The mapping that holds it, where the paths of what it is about begin.
    pub holder: Node<'a>,
}

/// A whole spec.
#[derive(Clone, Debug, Default)]
pub(crate) struct Draft<'a> {
    /// Languages in which each text is required.
    pub texts: Languages,
    pub protocol: Option<Sourced<'a, Protocol>>,
    pub transport: Option<Sourced<'a, Transport>>,
    pub frame: Option<FrameDraft<'a>>,
    /// `json:`.
    pub json: Option<BTreeMap<JsonRule, Text>>,
    pub envelope: Option<EnvelopeDraft<'a>>,
    /// Place of `results:`.
    pub results_place: Option<Origin<'a>>,
    pub results: Vec<Sourced<'a, ResultCode>>,
    pub calls: Option<Sourced<'a, CallDefaults>>,
    /// `ack:`.
    pub default_ack: Option<Ack>,
    pub limits: Option<Sourced<'a, Limits>>,
    /// Whether `codes:` is there and sound.
    pub codes_known: bool,
    pub ranges: Vec<Sourced<'a, CodeRange>>,
    pub retired: Vec<Sourced<'a, RetiredCode>>,
    pub groups: Vec<Sourced<'a, Group>>,
    pub operations: Vec<Sourced<'a, Operation>>,
    pub types: Vec<TypeDraft<'a>>,
    pub tables: Vec<Sourced<'a, Table>>,
    pub entities: Vec<Sourced<'a, Entity>>,
    pub coordinates: Vec<Sourced<'a, CoordinateSystem>>,
    pub stores: Vec<Sourced<'a, Store>>,
    pub availability: AvailabilityDraft<'a>,
    pub glossary: Vec<Sourced<'a, Term>>,
    pub waivers: Vec<Sourced<'a, Waiver>>,
    pub sections: Vec<Sourced<'a, MissingSection>>,
    /// Whether `sections:` is there and sound.
    pub sections_known: bool,
    pub conflicts: Vec<Sourced<'a, Conflict>>,
    pub answers: Vec<AnswerDraft<'a>>,
    /// Made of the answers and of what is lost, once that is known.
    pub questions: Vec<Question>,
    /// Whether there is an answer that does not say what it answers, or how.
    pub broken_answers: bool,
    pub changes: Vec<Sourced<'a, Change>>,
    /// Values and keys that name a thing.
    pub references: Vec<Occurrence<'a>>,
    /// First type of each name; filled when all are lowered.
    pub type_index: HashMap<String, usize>,
    /// Types of which faults leave open what they are.
    pub doubtful: HashSet<String>,
}

impl<'a> Draft<'a> {
    /// Whether there is a type of this name, of which it is clear what it is.
    pub fn knows(&self, name: &str) -> bool {
        self.type_index.contains_key(name) && !self.doubtful.contains(name)
    }

    /// Notes of which types the faults so far leave open what they are.
    pub fn note_doubtful(&mut self, faults: &Faults) {
        let places: HashSet<Span> = faults.iter().map(|fault| fault.primary.span).collect();
        for (index, ty) in self.types.iter().enumerate() {
            let entry = ty.origin.name().to(ty.origin.node.span());
            let mut hidden = faults.hidden().iter();
            let is_cut = hidden.any(|text| {
                text.file == entry.file && entry.start <= text.start && text.end <= entry.end
            });
            let is_second = self.type_index.get(&ty.def.name) != Some(&index);
            let is_faulty = places.contains(&ty.origin.name())
                || ty.origin.node.entries().any(|entry| {
                    places.contains(&entry.key.span()) || places.contains(&entry.value.span())
                });
            if is_second || is_faulty || is_cut {
                self.doubtful.insert(ty.def.name.clone());
            }
        }
    }

    /// Returns the values and keys that name a thing of these kinds, each with the name.
    pub fn references_to(
        &self,
        kinds: &'static [&'static str],
    ) -> impl Iterator<Item = (&Occurrence<'a>, &'a str)> {
        let references = self.references.iter();
        let references = references.filter(move |it| it.names() == kinds);
        references.filter_map(|it| Some((it, it.node.as_str()?)))
    }

    /// The type of this name.
    pub fn type_named(&self, name: &str) -> Option<&TypeDraft<'a>> {
        self.types.get(*self.type_index.get(name)?)
    }
}
