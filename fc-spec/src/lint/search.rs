//! The [`Search`] of a rule: access to the model, and a list for its findings.

use super::Finding;
use super::rule::Rule;
use crate::index::DefId;
use crate::language::grammar as language;
use crate::model::{
    EnumValue, Field, Group, Kind, Model, Operation, StructType, Text, TypeDef, TypeShape, Variant,
};
use serde_json::{Value, to_value};

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
            self.report(Subject::Field(ty, field), message(&field.wire));
        }
    }

    /// Adds a finding about each operation that has a problem. The message gets the name of the operation.
    pub fn report_operations(
        &mut self,
        has_problem: impl Fn(&Operation) -> bool,
        message: impl Fn(&str) -> Text,
    ) {
        for operation in self.operations().filter(|it| has_problem(it)) {
            self.report(Subject::Operation(operation), message(&operation.name));
        }
    }

    /// Adds a finding that the caller has built.
    pub fn add(&mut self, finding: Finding) {
        self.found.push(finding);
    }

    /// Returns every struct, including bodies and inline objects.
    pub fn structs(&self) -> impl Iterator<Item = (&'m TypeDef, &'m StructType)> + use<'m> {
        let types = self.model.types.iter();
        types.filter_map(|ty| Some((ty, ty.shape.structure()?)))
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
        let texts = subjects(self.model).flat_map(|of| {
            let (title, about) = of.texts();
            let title = title.map(|text| (of, TITLE, text));
            title.into_iter().chain(about.map(|text| (of, ABOUT, text)))
        });
        texts.collect()
    }
}

/// Returns everything in a model that rules can be about.
pub(super) fn subjects(model: &Model) -> impl Iterator<Item = Subject<'_>> {
    let groups = model.groups.iter().map(Subject::Group);
    let operations = model.operations.iter().map(Subject::Operation);
    let types = model.types.iter().flat_map(|ty| {
        let parts: Vec<_> = match &ty.shape {
            TypeShape::Struct(it) => it.fields.iter().map(|it| Subject::Field(ty, it)).collect(),
            TypeShape::Enum(it) => it.values.iter().map(|it| Subject::Value(ty, it)).collect(),
            TypeShape::OneOf(it) => it
                .variants
                .iter()
                .map(|it| Subject::Variant(ty, it))
                .collect(),
        };
        std::iter::once(Subject::Type(ty)).chain(parts)
    });
    groups.chain(operations).chain(types)
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

impl<'m> Subject<'m> {
    /// Returns the short text and the text with paragraphs.
    fn texts(self) -> (Option<&'m Text>, Option<&'m Text>) {
        match self {
            Self::Group(it) => (Some(&it.title), it.about.as_ref()),
            Self::Operation(it) => (Some(&it.title), it.about.as_ref()),
            Self::Type(it) => (it.body_of.is_none().then_some(&it.title), it.about.as_ref()),
            Self::Field(_, it) => (Some(&it.text), it.details().note.as_ref()),
            Self::Value(_, it) => (Some(&it.text), None),
            Self::Variant(_, it) => (Some(&it.text), None),
        }
    }

    /// Returns the subject as a dump has it.
    pub fn dump(self) -> serde_json::Result<Value> {
        match self {
            Self::Group(it) => to_value(it),
            Self::Operation(it) => to_value(it),
            Self::Type(it) => to_value(it),
            Self::Field(_, it) => to_value(it),
            Self::Value(_, it) => to_value(it),
            Self::Variant(_, it) => to_value(it),
        }
    }
}

impl From<Subject<'_>> for DefId {
    fn from(subject: Subject<'_>) -> Self {
        match subject {
            Subject::Group(it) => item(language::Group::TABLE, None, &it.id),
            Subject::Operation(it) => {
                let table = match it.kind() {
                    Kind::Command => language::Command::TABLE,
                    Kind::Report => language::Report::TABLE,
                    Kind::Stream => language::Stream::TABLE,
                };
                item(table, None, &it.name)
            }
            Subject::Type(it) => {
                let table = match &it.shape {
                    TypeShape::Struct(_) => language::Struct::TABLE,
                    TypeShape::Enum(_) => language::Enum::TABLE,
                    TypeShape::OneOf(_) => language::OneOf::TABLE,
                };
                item(table, None, &it.name)
            }
            Subject::Field(ty, it) => item(language::Field::TABLE, Some(ty), &it.wire),
            Subject::Value(ty, it) => item(language::EnumValue::TABLE, Some(ty), &it.name),
            Subject::Variant(ty, it) => item(language::NamedVariant::TABLE, Some(ty), &it.name),
        }
    }
}

fn item(table: &language::Table, owner: Option<&TypeDef>, name: &str) -> DefId {
    DefId {
        kind: table.name,
        owner: owner.map(|ty| ty.name.clone()),
        name: name.to_owned(),
    }
}

pub(super) fn of_waiver(id: &str) -> DefId {
    item(language::Waiver::TABLE, None, id)
}
