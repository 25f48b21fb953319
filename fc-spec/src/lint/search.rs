//! What rules look through, and where they leave what they find.

use super::Finding;
use super::rule::Rule;
use crate::load::Item;
use crate::load::grammar as language;
use crate::model::{
    EnumValue, Field, Group, Kind, Model, Operation, StructType, Text, TypeDef, TypeShape, Variant,
};

/// A rule at work on a model.
pub(super) struct Search<'m> {
    /// What is looked through.
    pub model: &'m Model,
    /// The day as of which it is judged, `YYYY-MM-DD`.
    pub today: &'m str,
    /// The rule.
    pub rule: &'static Rule,
    /// What it has found.
    pub found: Vec<Finding>,
}

impl<'m> Search<'m> {
    /// Reports what is wrong with a thing.
    pub fn report(&mut self, item: Item, message: Text) {
        self.add(Finding::new(self.rule, item, message));
    }

    /// The same, put together elsewhere.
    pub fn add(&mut self, finding: Finding) {
        self.found.push(finding);
    }

    /// Every struct, those of bodies and inline objects included.
    pub fn structs(&self) -> impl Iterator<Item = (&'m TypeDef, &'m StructType)> + use<'m> {
        self.model.types.iter().filter_map(|ty| match &ty.shape {
            TypeShape::Struct(shape) => Some((ty, shape)),
            TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
        })
    }

    /// Every field with the type that holds it.
    pub fn fields(&self) -> impl Iterator<Item = (&'m TypeDef, &'m Field)> + use<'m> {
        self.structs()
            .flat_map(|(ty, shape)| shape.fields.iter().map(move |field| (ty, field)))
    }

    /// Every operation.
    pub fn operations(&self) -> impl Iterator<Item = &'m Operation> + use<'m> {
        self.model.operations.iter()
    }

    /// Every text that people have written about something that programs use: of what, whether it is a short one (a title and no
    /// paragraphs), and the text.
    pub fn texts(&self) -> Vec<(Item, bool, &'m Text)> {
        let mut texts = Vec::new();
        for group in &self.model.groups {
            texts.push((of_group(group), true, &group.title));
            texts.extend(group.about.iter().map(|it| (of_group(group), false, it)));
        }
        for it in &self.model.operations {
            texts.push((of_operation(it), true, &it.title));
            texts.extend(
                it.about
                    .iter()
                    .map(|about| (of_operation(it), false, about)),
            );
        }
        for ty in &self.model.types {
            if ty.body_of.is_none() {
                texts.push((of_type(ty), true, &ty.title));
            }
            texts.extend(ty.about.iter().map(|about| (of_type(ty), false, about)));
            match &ty.shape {
                TypeShape::Struct(shape) => {
                    for field in &shape.fields {
                        texts.push((of_field(ty, field), true, &field.text));
                        let note = field.details().note.iter();
                        texts.extend(note.map(|note| (of_field(ty, field), false, note)));
                    }
                }
                TypeShape::Enum(shape) => {
                    let values = shape.values.iter();
                    texts.extend(values.map(|value| (of_value(ty, value), true, &value.text)));
                }
                TypeShape::OneOf(choice) => {
                    let variants = choice.variants.iter();
                    texts.extend(variants.map(|it| (of_variant(ty, it), true, &it.text)));
                }
            }
        }
        texts
    }
}

fn item(kind: &'static str, owner: Option<&str>, name: &str) -> Item {
    Item {
        kind,
        owner: owner.map(str::to_owned),
        name: name.to_owned(),
    }
}

pub(super) fn of_group(group: &Group) -> Item {
    item(language::Group::TABLE.name, None, &group.id)
}

pub(super) fn of_operation(operation: &Operation) -> Item {
    let kind = match operation.kind() {
        Kind::Command => language::Command::TABLE.name,
        Kind::Report => language::Report::TABLE.name,
        Kind::Stream => language::Stream::TABLE.name,
    };
    item(kind, None, &operation.name)
}

pub(super) fn of_type(ty: &TypeDef) -> Item {
    let kind = match &ty.shape {
        TypeShape::Struct(_) => language::Struct::TABLE.name,
        TypeShape::Enum(_) => language::Enum::TABLE.name,
        TypeShape::OneOf(_) => language::OneOf::TABLE.name,
    };
    item(kind, None, &ty.name)
}

pub(super) fn of_field(ty: &TypeDef, field: &Field) -> Item {
    item(language::Field::TABLE.name, Some(&ty.name), &field.wire)
}

pub(super) fn of_value(ty: &TypeDef, value: &EnumValue) -> Item {
    item(language::EnumValue::TABLE.name, Some(&ty.name), &value.name)
}

pub(super) fn of_variant(ty: &TypeDef, variant: &Variant) -> Item {
    let kind = language::NamedVariant::TABLE.name;
    item(kind, Some(&ty.name), &variant.name)
}

pub(super) fn of_waiver(id: &str) -> Item {
    item(language::Waiver::TABLE.name, None, id)
}
