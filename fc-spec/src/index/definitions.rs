//! The places where a spec declares each thing.

use crate::diagnostic::nearest;
use crate::language::grammar::{
    self, AnyOperation, COMMON, Named, TRANSPORT, TYPES, Table, both_languages,
};
use crate::language::reference;
use crate::load::Trees;
use crate::load::draft::{Draft, Origin, Sourced};
use crate::model::{Direction, Kind, Text, TypeShape};
use crate::source::{FileId, Span};
use crate::syntax::{Entry, Node};
use crate::text;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// The identity of a thing that a spec declares.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DefId {
    /// The kind, as the id of a [`Part`](crate::language::Part): `command`, `struct`, `field`.
    pub kind: &'static str,
    /// The thing around it, if the name alone is not unique: the type of a field.
    pub owner: Option<String>,
    /// The name. A code is in the spelling of the spec, and a number is decimal. A thing without either has its position in its kind, from
    /// 1.
    pub name: String,
}

impl DefId {
    /// Returns the name with the kind: `field Station.name`, `字段 Station.name`.
    #[must_use]
    pub fn text(&self) -> Text {
        let parts = reference();
        let part = parts.iter().find(|part| part.id == self.kind);
        let kind = part.map_or(self.kind, |part| part.name.zh.as_str());
        let whole = self.to_string();
        let name = whole.strip_prefix(self.kind).unwrap_or_default();
        text!("{kind}{name}", "{whole}")
    }

    /// Returns `true` for a type, declared or built from a body.
    #[must_use]
    pub fn is_type(&self) -> bool {
        TYPES.contains(&self.kind)
    }

    /// Returns `true` for a command, report or stream.
    #[must_use]
    pub fn is_operation(&self) -> bool {
        AnyOperation::KINDS.contains(&self.kind)
    }
}

/// Writes the kind and the name: `field Station.name`.
impl fmt::Display for DefId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, owner, name } = self;
        match owner {
            Some(owner) => write!(f, "{kind} {owner}.{name}"),
            None if name == kind => f.write_str(kind),
            None => write!(f, "{kind} {name}"),
        }
    }
}

/// The place of a declaration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DefSite {
    /// Its key, or the list item itself.
    pub key: Span,
    /// All of it.
    pub whole: Span,
    /// The comments about it.
    pub comments: Vec<Span>,
}

/// The declaration of each thing that could be read. Of two things with the same name, the first.
#[derive(Clone, Debug, Default)]
pub struct Definitions {
    files: Vec<Arc<FileDefinitions>>,
    /// The answers, numbered across all files.
    answers: FileDefinitions,
    /// All declarations in order, as the index of their file and their index in it.
    order: OnceLock<Vec<(usize, usize)>>,
}

/// The declarations in one file.
#[derive(Clone, Debug, Default)]
pub(super) struct FileDefinitions {
    /// In the order of [`DefId`].
    all: Vec<(DefId, DefSite)>,
    answers: Vec<DefSite>,
}

impl FileDefinitions {
    fn get(&self, item: &DefId) -> Option<&DefSite> {
        let at = self
            .all
            .binary_search_by(|(known, _)| known.cmp(item))
            .ok()?;
        self.all.get(at).map(|(_, place)| place)
    }

    fn iter(&self) -> impl Iterator<Item = (&DefId, &DefSite)> {
        self.all.iter().map(|(item, place)| (item, place))
    }
}

impl Definitions {
    pub(super) fn of_files(files: Vec<Arc<FileDefinitions>>) -> Self {
        let answers = files.iter().flat_map(|file| &file.answers);
        let answers = (1_usize..).zip(answers).map(|(at, place)| {
            let item = DefId {
                kind: grammar::Answer::TABLE.name,
                owner: None,
                name: at.to_string(),
            };
            (item, place.clone())
        });
        let mut answers = FileDefinitions {
            all: answers.collect(),
            answers: Vec::new(),
        };
        answers.all.sort_by(|(a, _), (b, _)| a.cmp(b));
        Self {
            files,
            answers,
            order: OnceLock::new(),
        }
    }

    fn parts(&self) -> impl Iterator<Item = &FileDefinitions> {
        let files = self.files.iter().map(Arc::as_ref);
        files.chain(std::iter::once(&self.answers))
    }

    /// Returns the place of a thing.
    #[must_use]
    pub fn get(&self, item: &DefId) -> Option<&DefSite> {
        self.parts().find_map(|part| part.get(item))
    }

