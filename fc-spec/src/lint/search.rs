//! The [`Search`] of a rule: access to the model, and a list for its findings.

use super::Finding;
use super::rule::Rule;
use crate::index::DefId;
use crate::language::grammar as language;
use crate::model::{
    EnumValue, Field, Group, Kind, Model, Operation, StructType, Text, TypeDef, TypeShape, Variant,
};

/// The part of a subject that a short text without paragraphs describes.
pub(super) const TITLE: &str = "text";
/// The part of a subject that a text with paragraphs describes.
const ABOUT: &str = "about";

/// The search of one rule in a model.
pub(super) struct Search<'m> {
    /// The model to search.
    pub model: &'m Model,
    /// The day of the search, `YYYY-MM-DD`.
    pub today: &'m str,
    /// The rule that searches.
    pub rule: &'static Rule,
    /// The findings so far.
    pub found: Vec<Finding>,
}

impl<'m> Search<'m> {
    /// Adds a finding about a thing.
    pub fn report(&mut self, item: impl Into<DefId>, message: Text) {
        self.add(Finding::new(self.rule, item, message));
    }

    /// Adds a finding about each field that has a problem. The message gets the key of the field.
    pub fn report_fields(
        &mut self,
        has_problem: impl Fn(&Field) -> bool,
        message: impl Fn(&str) -> Text,
    ) {
        for (ty, field) in self.fields().filter(|(_, field)| has_problem(field)) {
            self.report(of_field(ty, field), message(&field.wire));
        }
    }

    /// Adds a finding about each operation that has a problem. The message gets the name of the operation.
    pub fn report_operations(
        &mut self,
        has_problem: impl Fn(&Operation) -> bool,
        message: impl Fn(&str) -> Text,
    ) {
        for operation in self.operations().filter(|it| has_problem(it)) {
            self.report(of_operation(operation), message(&operation.name));
        }
    }

    /// Adds a finding that the caller has built.
    pub fn add(&mut self, finding: Finding) {
        self.found.push(finding);
    }

    /// Returns every struct, including bodies and inline objects.
    pub fn structs(&self) -> impl Iterator<Item = (&'m TypeDef, &'m StructType)> + use<'m> {
        self.model.types.iter().filter_map(|ty| match &ty.shape {
            TypeShape::Struct(shape) => Some((ty, shape)),
            TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
        })
    }

    /// Returns every field with the type that holds it.
    pub fn fields(&self) -> impl Iterator<Item = (&'m TypeDef, &'m Field)> + use<'m> {
        self.structs()
            .flat_map(|(ty, shape)| shape.fields.iter().map(move |field| (ty, field)))
    }

    /// Returns every operation.
    pub fn operations(&self) -> impl Iterator<Item = &'m Operation> + use<'m> {
        self.model.operations.iter()
    }

    /// Returns every documentation text with its subject and its part of it: [`TITLE`] or [`ABOUT`].
    pub fn texts(&self) -> Vec<(Subject<'m>, &'static str, &'m Text)> {
        let mut texts = Vec::new();
        for group in &self.model.groups {
            let of = Subject::Group(group);
            texts.push((of, TITLE, &group.title));
            texts.extend(group.about.iter().map(|about| (of, ABOUT, about)));
        }
        for operation in &self.model.operations {
            let of = Subject::Operation(operation);
            texts.push((of, TITLE, &operation.title));
            texts.extend(operation.about.iter().map(|about| (of, ABOUT, about)));
        }
        for ty in &self.model.types {
            let of = Subject::Type(ty);
            if ty.body_of.is_none() {
                texts.push((of, TITLE, &ty.title));
            }
            texts.extend(ty.about.iter().map(|about| (of, ABOUT, about)));
            match &ty.shape {
                TypeShape::Struct(shape) => {
                    for field in &shape.fields {
                        let of = Subject::Field(ty, field);
                        texts.push((of, TITLE, &field.text));
                        let note = field.details().note.iter();
                        texts.extend(note.map(|note| (of, ABOUT, note)));
                    }
                }
                TypeShape::Enum(shape) => {
                    let of = |it| Subject::Value(ty, it);
                    let values = shape.values.iter();
                    texts.extend(values.map(|it| (of(it), TITLE, &it.text)));
                }
                TypeShape::OneOf(choice) => {
                    let of = |it| Subject::Variant(ty, it);
                    let variants = choice.variants.iter();
                    texts.extend(variants.map(|it| (of(it), TITLE, &it.text)));
                }
            }
        }
        texts
    }
}

/// The subject of a finding.
///
/// Its name is built only for a finding, because most rules find nothing in most of a model.
#[derive(Clone, Copy)]
pub(super) enum Subject<'m> {
    /// A group.
    Group(&'m Group),
    /// An operation.
    Operation(&'m Operation),
    /// A type.
    Type(&'m TypeDef),
    /// A field of a struct.
    Field(&'m TypeDef, &'m Field),
    /// A value of an enum.
    Value(&'m TypeDef, &'m EnumValue),
    /// A variant of a choice.
    Variant(&'m TypeDef, &'m Variant),
}

impl From<Subject<'_>> for DefId {
    fn from(subject: Subject<'_>) -> Self {
        match subject {
            Subject::Group(group) => of_group(group),
            Subject::Operation(operation) => of_operation(operation),
            Subject::Type(ty) => of_type(ty),
            Subject::Field(ty, field) => of_field(ty, field),
            Subject::Value(ty, value) => of_value(ty, value),
            Subject::Variant(ty, variant) => of_variant(ty, variant),
        }
    }
}

fn item(kind: &'static str, owner: Option<&str>, name: &str) -> DefId {
    DefId {
        kind,
        owner: owner.map(str::to_owned),
        name: name.to_owned(),
    }
}

pub(super) fn of_group(group: &Group) -> DefId {
    item(language::Group::TABLE.name, None, &group.id)
}

pub(super) fn of_operation(operation: &Operation) -> DefId {
    let kind = match operation.kind() {
        Kind::Command => language::Command::TABLE.name,
        Kind::Report => language::Report::TABLE.name,
        Kind::Stream => language::Stream::TABLE.name,
    };
    item(kind, None, &operation.name)
}

pub(super) fn of_type(ty: &TypeDef) -> DefId {
    let kind = match &ty.shape {
        TypeShape::Struct(_) => language::Struct::TABLE.name,
        TypeShape::Enum(_) => language::Enum::TABLE.name,
        TypeShape::OneOf(_) => language::OneOf::TABLE.name,
    };
    item(kind, None, &ty.name)
}

pub(super) fn of_field(ty: &TypeDef, field: &Field) -> DefId {
    item(language::Field::TABLE.name, Some(&ty.name), &field.wire)
}

pub(super) fn of_value(ty: &TypeDef, value: &EnumValue) -> DefId {
    item(language::EnumValue::TABLE.name, Some(&ty.name), &value.name)
}

pub(super) fn of_variant(ty: &TypeDef, variant: &Variant) -> DefId {
    let kind = language::NamedVariant::TABLE.name;
    item(kind, Some(&ty.name), &variant.name)
}

pub(super) fn of_waiver(id: &str) -> DefId {
    item(language::Waiver::TABLE.name, None, id)
}
