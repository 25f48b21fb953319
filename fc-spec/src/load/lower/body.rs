//! Lowers bodies, inline objects and fields.

use super::Lowering;
use super::available::available;
use super::text::deprecation;
use crate::language::grammar::{
    CHOICE, COMMON, FIELD, ITEMS, NAMED_VARIANT, OBJECT, TEXT, both_languages as text,
};
use crate::language::scalar;
use crate::load::draft::{Origin, Part, TypeDraft};
use crate::load::shape::{lacks_form, marker, misread_marker};
use crate::model::{
    Asked, BodyField, BodyState, Condition, Constraints, Example, Field, FieldDetails, OneOf,
    Pattern, StructRef, StructType, Subject, Text, Type, TypeDef, TypeRef, TypeShape, Variant,
    WireForm,
};
use crate::names;
use crate::syntax::{Entries, Entry, Node};

/// The owner of a made type, which determines its name.
pub(super) struct Owner {
    /// Name of the type that holds the field.
    pub type_name: String,
    /// The body that contains it, if any.
    pub body_of: Option<BodyField>,
}

impl Owner {
    /// Returns the owner of a type made for the field with this wire key.
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

    /// Returns the owner with this type name, if there is one.
    fn called(self, type_name: Option<String>) -> Self {
        let type_name = type_name.unwrap_or(self.type_name);
        Self { type_name, ..self }
    }

    /// Returns the owner of a type made for a variant.
    fn variant(&self, name: &str) -> Self {
        Self {
            type_name: format!("{}{}", self.type_name, names::pascal(&names::snake(name))),
            body_of: self.body_of.clone(),
        }
    }
}