    /// Returns all declarations, in the order of [`DefId`].
    pub fn iter(&self) -> impl Iterator<Item = (&DefId, &DefSite)> {
        let order = self.order.get_or_init(|| self.ordered());
        let parts: Vec<&FileDefinitions> = self.parts().collect();
        order.iter().filter_map(move |&(part, at)| {
            let (item, place) = parts.get(part)?.all.get(at)?;
            Some((item, place))
        })
    }

    fn ordered(&self) -> Vec<(usize, usize)> {
        let mut all: Vec<_> = self
            .parts()
            .enumerate()
            .flat_map(|(part, own)| {
                let items = own.all.iter().enumerate();
                items.map(move |(at, (item, _))| (item, (part, at)))
            })
            .collect();
        all.sort_by_key(|(item, _)| *item);
        all.dedup_by(|(later, _), (first, _)| later == first);
        all.into_iter().map(|(_, at)| at).collect()
    }

    /// Returns the declarations in one file, including those whose name an earlier file also declares.
    pub fn in_file(&self, file: FileId) -> impl Iterator<Item = (&DefId, &DefSite)> {
        let own = usize::try_from(file.0).ok();
        let own = own.and_then(|at| self.files.get(at));
        let own = own.into_iter().flat_map(|own| own.iter());
        let answers = self.answers.iter();
        own.chain(answers.filter(move |(_, place)| place.key.file == file))
    }

    /// Returns all things with this name. The name may include the owner: `Station.name`, `name`.
    pub fn named(&self, name: &str) -> impl Iterator<Item = (&DefId, &DefSite)> {
        self.iter().filter(move |(item, _)| {
            let owner = item.owner.as_deref();
            let own = owner.and_then(|owner| name.strip_prefix(owner)?.strip_prefix('.'));
            item.name == name || own == Some(&item.name)
        })
    }

    /// Returns the most similar name.
    #[must_use]
    pub fn nearest(&self, name: &str) -> Option<&str> {
        nearest(name, self.iter().map(|(item, _)| item.name.as_str()))
    }
}

/// Collects the declarations of a file.
#[derive(Default)]
struct Collector(BTreeMap<DefId, DefSite>);

impl Collector {
    fn add(&mut self, kind: &'static Table, owner: Option<&str>, name: &str, origin: Origin<'_>) {
        let item = DefId {
            kind: kind.name,
            owner: owner.map(str::to_owned),
            name: name.to_owned(),
        };
        self.0.entry(item).or_insert_with(|| written(origin));
    }

    /// Adds the only thing of a kind, with the name of the kind.
    fn one(&mut self, kind: &'static Table, origin: Origin<'_>) {
        self.add(kind, None, kind.name, origin);
    }

    /// Adds the only thing of a kind, if the file has it.
    fn if_there<T>(&mut self, kind: &'static Table, placed: Option<&Sourced<'_, T>>) {
        if let Some(Sourced { origin, .. }) = placed {
            self.one(kind, *origin);
        }
    }

    /// Adds a thing with the name of its key.
    fn keyed(&mut self, kind: &'static Table, owner: Option<&str>, origin: Origin<'_>) {
        self.add(kind, owner, origin.key.as_str().unwrap_or_default(), origin);
    }

