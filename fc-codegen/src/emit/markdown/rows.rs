//! Bodies as rows of a table. Every field has its own row, named by its path.

use super::desk::Desk;
use super::links::{Anchor, Link, Page};
use super::places::{Kept, Reference};
use super::words::{self, Word as _};
use fc_spec::model::{
    Deprecation, Direction, EnvelopeField, Example, Field, OneOf, Scalar, StructType, Type,
    TypeDef, TypeRef, TypeShape, Value as Json,
};
use minijinja::{Value, context};
use serde::Serialize;
use std::collections::HashSet;

/// A field of a body, or a variant of a one-of.
#[derive(Debug, Serialize)]
pub(super) struct Row {
    /// The path for the comments of an example. Pages show the nesting instead.
    #[serde(skip)]
    path: String,
    anchor: String,
    /// The number of fields and variants around it.
    depth: usize,
    /// The key, or the name of a variant.
    name: String,
    /// The name, the address of a shared type, and the form in messages if it differs.
    ty: Value,
    /// `required`, `optional`, `conditional`; `choice` for a variant of a one-of.
    presence: &'static str,
    unit: Option<String>,
    /// `≥ 0`, `0 … 100`.
    range: Option<String>,
    text: String,
    note: Option<String>,
    /// The example of a leaf as JSON.
    example: Option<String>,
    /// The rare properties, if the field has any.
    more: Option<Box<More>>,
}

/// Properties that few fields have. A separate box keeps the other rows small.
#[derive(Debug, Default, Serialize)]
struct More {
    length: Option<Value>,
    pattern: Option<String>,
    /// The allowed values of its enum as JSON; empty if all are allowed.
    only: Vec<String>,
    /// The default as JSON.
    default: Option<String>,
    /// Sentences of Markdown.
    quirks: Vec<&'static str>,
    also: Vec<String>,
    sensitive: bool,
    deprecated: Option<Value>,
    /// The name in code, if it does not follow from the wire key.
    code_name: Option<String>,
    conflicts: Vec<Link>,
    since: Option<String>,
    condition: Option<Value>,
    available: Option<Value>,
    /// The entity that its value identifies.
    refers: Option<Reference>,
    given: Option<Reference>,
    kept: Option<Kept>,
}

