//! Where each thing that a spec says is written.

use super::draft::{Draft, Place as Written, Placed};
use super::grammar::{self as language, TRANSPORT, Table};
use crate::diagnostic::nearest;
use crate::model::{Direction, Kind, TypeShape};
use crate::syntax::{Entry, Node, Span};
use std::collections::BTreeMap;
use std::fmt;

/// A thing that a spec says.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Item {
    /// What the language calls it, which is the id of a [`Part`](crate::schema::Part): `command`, `struct`, `field`.
    pub kind: &'static str,
    /// What it is part of, where its name alone does not tell it from others: the type of a field.
    pub owner: Option<String>,
    /// Its name; a code as the spec writes it, a number in decimal; its place among its like, from 1, where it has neither.
    pub name: String,
}

/// With its kind: `field Station.name`.
impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, owner, name } = self;
        match owner {
            Some(owner) => write!(f, "{kind} {owner}.{name}"),
            None if name == kind => f.write_str(kind),
            None => write!(f, "{kind} {name}"),
        }
    }
}

/// Where something is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// What names it: its key, or the list item itself.
    pub key: Span,
    /// All of it.
    pub whole: Span,
    /// The comments that are about it.
    pub comments: Vec<Span>,
}

/// Where each thing is written that could be read. Of two of one name, the first.
#[derive(Clone, Debug, Default)]
pub struct Places(BTreeMap<Item, Place>);

impl Places {
    /// Where it is written.
    #[must_use]
    pub fn get(&self, item: &Item) -> Option<&Place> {
        self.0.get(item)
    }

    /// All of them, in the order of [`Item`].
    pub fn iter(&self) -> impl Iterator<Item = (&Item, &Place)> {
        self.0.iter()
    }

    /// All of this name, with or without that of what it is part of: `Station.name`, `name`.
    pub fn named(&self, name: &str) -> impl Iterator<Item = (&Item, &Place)> {
        self.0.iter().filter(move |(item, _)| {
            let own = match &item.owner {
                Some(owner) => name
                    .strip_prefix(owner)
                    .and_then(|rest| rest.strip_prefix('.')),
                None => None,
            };
            item.name == name || own == Some(&item.name)
        })
    }

    /// The name that this one is most likely a slip of.
    #[must_use]
    pub fn nearest(&self, name: &str) -> Option<&str> {
        nearest(name, self.0.keys().map(|item| item.name.as_str()))
    }

    fn add(&mut self, kind: &'static Table, owner: Option<&str>, name: &str, place: Written<'_>) {
        let item = Item {
            kind: kind.name,
            owner: owner.map(str::to_owned),
            name: name.to_owned(),
        };
        self.0.entry(item).or_insert_with(|| Place {
            key: place.key.span(),
            whole: place.key.span().to(place.node.span()),
            comments: place.key.comments().collect(),
        });
    }

    /// What stands once, and is called what it is.
    fn one(&mut self, kind: &'static Table, place: Written<'_>) {
        self.add(kind, None, kind.name, place);
    }

    /// The same, if it is there.
    fn if_there<T>(&mut self, kind: &'static Table, placed: Option<&Placed<'_, T>>) {
        if let Some(Placed { place, .. }) = placed {
            self.one(kind, *place);
        }
    }

    /// What is called as its key says.
    fn keyed<T>(&mut self, kind: &'static Table, owner: Option<&str>, placed: &[Placed<'_, T>]) {
        for Placed { place, .. } in placed {
            self.add(kind, owner, place.key.as_str().unwrap_or_default(), *place);
        }
    }

    /// What has another name than its key, if it has one.
    fn named_by<T>(
        &mut self,
        kind: &'static Table,
        placed: &[Placed<'_, T>],
        name: impl Fn(usize, &T) -> String,
    ) {
        for (at, Placed { item, place }) in placed.iter().enumerate() {
            self.add(kind, None, &name(at + 1, item), *place);
        }
    }
}