    /// Adds things with other names than their keys.
    fn named_by<T, N: ToString>(
        &mut self,
        kind: &'static Table,
        placed: &[Sourced<'_, T>],
        name: impl Fn(&T) -> N,
    ) {
        for Sourced { item, origin } in placed {
            self.add(kind, None, &name(item).to_string(), *origin);
        }
    }
}

fn written(origin: Origin<'_>) -> DefSite {
    DefSite {
        key: origin.key.span(),
        whole: origin.key.span().to(origin.node.span()),
        comments: origin.key.comments().collect(),
    }
}

/// Returns the declarations in the draft of one file.
pub(super) fn of_file(draft: &Draft<'_>) -> FileDefinitions {
    let mut places = Collector::default();
    places.if_there(grammar::Protocol::TABLE, draft.protocol.as_ref());
    places.if_there(grammar::Transport::TABLE, draft.transport.as_ref());
    places.if_there(grammar::Calls::TABLE, draft.calls.as_ref());
    places.if_there(grammar::Limits::TABLE, draft.limits.as_ref());
    let transport = draft.transport.as_ref().map(|it| it.origin.node);
    let ports = TRANSPORT.ports.of(transport).map(Node::entries);
    for port in ports.unwrap_or_default() {
        places.keyed(grammar::Port::TABLE, None, Origin::from(port));
    }
    if let Some(frame) = &draft.frame {
        places.one(grammar::Frame::TABLE, frame.origin);
        for field in &frame.header {
            places.keyed(grammar::HeaderField::TABLE, None, field.origin);
        }
        places.named_by(grammar::FrameKind::TABLE, &frame.kinds, |it| it.value);
        places.named_by(grammar::Encoding::TABLE, &frame.encodings, |it| it.value);
    }
    if let Some(envelope) = &draft.envelope {
        places.one(grammar::Envelope::TABLE, envelope.origin);
        for (side, fields) in [
            (Direction::Request, &envelope.request),
            (Direction::Response, &envelope.response),
        ] {
            for field in fields {
                places.keyed(
                    grammar::EnvelopeField::TABLE,
                    Some(side.name()),
                    field.origin,
                );
            }
        }
    }
    places.named_by(grammar::ResultCode::TABLE, &draft.results, |it| it.code);
    places.named_by(grammar::Range::TABLE, &draft.ranges, |it| {
        it.first_spelling.clone()
    });
    places.named_by(grammar::Retired::TABLE, &draft.retired, |it| {
        it.spelling.clone()
    });
    places.named_by(grammar::Group::TABLE, &draft.groups, |it| it.id.clone());
    for Sourced { item, origin } in &draft.operations {
        let kind = match item.kind() {
            Kind::Command => grammar::Command::TABLE,
            Kind::Report => grammar::Report::TABLE,
            Kind::Stream => grammar::Stream::TABLE,
        };
        places.add(kind, None, &item.name, *origin);
    }
    types(&mut places, draft);
    for (table, origin) in &draft.declared {
        if !AnyOperation::KINDS.contains(&table.name) {
            places.keyed(table, None, *origin);
        }
    }
    places.named_by(grammar::Section::TABLE, &draft.sections, |it| it.section);
    for (at, change) in (1_usize..).zip(&draft.changes) {
        places.add(grammar::Change::TABLE, None, &at.to_string(), change.origin);
    }
    let answers = draft.answers.iter();
    FileDefinitions {
        all: places.0.into_iter().collect(),
        answers: answers.map(|answer| written(answer.origin)).collect(),
    }
}

fn types(places: &mut Collector, draft: &Draft<'_>) {
    for ty in &draft.types {
        let name = ty.def.name.as_str();
        let (kind, inside, names): (_, _, Vec<&str>) = match &ty.def.shape {
            TypeShape::Struct(shape) => (
                grammar::Struct::TABLE,
                grammar::Field::TABLE,
                shape.fields.iter().map(|it| it.wire.as_str()).collect(),
            ),
            TypeShape::Enum(shape) => (
                grammar::Enum::TABLE,
                grammar::EnumValue::TABLE,
                shape.values.iter().map(|it| it.name.as_str()).collect(),
            ),
            TypeShape::OneOf(choice) => (
                grammar::OneOf::TABLE,
                grammar::NamedVariant::TABLE,
                choice.variants.iter().map(|it| it.name.as_str()).collect(),
            ),
        };
        places.add(kind, None, name, ty.origin);
        for (part, own) in ty.parts.iter().zip(names) {
            places.add(inside, Some(name), own, part.origin);
        }
    }
}

/// Returns the entry with the key at this place.
pub(crate) fn entry_at(node: Node<'_>, key: Span) -> Option<Entry<'_>> {
    let has = |node: Node<'_>| node.span().start <= key.start && key.end <= node.span().end;
    for entry in node.entries() {
        if entry.key.span() == key {
            return Some(entry);
        }
        if has(entry.value) {
            return entry_at(entry.value, key);
        }
    }
    let inside = node.items().find(|item| has(*item));
    inside.and_then(|item| entry_at(item, key))
}

/// Returns the title of a thing, and its `about` if it has one. Both are empty if the spec lacks them.
#[must_use]
pub fn described(trees: &Trees, place: &DefSite) -> Option<(Text, Option<Text>)> {
    let tree = trees.tree(place.key.file)?;
    let node = entry_at(tree.root(), place.key)?.value;
    Some((both_languages(node), COMMON.about.read(node)))
}