impl<'m> Desk<'_, 'm> {
    /// Returns the keys of the envelope.
    pub(super) fn envelope_rows(&self, direction: Direction) -> Vec<Row> {
        let body = RowPosition::top(Anchor::named(direction.name()));
        let envelope = self.book.samples.envelope(direction).iter();
        envelope
            .map(|field| self.envelope_row(field, &body.field(&field.wire)))
            .collect()
    }

    /// Returns the keys of the envelope, then the fields of a struct and of all objects in it.
    pub(super) fn message_rows(&self, direction: Direction, ty: &TypeRef) -> Vec<Row> {
        let body = RowPosition::top(Anchor::named(direction.name()));
        let mut rows = self.envelope_rows(direction);
        let ty = self.book.model.types.get(ty);
        self.shape(ty, &body, &mut Vec::new(), &mut rows);
        rows
    }

    /// Returns the fields of a struct or of each variant of a one-of, and of all objects in it. Their anchors start
    /// with `anchor`.
    pub(super) fn type_rows(&self, ty: &'m TypeDef, anchor: Anchor) -> Vec<Row> {
        let mut rows = Vec::new();
        self.shape(ty, &RowPosition::top(anchor), &mut Vec::new(), &mut rows);
        rows
    }

    /// Returns the reason for a deprecation, and the replacement.
    pub(super) fn deprecation(&self, deprecated: &Deprecation) -> Value {
        let replaced_by = deprecated.replaced_by.as_deref().map(|name| {
            let operation = self.book.operation(name);
            let page = operation.map_or(Page::Index, Page::Operation);
            self.to(format!("`{name}`"), (page, Anchor::none()))
        });
        context! {
            since => &deprecated.since,
            sunset => &deprecated.sunset,
            note => self.sentence(&deprecated.note),
            replaced_by,
        }
    }

    fn shape(
        &self,
        ty: &'m TypeDef,
        position: &RowPosition,
        open: &mut Vec<&'m str>,
        rows: &mut Vec<Row>,
    ) {
        if open.contains(&ty.name.as_str()) {
            return;
        }
        open.push(&ty.name);
        match &ty.shape {
            TypeShape::Struct(shape) => self.fields(ty, shape, position, open, rows),
            TypeShape::OneOf(choice) => self.variants(choice, position, open, rows),
            TypeShape::Enum(_) => {}
        }
        open.pop();
    }

    fn fields(
        &self,
        owner: &TypeDef,
        shape: &'m StructType,
        position: &RowPosition,
        open: &mut Vec<&'m str>,
        rows: &mut Vec<Row>,
    ) {
        for field in &shape.fields {
            let condition = self.condition(shape, field, position);
            let position = position.field(&field.wire);
            let mut row = self.row(owner, field, &position);
            if let Some(more) = &mut row.more {
                more.condition = condition;
            }
            rows.push(row);
            if let Some(named) = field.ty.innermost() {
                let inner = self.book.model.types.get(named);
                self.shape(inner, &position.items_of(&field.ty), open, rows);
            }
        }
    }

    fn variants(
        &self,
        choice: &'m OneOf,
        position: &RowPosition,
        open: &mut Vec<&'m str>,
        rows: &mut Vec<Row>,
    ) {
        for variant in &choice.variants {
            let position = position.variant(&variant.name);
            let ty = Type::Named(TypeRef::clone(&variant.ty));
            let mut row = Row::plain(
                &position,
                self.type_cell(&ty, None),
                self.lang.text(&variant.text),
            );
            row.presence = "choice";
            let available = self.available(variant.available.as_ref());
            let deprecated = variant.deprecated.as_ref().map(|it| self.deprecation(it));
            if available.is_some() || deprecated.is_some() {
                row.more = Some(Box::new(More {
                    deprecated,
                    available,
                    ..More::default()
                }));
            }
            rows.push(row);
            let ty = self.book.model.types.get(&variant.ty);
            self.shape(ty, &position, open, rows);
        }
    }

    fn row(&self, owner: &TypeDef, field: &Field, position: &RowPosition) -> Row {
        let details = field.details();
        let ty = self.type_cell(&field.ty, words::sent(field.wire_form, self.lang));
        let numbers = details.constraints.numbers();
        Row {
            presence: presence(field.optional, details.condition.is_some()),
            unit: details.unit.clone(),
            range: numbers.map(|it| self.lang.text(&it).to_owned()),
            note: details.note.as_ref().map(|note| self.sentence(note)),
            example: leaf_example(field),
            more: self.more(owner, field).map(Box::new),
            ..Row::plain(position, ty, &self.sentence(&field.text))
        }
    }

    fn more(&self, owner: &TypeDef, field: &Field) -> Option<More> {
        let answers = self.book.answers_to_field(&owner.name, field).iter();
        let mut named = HashSet::new();
        let ids = answers.flat_map(|answer| &answer.ids);
        let ids = ids.filter(|id| named.insert(*id));
        let conflicts: Vec<Link> = ids.map(|id| self.conflict(id)).collect();
        let code_name = odd_name(&field.wire, &field.name);
        let given = self.book.model.coordinates_of(field);
        let is_plain = field.details.is_none() && !field.sensitive && given.is_none();
        if is_plain && conflicts.is_empty() && code_name.is_none() {
            return None;
        }
        let details = field.details();
        let constraints = &details.constraints;
        let quirks = details.quirks.iter();
        Some(More {
            length: self.length(field),
            pattern: constraints.pattern.clone().map(String::from),
            only: constraints.only.iter().map(scalar).collect(),
            default: details.default.as_ref().map(scalar),
            quirks: quirks.map(|quirk| quirk.word(self.lang)).collect(),
            also: details.also.clone(),
            sensitive: field.sensitive,
            deprecated: details.deprecated.as_ref().map(|it| self.deprecation(it)),
            code_name,
            conflicts,
            since: details.since.clone(),
            // [`Desk::condition`] fills this in, because it needs the other fields of the struct.
            condition: None,
            available: self.available(details.available.as_ref()),
            refers: details.refers.as_deref().map(|name| self.reference(name)),
            given: given.map(|name| self.given(name)),
            kept: details.kept.as_deref().map(|name| self.kept(name)),
        })
    }

    fn envelope_row(&self, field: &EnvelopeField, position: &RowPosition) -> Row {
        let text = self.lang.text(&field.text);
        Row {
            presence: presence(field.optional, false),
            more: odd_name(&field.wire, &field.name).map(|code_name| {
                Box::new(More {
                    code_name: Some(code_name),
                    ..More::default()
                })
            }),
            ..Row::plain(position, self.type_cell(&field.ty, None), text)
        }
    }

    fn reference(&self, name: &str) -> Reference {
        let entity = self.book.model.entity(name);
        let title = entity.map_or(name, |entity| self.lang.text(&entity.title));
        Reference {
            name: name.to_owned(),
            link: self.to(title, (Page::Entities, Anchor::of("entity", name))),
        }
    }

    /// Returns a link to a conflict on the page of open questions.
    pub(super) fn conflict(&self, id: &str) -> Link {
        self.to(id, (Page::OpenQuestions, Anchor::named(id)))
    }

    fn type_cell(&self, ty: &Type, sent: Option<&str>) -> Value {
        let types = &self.book.model.types;
        let inline = |named: &TypeRef| {
            let ty = types.get(named);
            ty.body_of.as_ref()?;
            Some(match ty.shape {
                TypeShape::OneOf(_) => "one_of",
                TypeShape::Struct(_) | TypeShape::Enum(_) => "object",
            })
        };
        let shared = ty.innermost().map(|named| types.get(named));
        let shared = shared.filter(|ty| ty.body_of.is_none());
        context! {
            name => words::type_name(ty, &inline),
            href => shared.map(|ty| self.page.link(self.book.place_of_type(ty))),
            sent,
        }
    }

    /// Returns a length, and the things that it counts.
    fn length(&self, field: &Field) -> Option<Value> {
        let (least, most) = field.details().constraints.length?;
        let count = if least == most {
            least.to_string()
        } else {
            format!("{least} … {most}")
        };
        let of = match field.ty {
            Type::Base64 => self.lang.pick("字节", "bytes"),
            Type::Array(_) => self.lang.pick("项", "items"),
            _ => self.lang.pick("个字符", "characters"),
        };
        Some(context! { count, of })
    }
}

