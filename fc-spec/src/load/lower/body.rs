//! Bodies, inline objects and fields.

use super::Lowering;
use super::text::{deprecation, string_of, text, text_of};
use crate::load::draft::{Part, Place, TypeDraft};
use crate::load::shape::misread_marker;
use crate::load::{names, scalar};
use crate::model::{
    BodyField, BodyState, Example, Field, FieldDetails, OneOf, Quirk, Scalar, StructType, Subject,
    Text, Type, TypeDef, TypeShape, Value, Variant, WireForm,
};
use crate::syntax::{Entries, Entry, Node, NodeKind};
use crate::vocabulary::Word as _;

/// Keys that say in which form a field is written.
const MARKERS: [&str; 4] = ["type", "fields", "items", "one_of"];

/// Keys of a field, those last that make its details.
const KEYS: [&str; 19] = [
    "name",
    "zh",
    "en",
    "optional",
    "example",
    "sensitive",
    "answers",
    "wire",
    "note",
    "quirk",
    "also",
    "since",
    "deprecated",
    "length",
    "unit",
    "min",
    "max",
    "pattern",
    "default",
];

/// What made types are named after and belong to.
pub(super) struct Owner {
    /// Name of the type that holds the field.
    pub type_name: String,
    /// Body that it lies in, if any.
    pub body_of: Option<BodyField>,
}

impl Owner {
    /// What a type made for the field of this wire key belongs to.
    fn inner(&self, field_name: &str, suffix: &str, wire: &str) -> Self {
        let mut body_of = self.body_of.clone();
        if let Some(body) = &mut body_of {
            body.path.push(wire.to_owned());
        }
        Self {
            type_name: format!("{}{}{suffix}", self.type_name, names::pascal(field_name)),
            body_of,
        }
    }

    /// What a type made for a variant belongs to.
    fn variant(&self, name: &str) -> Self {
        Self {
            type_name: format!("{}{}", self.type_name, names::pascal(&names::snake(name))),
            body_of: self.body_of.clone(),
        }
    }
}