impl<'a> Lowering<'a, '_> {
    /// Makes a struct type from the fields and returns its name.
    pub(super) fn made_struct(
        &mut self,
        owner: &Owner,
        origin: Origin<'a>,
        fields: Entries<'a>,
        title: Text,
        shape: StructType,
    ) -> StructRef {
        let shape = TypeShape::Struct(shape);
        let index = self.push_type(self.made_type(owner, origin, title, shape), origin);
        self.fill_struct(index, owner, fields);
        StructRef::named(&owner.type_name)
    }

    fn made_type(
        &self,
        owner: &Owner,
        origin: Origin<'a>,
        title: Text,
        shape: TypeShape,
    ) -> TypeDef {
        TypeDef {
            name: owner.type_name.clone(),
            group: self.group.clone(),
            title,
            about: None,
            shape,
            body_of: owner.body_of.clone(),
            since: None,
            changes: Vec::new(),
            location: self.location(origin.name()),
        }
    }

    /// Adds a type before those made for its parts. Returns its index.
    pub(super) fn push_type(&mut self, def: TypeDef, origin: Origin<'a>) -> usize {
        self.draft.types.push(TypeDraft {
            def,
            origin,
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

    /// Lowers the variants of the choice at `index`.
    pub(super) fn fill_one_of(&mut self, index: usize, owner: &Owner, variants: Node<'a>) {
        let entries = variants.entries();
        let (variants, parts) = entries.map(|entry| self.variant(owner, entry)).unzip();
        if let Some(draft) = self.draft.types.get_mut(index) {
            draft.def.shape = TypeShape::OneOf(OneOf { variants });
            draft.parts = parts;
        }
    }

    fn variant(&mut self, owner: &Owner, entry: Entry<'a>) -> (Variant, Part<'a>) {
        let origin = Origin::from(entry);
        let name = entry.name().to_owned();
        let title = text(entry.value);
        let named = NAMED_VARIANT.r#type.entry(entry.value);
        let ty = if let Some(ty) = named {
            StructRef::named(ty.value.as_str().unwrap_or_default())
        } else {
            let fields = OBJECT.fields.get(entry.value);
            let own_name = OBJECT.type_name.read(entry.value);
            let made = owner.variant(&name).called(own_name);
            self.made_struct(
                &made,
                origin,
                fields,
                title.clone(),
                StructType::new(BodyState::Stated, None),
            )
        };
        let part = Part {
            origin,
            ty: named.map_or(entry.key.span(), |ty| ty.value.span()),
            broken: ty.name().is_empty(),
            borrows_text: false,
        };
        let variant = Variant {
            name,
            text: title,
            ty,
            available: available(entry.value),
            deprecated: deprecation(FIELD.deprecated.of(entry.value)),
        };
        (variant, part)
    }

    fn field(&mut self, owner: &Owner, entry: Entry<'a>) -> (Field, Part<'a>) {
        let node = entry.value;
        let wire = entry.name().to_owned();
        let origin = Origin::from(entry);
        let mut part = Part {
            origin,
            ty: entry.key.span(),
            broken: false,
            borrows_text: false,
        };
        let misread = misread_marker(node).is_some() || lacks_form(node);
        let marker = marker(node).filter(|_| !misread);
        let marker = marker.map(|(mark, _)| (mark.name(), mark.value));
        // A short form has no keys. Its mapping, if any, holds wire keys.
        let keys = marker.map(|_| node);
        let is_typed = marker.is_some_and(|(mark, _)| mark == FIELD.r#type.name);
        let name = COMMON.name.read(keys);
        let name = name.unwrap_or_else(|| names::snake(&wire));
        let is_inline = node.as_mapping().is_some() && !is_typed;
        let has_text = TEXT.zh.of(keys).or(TEXT.en.of(keys)).is_some();
        let title = if is_inline && wire == USUAL_OBJECT && !has_text {
            self.draft.texts.limit(default_title())
        } else {
            text(keys.unwrap_or(Node::nothing()))
        };

        let (ty, marked_optional) = if misread {
            part.broken = true;
            (Type::Json, false)
        } else if let Some((_, ty)) = marker.filter(|_| is_typed) {
            part.ty = ty.span();
            type_at(ty, &mut part)
        } else if is_inline {
            let suffix = match marker {
                Some((mark, _)) if mark == ITEMS.items.name => "Item",
                _ => "",
            };
            let own_name = OBJECT.type_name.read(keys);
            let made = owner.inner(&name, suffix, &wire).called(own_name);
            (self.inline(&made, origin, marker, title.clone()), false)
        } else {
            part.ty = node.span();
            part.borrows_text = true;
            type_at(node, &mut part)
        };
        if COMMON.answers.of(keys).is_some() {
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
            optional: marked_optional || FIELD.optional.get(keys),
            text: title,
            example: example_of(FIELD.example.of(keys)),
            wire_form: match FIELD.wire.of(keys) {
                // Another word has its own error. The most common form replaces it, so that no further error follows.
                Some(_) if is_typed => FIELD.wire.read(keys).unwrap_or(WireForm::String),
                _ => WireForm::Plain,
            },
            sensitive: FIELD.sensitive.get(keys),
            details: marker.and_then(|(mark, _)| details(node, mark)),
        };
        (field, part)
    }

    /// Lowers an inline type. The key of `marker` selects its form; a bare object has no such key.
    fn inline(
        &mut self,
        made: &Owner,
        origin: Origin<'a>,
        marker: Option<(&str, Node<'a>)>,
        title: Text,
    ) -> Type {
        let content = marker.map_or(origin.node, |(_, content)| content);
        if marker.is_some_and(|(mark, _)| mark == CHOICE.one_of.name) {
            let shape = TypeShape::OneOf(OneOf {
                variants: Vec::new(),
            });
            let index = self.push_type(self.made_type(made, origin, title, shape), origin);
            self.fill_one_of(index, made, content);
            return Type::Named(TypeRef::named(&made.type_name));
        }
        // All keys of a bare object are wire keys.
        let coordinates = marker.and_then(|_| FIELD.coordinates.read(origin.node));
        let shape = StructType::new(BodyState::Stated, coordinates);
        let shape = self.made_struct(made, origin, content.entries(), title, shape);
        let named = Type::Named(TypeRef::clone(&shape));
        match marker {
            Some((mark, _)) if mark == ITEMS.items.name => Type::Array(Box::new(named)),
            _ => named,
        }
    }
}

/// Returns the rarer keys of a field in the form of `mark`, if it has any. The shape check reports keys that do not
/// belong to the form.
fn details(node: Node<'_>, mark: &str) -> Option<Box<FieldDetails>> {
    // Most fields have only these keys. Skipping the others saves many lookups.
    let plain = [
        FIELD.r#type.name,
        TEXT.zh.name,
        TEXT.en.name,
        FIELD.example.name,
    ];
    if node.entries().all(|entry| plain.contains(&entry.name())) {
        return None;
    }
    let typed = (mark == FIELD.r#type.name).then_some(node);
    let listed = (mark == ITEMS.items.name).then_some(node);
    let details = FieldDetails {
        note: FIELD.note.read(node),
        refers: FIELD.refers.read(typed),
        condition: condition(node),
        coordinates: FIELD.coordinates.read(typed),
        kept: COMMON.kept.read(node),
        unit: FIELD.unit.read(typed),
        constraints: constraints(typed, listed),
        default: FIELD.default.read(typed),
        quirks: FIELD.quirk.get(node),
        also: FIELD.also.get(node),
        since: COMMON.since.read(node),
        available: available(node),
        deprecated: deprecation(FIELD.deprecated.of(node)),
    };
    (details != FieldDetails::default()).then(|| Box::new(details))
}

/// Returns the constraints of a field. A list of inline objects has a length at most.
fn constraints(typed: Option<Node<'_>>, listed: Option<Node<'_>>) -> Constraints {
    Constraints {
        min: FIELD.min.read(typed),
        max: FIELD.max.read(typed),
        length: FIELD.length.of(typed.or(listed)).and_then(length_of),
        pattern: (FIELD.pattern.read(typed)).and_then(|it| Pattern::new(it).ok()),
        only: FIELD.only.get(typed),
    }
}

/// Returns the condition in `when:`, otherwise in `unless:`. A separate check reports a field with both.
fn condition(node: Node<'_>) -> Option<Condition> {
    let asked = |entry: Entry<'_>| Asked {
        wire: entry.name().to_owned(),
        values: scalar::each_value(entry.value)
            .filter_map(scalar::scalar)
            .collect(),
    };
    let when = FIELD.when.read(node).map(|it| it.map(asked).collect());
    let unless = || FIELD.unless.read(node).map(|it| it.map(asked).collect());
    when.map(Condition::When)
        .or_else(|| unless().map(Condition::Unless))
}

fn example_of(node: Option<Node<'_>>) -> Example {
    match node {
        Some(node) if node.as_plain() == Some("absent") => Example::Absent,
        Some(node) => Example::Given(scalar::value(node)),
        None => Example::Derived,
    }
}

/// Returns the type at a node. For a malformed type, returns an optional `json`, whose absence causes no error, and
/// flags the part as broken.
fn type_at(node: Node<'_>, part: &mut Part<'_>) -> (Type, bool) {
    scalar::field_type(node).unwrap_or_else(|| {
        part.broken = true;
        (Type::Json, true)
    })
}

/// Wire key of the inline object that needs no text.
pub(in crate::load) const USUAL_OBJECT: &str = "data";

/// Title of an inline object under [`USUAL_OBJECT`] without a title.
fn default_title() -> Text {
    Text {
        zh: "业务数据".to_owned(),
        en: "Payload".to_owned(),
    }
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