impl Row {
    /// Returns the path, such as `data.stations[].x`.
    pub(super) fn path(&self) -> &str {
        &self.path
    }

    /// Returns the anchor on its page.
    pub(super) fn anchor(&self) -> &str {
        &self.anchor
    }

    /// Returns the name of the entity that the field refers to.
    pub(super) fn entity(&self) -> Option<&str> {
        self.more.as_ref()?.refers.as_ref().map(Reference::name)
    }

    /// Returns the name of the coordinate system of the field.
    pub(super) fn system(&self) -> Option<&str> {
        self.more.as_ref()?.given.as_ref().map(Reference::name)
    }

    /// Returns the name of the store of the field.
    pub(super) fn store(&self) -> Option<&str> {
        self.more.as_ref()?.kept.as_ref().map(Kept::store)
    }

    /// Returns the meaning, in Markdown.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    fn plain(position: &RowPosition, ty: Value, text: &str) -> Self {
        Self {
            path: position.path.clone(),
            anchor: position.anchor.clone().id(),
            depth: position.depth.saturating_sub(1),
            name: position.name.clone(),
            ty,
            presence: "required",
            unit: None,
            range: None,
            text: text.to_owned(),
            note: None,
            example: None,
            more: None,
        }
    }
}

/// The position of a row in a body.
#[derive(Clone)]
pub(super) struct RowPosition {
    path: String,
    anchor: Anchor,
    name: String,
    /// The number of fields and variants that lead to it, including itself.
    depth: usize,
}

impl RowPosition {
    fn top(anchor: Anchor) -> Self {
        Self {
            path: String::new(),
            anchor,
            name: String::new(),
            depth: 0,
        }
    }

    /// Returns the position of a field below this one.
    pub(super) fn field(&self, key: &str) -> Self {
        let dot = if self.path.is_empty() { "" } else { "." };
        self.step(format!("{}{dot}{key}", self.path), key)
    }

    /// Returns the anchor for links.
    pub(super) fn anchor(self) -> Anchor {
        self.anchor
    }

    fn variant(&self, name: &str) -> Self {
        self.step(self.path.clone(), name)
    }

    fn step(&self, path: String, name: &str) -> Self {
        Self {
            path,
            anchor: self.anchor.step(name),
            name: name.to_owned(),
            depth: self.depth + 1,
        }
    }

    fn items_of(&self, ty: &Type) -> Self {
        let mut position = self.clone();
        let mut ty = ty;
        while let Type::Array(item) = ty {
            position.path.push_str("[]");
            ty = item;
        }
        position
    }
}

fn presence(optional: bool, conditional: bool) -> &'static str {
    match (optional, conditional) {
        (false, _) => "required",
        (true, false) => "optional",
        (true, true) => "conditional",
    }
}

/// Returns a scalar of the spec as JSON.
pub(super) fn scalar(scalar: &Scalar) -> String {
    Json::from(scalar).to_string()
}

/// Returns the example of a leaf. Objects and arrays are easier to read in the example of the message.
fn leaf_example(field: &Field) -> Option<String> {
    match &field.example {
        Example::Given(Json::Object(_) | Json::Array(_)) | Example::Derived | Example::Absent => {
            None
        }
        Example::Given(value) => Some(value.to_string()),
    }
}

/// Returns the name in code, unless it follows from the wire key.
pub(super) fn odd_name(wire: &str, name: &str) -> Option<String> {
    fn letters(name: &str) -> impl Iterator<Item = char> {
        let letters = name.chars().filter(|character| *character != '_');
        letters.flat_map(char::to_lowercase)
    }
    letters(wire).ne(letters(name)).then(|| name.to_owned())
}