impl<'a> Lowering<'a, '_> {
    /// Makes a struct type of these fields; returns its name.
    pub(super) fn made_struct(
        &mut self,
        owner: &Owner,
        place: Place<'a>,
        fields: Entries<'a>,
        title: Text,
        state: BodyState,
    ) -> String {
        let shape = TypeShape::Struct(StructType {
            fields: Vec::new(),
            state,
        });
        let index = self.push_type(self.made_type(owner, place, title, shape), place);
        self.fill_struct(index, owner, fields);
        owner.type_name.clone()
    }

    fn made_type(&self, owner: &Owner, place: Place<'a>, title: Text, shape: TypeShape) -> TypeDef {
        TypeDef {
            name: owner.type_name.clone(),
            group: self.group.clone(),
            title,
            about: None,
            shape,
            body_of: owner.body_of.clone(),
            since: None,
            changes: Vec::new(),
            location: self.location(place.name()),
        }
    }

    /// Keeps a type, so that it stands before those made while its parts are lowered; returns where.
    pub(super) fn push_type(&mut self, def: TypeDef, place: Place<'a>) -> usize {
        self.draft.types.push(TypeDraft {
            def,
            place,
            parts: Vec::new(),
        });
        self.draft.types.len() - 1
    }

    /// Lowers the fields of the struct at `index`.
    pub(super) fn fill_struct(&mut self, index: usize, owner: &Owner, entries: Entries<'a>) {
        let (fields, parts) = entries.map(|entry| self.field(owner, entry)).unzip();
        if let Some(draft) = self.draft.types.get_mut(index) {
            if let TypeShape::Struct(shape) = &mut draft.def.shape {
                shape.fields = fields;
            }
            draft.parts = parts;
        }
    }

    /// Lowers the variants of the one-of at `index`.
    pub(super) fn fill_one_of(&mut self, index: usize, owner: &Owner, variants: Node<'a>) {
        let entries = variants.entries();
        let (variants, parts) = entries.map(|entry| self.variant(owner, entry)).unzip();
        if let Some(draft) = self.draft.types.get_mut(index) {
            draft.def.shape = TypeShape::OneOf(OneOf { variants });
            draft.parts = parts;
        }
    }

    fn variant(&mut self, owner: &Owner, entry: Entry<'a>) -> (Variant, Part<'a>) {
        let place = Place {
            key: entry.key,
            node: entry.value,
        };
        let name = entry.name().to_owned();
        let title = text(entry.value);
        let named = entry.value.entry("type");
        let ty = if let Some(ty) = named {
            ty.value.as_str().unwrap_or_default().to_owned()
        } else {
            let fields = entry.value.get("fields").map(Node::entries);
            let made = owner.variant(&name);
            let fields = fields.unwrap_or_default();
            self.made_struct(&made, place, fields, title.clone(), BodyState::Stated)
        };
        let part = Part {
            place,
            ty: named.map_or(entry.key.span(), |ty| ty.value.span()),
            broken: ty.is_empty(),
            borrows_text: false,
        };
        let variant = Variant {
            name,
            text: title,
            ty,
        };
        (variant, part)
    }

    fn field(&mut self, owner: &Owner, entry: Entry<'a>) -> (Field, Part<'a>) {
        let node = entry.value;
        let wire = entry.name().to_owned();
        let place = Place {
            key: entry.key,
            node,
        };
        let mut part = Part {
            place,
            ty: entry.key.span(),
            broken: false,
            borrows_text: false,
        };
        let misread = misread_marker(node).is_some();
        let marker = marker(node).filter(|_| !misread);
        // The short forms have no keys of their own.
        let values = marker.map_or_else(Default::default, |_| node.get_all(KEYS));
        let [
            name,
            zh,
            en,
            optional,
            example,
            sensitive,
            answers,
            form,
            details @ ..,
        ] = values;
        let is_typed = marker.is_some_and(|(mark, _)| mark == "type");
        let name = name
            .and_then(string_of)
            .unwrap_or_else(|| names::snake(&wire));
        let is_inline = node.as_mapping().is_some() && !is_typed;
        let title = if is_inline && wire == "data" && zh.is_none() && en.is_none() {
            default_title()
        } else {
            text_of(zh, en)
        };

        let (ty, marked_optional) = if misread {
            part.broken = true;
            (Type::Json, false)
        } else if let Some((_, ty)) = marker.filter(|_| is_typed) {
            part.ty = ty.span();
            type_at(ty, &mut part)
        } else if is_inline {
            let suffix = match marker {
                Some(("items", _)) => "Item",
                _ => "",
            };
            let made = owner.inner(&name, suffix, &wire);
            (self.inline(&made, place, marker, title.clone()), false)
        } else {
            part.ty = node.span();
            part.borrows_text = true;
            type_at(node, &mut part)
        };
        if answers.is_some() {
            let subject = Subject::Field {
                owner: owner.type_name.clone(),
                key: wire.clone(),
            };
            self.answers(node, &subject);
        }
        let field = Field {
            wire,
            name,
            ty,
            optional: marked_optional || flag(optional),
            text: title,
            example: example_of(example),
            wire_form: match form {
                Some(_) if is_typed => WireForm::String,
                _ => WireForm::Plain,
            },
            sensitive: flag(sensitive),
            details: details_of(details, marker.map(|(mark, _)| mark)),
        };
        (field, part)
    }

    /// What is written in place, by the key that marks its form; a bare object has none.
    fn inline(
        &mut self,
        made: &Owner,
        place: Place<'a>,
        marker: Option<(&str, Node<'a>)>,
        title: Text,
    ) -> Type {
        let content = marker.map_or(place.node, |(_, content)| content);
        if marker.is_some_and(|(mark, _)| mark == "one_of") {
            let shape = TypeShape::OneOf(OneOf {
                variants: Vec::new(),
            });
            let index = self.push_type(self.made_type(made, place, title, shape), place);
            self.fill_one_of(index, made, content);
            return Type::Named(made.type_name.clone());
        }
        let name = self.made_struct(made, place, content.entries(), title, BodyState::Stated);
        match marker {
            Some(("items", _)) => Type::Array(Box::new(Type::Named(name))),
            _ => Type::Named(name),
        }
    }
}

