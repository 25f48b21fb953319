//! Defines the draft: model items with their places in the files.
//!
//! References are not resolved yet, and texts may be missing. Malformed parts already have an error; the draft omits or
//! flags them, so that checks find only new errors.

use crate::diagnostic::Faults;
use crate::language::Occurrence;
use crate::language::grammar::{self, Form, Key};
use crate::model::{
    Ack, Answer, ByteOrder, CallDefaults, Change, CodeRange, Conflict, Encoding, EnvelopeField,
    Field, FrameKind, Group, HeaderField, Languages, Limits, MissingSection, Operation, Partial,
    Protocol, ResultCode, RetiredCode, StructType, Table, Term, Text, Transport, Type, TypeDef,
    TypeShape, Waiver,
};
use crate::source::Span;
use crate::syntax::{Entry, Node};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// The nodes of a file that define an item.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Origin<'a> {
    /// The key of the item, or the list item.
    pub key: Node<'a>,
    /// The value of the item.
    pub node: Node<'a>,
}

impl<'a> From<Entry<'a>> for Origin<'a> {
    fn from(Entry { key, value: node }: Entry<'a>) -> Self {
        Self { key, node }
    }
}

impl Origin<'_> {
    /// Returns the span of the name.
    pub fn name(self) -> Span {
        self.key.span()
    }

    /// Returns the span of the value under `key`, or of the name if the key is absent.
    pub fn at<F: Form>(self, key: Key<F>) -> Span {
        key.of(self.node).map_or(self.key.span(), Node::span)
    }

    /// Returns the span of `key`, or of the name if the key is absent.
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
    /// The origin of the item.
    pub origin: Origin<'a>,
}

/// A type and the places of its parts.
#[derive(Clone, Debug)]
pub(crate) struct TypeDraft<'a> {
    /// The type. A struct has as many fields as `parts`, an enum as many values, a choice as many variants.
    pub def: TypeDef,
    /// The origin of the type. A made type has the origin of its operation, field or variant.
    pub origin: Origin<'a>,
    /// Places of the fields, values or variants.
    pub parts: Vec<Part<'a>>,
}

impl<'a> TypeDraft<'a> {
    /// Returns the fields of a struct with their places. Other types have none.
    pub fn fields(&self) -> impl Iterator<Item = (&Field, Part<'a>)> {
        let fields = match &self.def.shape {
            TypeShape::Struct(shape) => shape.fields.as_slice(),
            TypeShape::Enum(_) | TypeShape::OneOf(_) => &[],
        };
        fields.iter().zip(self.parts.iter().copied())
    }
}

/// The place of a field, value or variant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'a> {
    /// The origin.
    pub origin: Origin<'a>,
    /// The span of the type, or of the name if the type is an inline object.
    pub ty: Span,
    /// `true` if the part is too broken for further checks.
    pub broken: bool,
    /// `true` if the field is in the short form and takes its text from its type.
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

/// An answer and the mapping around it.
#[derive(Clone, Debug)]
pub(crate) struct AnswerDraft<'a> {
    /// The answer.
    pub item: Answer,
    /// The origin of the answer.
    pub origin: Origin<'a>,
    /// The mapping that contains the answer. Paths in `about:` start there.
    pub holder: Node<'a>,
}

/// A complete spec.
#[derive(Clone, Debug, Default)]
pub(crate) struct Draft<'a> {
    /// Languages that each text requires.
    pub texts: Languages,
    /// The sections with a valid shape, by name.
    pub valid: BTreeMap<&'static str, Origin<'a>>,
    /// The names of the sections with an invalid shape.
    pub invalid: BTreeSet<&'static str>,
    pub protocol: Option<Sourced<'a, Protocol>>,
    pub transport: Option<Sourced<'a, Transport>>,
    pub frame: Option<FrameDraft<'a>>,
    pub envelope: Option<EnvelopeDraft<'a>>,
    pub results: Vec<Sourced<'a, ResultCode>>,
    pub calls: Option<Sourced<'a, CallDefaults>>,
    /// `ack:`.
    pub default_ack: Option<Ack>,
    pub limits: Option<Sourced<'a, Limits>>,
    pub ranges: Vec<Sourced<'a, CodeRange>>,
    pub retired: Vec<Sourced<'a, RetiredCode>>,
    pub groups: Vec<Sourced<'a, Group>>,
    pub operations: Vec<Sourced<'a, Operation>>,
    pub types: Vec<TypeDraft<'a>>,
    pub tables: Vec<Sourced<'a, Table>>,
    /// The sections whose items need no origin.
    pub plain: Partial,
    /// The named things of sections and of `availability`, with the mappings that declare them.
    pub declared: Vec<(&'static grammar::Table, Origin<'a>)>,
    pub glossary: Vec<Sourced<'a, Term>>,
    pub waivers: Vec<Sourced<'a, Waiver>>,
    pub sections: Vec<Sourced<'a, MissingSection>>,
    pub conflicts: Vec<Sourced<'a, Conflict>>,
    pub answers: Vec<AnswerDraft<'a>>,
    /// `true` if an answer is malformed or has neither `ids` nor `about`.
    pub broken_answers: bool,
    pub changes: Vec<Sourced<'a, Change>>,
    /// Values and keys that name a thing.
    pub references: Vec<Occurrence<'a>>,
    /// Index of the first type with each name, filled after lowering.
    pub type_index: HashMap<String, usize>,
    /// Names of types whose definition is uncertain because of errors.
    pub doubtful: HashSet<String>,
}

impl<'a> Draft<'a> {
    /// Returns `true` if a type of this name exists and its definition is certain.
    pub fn knows(&self, name: &str) -> bool {
        self.type_index.contains_key(name) && !self.doubtful.contains(name)
    }

    /// Records the types whose definition is uncertain because of the errors so far.
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

    /// Returns the shape of a named type; `None` for a built-in or unknown type.
    pub fn shape(&self, ty: &Type) -> Option<&TypeShape> {
        match ty {
            Type::Named(named) => Some(&self.type_named(named.name())?.def.shape),
            _ => None,
        }
    }

    /// Returns the struct of this name.
    pub fn struct_named(&self, name: &str) -> Option<&StructType> {
        match &self.type_named(name)?.def.shape {
            TypeShape::Struct(shape) => Some(shape),
            TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
        }
    }

    /// Returns the type of this name.
    pub fn type_named(&self, name: &str) -> Option<&TypeDraft<'a>> {
        self.types.get(*self.type_index.get(name)?)
    }
}