/// Of a whole draft.
pub(super) fn places(draft: &Draft<'_>) -> Places {
    let mut places = Places::default();
    places.if_there(language::Protocol::TABLE, draft.protocol.as_ref());
    places.if_there(language::Transport::TABLE, draft.transport.as_ref());
    places.if_there(language::Calls::TABLE, draft.calls.as_ref());
    places.if_there(language::Limits::TABLE, draft.limits.as_ref());
    let transport = draft.transport.as_ref().map(|it| it.place.node);
    let ports = TRANSPORT.ports.of(transport).map(Node::entries);
    for Entry { key, value: node } in ports.unwrap_or_default() {
        let name = key.as_str().unwrap_or_default();
        places.add(language::Port::TABLE, None, name, Written { key, node });
    }
    if let Some(frame) = &draft.frame {
        places.one(language::Frame::TABLE, frame.place);
        places.keyed(language::HeaderField::TABLE, None, &frame.header);
        places.named_by(language::FrameKind::TABLE, &frame.kinds, |_, it| {
            it.value.to_string()
        });
        places.named_by(language::Encoding::TABLE, &frame.encodings, |_, it| {
            it.value.to_string()
        });
    }
    if let Some(envelope) = &draft.envelope {
        places.one(language::Envelope::TABLE, envelope.place);
        for (side, fields) in [
            (Direction::Request, &envelope.request),
            (Direction::Response, &envelope.response),
        ] {
            places.keyed(language::EnvelopeField::TABLE, Some(side.name()), fields);
        }
    }
    places.named_by(language::ResultCode::TABLE, &draft.results, |_, it| {
        it.code.to_string()
    });
    places.named_by(language::Range::TABLE, &draft.ranges, |_, it| {
        it.first_spelling.clone()
    });
    places.named_by(language::Retired::TABLE, &draft.retired, |_, it| {
        it.spelling.clone()
    });
    places.named_by(language::Group::TABLE, &draft.groups, |_, it| it.id.clone());
    for Placed { item, place } in &draft.operations {
        let kind = match item.kind() {
            Kind::Command => language::Command::TABLE,
            Kind::Report => language::Report::TABLE,
            Kind::Stream => language::Stream::TABLE,
        };
        places.add(kind, None, &item.name, *place);
    }
    types(&mut places, draft);
    places.keyed(language::Constants::TABLE, None, &draft.tables);
    places.keyed(language::Entity::TABLE, None, &draft.entities);
    places.keyed(language::CoordinateSystem::TABLE, None, &draft.coordinates);
    places.keyed(language::Store::TABLE, None, &draft.stores);
    let words = &draft.availability;
    places.keyed(language::Audience::TABLE, None, &words.audiences);
    places.keyed(language::Machine::TABLE, None, &words.hardware);
    places.keyed(language::Series::TABLE, None, &words.releases);
    places.keyed(language::Term::TABLE, None, &draft.glossary);
    places.keyed(language::Waiver::TABLE, None, &draft.waivers);
    places.named_by(language::Section::TABLE, &draft.sections, |_, it| {
        it.section.to_string()
    });
    places.keyed(language::Conflict::TABLE, None, &draft.conflicts);
    for (at, answer) in (1..).zip(&draft.answers) {
        let name: usize = at;
        places.add(
            language::Answer::TABLE,
            None,
            &name.to_string(),
            answer.place,
        );
    }
    places.named_by(language::Change::TABLE, &draft.changes, |at, _| {
        at.to_string()
    });
    places
}

fn types(places: &mut Places, draft: &Draft<'_>) {
    for ty in &draft.types {
        let name = ty.def.name.as_str();
        let (kind, inside, names): (_, _, Vec<&str>) = match &ty.def.shape {
            TypeShape::Struct(shape) => (
                language::Struct::TABLE,
                language::Field::TABLE,
                shape.fields.iter().map(|it| it.wire.as_str()).collect(),
            ),
            TypeShape::Enum(shape) => (
                language::Enum::TABLE,
                language::EnumValue::TABLE,
                shape.values.iter().map(|it| it.name.as_str()).collect(),
            ),
            TypeShape::OneOf(choice) => (
                language::OneOf::TABLE,
                language::NamedVariant::TABLE,
                choice.variants.iter().map(|it| it.name.as_str()).collect(),
            ),
        };
        places.add(kind, None, name, ty.place);
        for (part, own) in ty.parts.iter().zip(names) {
            places.add(inside, Some(name), own, part.place);
        }
    }
}