/// The key that says in which form a field is written, and what stands under it.
fn marker(node: Node<'_>) -> Option<(&'static str, Node<'_>)> {
    let mut found = MARKERS.into_iter().zip(node.get_all(MARKERS));
    found.find_map(|(mark, node)| Some((mark, node?)))
}

/// What the last of [`KEYS`] say in a field of the form that `mark` marks. What has no place in it
/// has been reported as misplaced.
fn details_of(found: [Option<Node<'_>>; 11], mark: Option<&str>) -> Option<Box<FieldDetails>> {
    if found.iter().all(Option::is_none) {
        return None;
    }
    let [note, quirks, also, since, deprecated, length, typed @ ..] = found;
    let length = length.filter(|_| matches!(mark, Some("type" | "items")));
    let [unit, min, max, pattern, default] =
        typed.map(|node| node.filter(|_| mark == Some("type")));
    Some(Box::new(FieldDetails {
        note: note.map(text),
        unit: unit.and_then(string_of),
        min: min.and_then(scalar::number),
        max: max.and_then(scalar::number),
        length: length.and_then(length_of),
        pattern: pattern.and_then(string_of),
        default: default.and_then(scalar_value),
        quirks: words(quirks).filter_map(Quirk::named).collect(),
        also: words(also).map(str::to_owned).collect(),
        since: since.and_then(string_of),
        deprecated: deprecation(deprecated),
    }))
}

fn example_of(node: Option<Node<'_>>) -> Example {
    match node {
        Some(node) if node.as_plain() == Some("absent") => Example::Absent,
        Some(node) => Example::Given(value(node)),
        None => Example::Derived,
    }
}

/// The type at a node; `json` and a broken part where it is none.
fn type_at(node: Node<'_>, part: &mut Part<'_>) -> (Type, bool) {
    scalar::field_type(node).unwrap_or_else(|| {
        part.broken = true;
        (Type::Json, false)
    })
}

/// Title of an inline object under the key `data` that has none of its own.
fn default_title() -> Text {
    Text {
        zh: "业务数据".to_owned(),
        en: "Payload".to_owned(),
    }
}

fn flag(node: Option<Node<'_>>) -> bool {
    node.and_then(scalar::bool).unwrap_or_default()
}

fn words(node: Option<Node<'_>>) -> impl Iterator<Item = &str> {
    let items = node.into_iter().flat_map(Node::items);
    items.filter_map(Node::as_str)
}

fn length_of(node: Node<'_>) -> Option<(u64, u64)> {
    if let Some(exact) = scalar::small_int(node) {
        return Some((exact, exact));
    }
    let mut items = node.as_sequence()?;
    let (Some(least), Some(most), None) = (items.next(), items.next(), items.next()) else {
        return None;
    };
    Some((scalar::small_int(least)?, scalar::small_int(most)?))
}

/// A bool, number or text.
pub(super) fn scalar_value(node: Node<'_>) -> Option<Scalar> {
    match value(node) {
        Value::Bool(value) => Some(Scalar::Bool(value)),
        Value::Number(value) => Some(Scalar::Number(value)),
        Value::String(value) => Some(Scalar::String(value)),
        _ => None,
    }
}

/// The JSON value that a node stands for.
pub(crate) fn value(node: Node<'_>) -> Value {
    match node.kind() {
        NodeKind::Null => Value::Null,
        NodeKind::Sequence(items) => items.map(value).collect(),
        NodeKind::Mapping(entries) => Value::Object(
            entries
                .map(|entry| (entry.name().to_owned(), value(entry.value)))
                .collect(),
        ),
        NodeKind::Scalar(scalar) => {
            if let Some(value) = scalar::bool(node) {
                Value::Bool(value)
            } else if let Some(value) = scalar::number(node) {
                Value::Number(value)
            } else {
                Value::String(scalar.text.to_owned())
            }
        }
    }
}
