//! Every key and value of a file, and what the language says of it: for editors.

use super::places::{Item, Place};
use crate::language::grammar::{
    ACCEPTED, ANSWER, AVAILABLE, Answer, Audience, Available, COMMON, Choice, Command, Conflict,
    Constants, CoordinateSystem, DEPRECATED, DeclaredError, ENUM_VALUE, ERROR, Entity, Enum,
    EnumValue, FIELD, FIELD_KIND, FILE, Field, File, Group, Items, Kind, Machine, NamedVariant,
    OPERATION, Object, OneOf, Precondition, RANGE, Range, Report, ResultCode, SET_OFF, STREAM,
    Series, SetOff, Store, Stream, Struct, Table, both_languages,
};
use crate::language::{Word, words};
use crate::load::Trees;
use crate::model::{RangeUse, Text, Type};
use crate::source::Span;
use crate::syntax::{Entry, Node, Style};

/// A key or a scalar value of a file.
#[derive(Clone, Copy, Debug)]
pub struct Site<'t> {
    /// Where it stands.
    pub node: Node<'t>,
    /// What it is there.
    pub role: Role,
    /// The part of the language whose key it is or stands under; the id of a [`Part`](crate::language::Part).
    pub part: &'static str,
    /// That key; `None` of a key that the part does not have.
    pub key: Option<&'static str>,
    /// The declared type in which it stands.
    owner: Option<&'t str>,
    /// Of a key, the mapping that it is in, and what the language says of that.
    within: Option<(Node<'t>, &'static Kind)>,
    kind: &'static Kind,
}

/// What a site is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A key that the language has, or a slip of one.
    Key,
    /// A key that the spec chooses: the name of a thing, a wire key.
    Chosen,
    /// A value, or an item of a list.
    Value,
}

/// A key that a mapping does not have yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OtherKey {
    /// The part that has it.
    pub part: &'static str,
    /// The key.
    pub name: &'static str,
    /// Whether the spec chooses what stands under it, so that it goes over lines of its own.
    pub opens_lines: bool,
}

/// A thing that something is the name of, whether or not the spec has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sought {
    /// What it may be; ids of [`Item`](super::Item)s.
    pub kinds: &'static [&'static str],
    /// What it is part of: of an enum value, its enum.
    pub owner: Option<String>,
    /// Its name.
    pub name: String,
    /// Where that stands.
    pub span: Span,
}

static FILE_KIND: Kind = Kind::Map(File::TABLE);
static WIRE_KEY: Kind = Kind::WireKey;

const TYPES: &[&str] = &[Struct::TABLE.name, Enum::TABLE.name, OneOf::TABLE.name];
const STRUCTS: &[&str] = &[Struct::TABLE.name];
const VALUES: &[&str] = &[EnumValue::TABLE.name];
const ENUMS: &[&str] = &[Enum::TABLE.name];
const COMMANDS: &[&str] = &[Command::TABLE.name];
const REPORTS: &[&str] = &[Report::TABLE.name];
const OPERATIONS: &[&str] = &[Command::TABLE.name, Report::TABLE.name, Stream::TABLE.name];

impl Item {
    /// Whether it is a type, declared or made of a body.
    #[must_use]
    pub fn is_type(&self) -> bool {
        TYPES.contains(&self.kind)
    }

    /// Whether it is a command, report or stream.
    #[must_use]
    pub fn is_operation(&self) -> bool {
        OPERATIONS.contains(&self.kind)
    }
}

/// Shows every key and every scalar of a file, in the order in which they stand.
pub fn sites<'t>(root: Node<'t>, see: &mut dyn FnMut(Site<'t>)) {
    let walk = Walk {
        part: File::TABLE.name,
        key: None,
        owner: None,
    };
    walk.through(&FILE_KIND, root, see);
}

/// The key or scalar on which an offset of the file lies, or right behind which.
#[must_use]
pub fn site_at<'t>(root: Node<'t>, offset: usize) -> Option<Site<'t>> {
    let mut found: Option<Site<'t>> = None;
    sites(root, &mut |site| {
        let span = site.node.span();
        if span.start <= offset && offset <= span.end {
            // What begins here is meant rather than what ends.
            found = Some(site);
        }
    });
    found
}

/// On the way down.
#[derive(Clone, Copy)]
struct Walk<'t> {
    part: &'static str,
    key: Option<&'static str>,
    owner: Option<&'t str>,
}

impl<'t> Walk<'t> {
    fn through(self, kind: &'static Kind, node: Node<'t>, see: &mut dyn FnMut(Site<'t>)) {
        if node.as_mapping().is_some() {
            self.mapping(kind, kind, node, see);
        } else if node.as_sequence().is_some() {
            if let Some(of) = items(kind, node) {
                for item in node.items() {
                    self.through(of, item, see);
                }
            }
        } else {
            see(self.site(Role::Value, kind, node, None));
        }
    }

    /// `asked`: what stands here by the language; `kind`: the one of its forms that is looked at.
    fn mapping(
        self,
        asked: &'static Kind,
        kind: &'static Kind,
        node: Node<'t>,
        see: &mut dyn FnMut(Site<'t>),
    ) {
        match kind {
            Kind::Map(table) => self.declared(table, asked, node, see),
            Kind::Entries { key, value, .. } => self.chosen(asked, (key, value), node, see),
            Kind::Body => self.chosen(asked, (&WIRE_KEY, &FIELD_KIND), node, see),
            Kind::Either(kinds) => {
                let mut kinds = kinds.iter();
                if let Some(kind) = kinds.find(|kind| kind.could_be(node)) {
                    self.mapping(asked, kind, node, see);
                }
            }
            Kind::ByKey { tables, otherwise } => {
                let mut marked = tables.iter().filter(|(mark, _)| node.entry(mark).is_some());
                match marked.next() {
                    Some((_, table)) => self.declared(table, asked, node, see),
                    None => self.mapping(asked, otherwise, node, see),
                }
            }
            _ => {}
        }
    }

    fn declared(
        self,
        table: &'static Table,
        asked: &'static Kind,
        node: Node<'t>,
        see: &mut dyn FnMut(Site<'t>),
    ) {
        for entry in node.entries() {
            let known = table.key(entry.name());
            let walk = Walk {
                part: table.name,
                key: known.map(|key| key.name),
                ..self
            };
            see(walk.site(Role::Key, asked, entry.key, Some((node, asked))));
            if let Some(known) = known {
                walk.through(&known.kind, entry.value, see);
            }
        }
    }

    fn chosen(
        self,
        asked: &'static Kind,
        (key, value): (&'static Kind, &'static Kind),
        node: Node<'t>,
        see: &mut dyn FnMut(Site<'t>),
    ) {
        let is_types = self.part == File::TABLE.name && self.key == Some(FILE.types.name);
        for entry in node.entries() {
            let mut walk = self;
            if is_types {
                walk.owner = entry.key.as_str();
            }
            see(walk.site(Role::Chosen, key, entry.key, Some((node, asked))));
            walk.through(value, entry.value, see);
        }
    }

    fn site(
        self,
        role: Role,
        kind: &'static Kind,
        node: Node<'t>,
        within: Option<(Node<'t>, &'static Kind)>,
    ) -> Site<'t> {
        Site {
            node,
            role,
            part: self.part,
            key: self.key,
            owner: self.owner,
            within,
            kind,
        }
    }
}

/// What each item of a list is.
fn items(kind: &'static Kind, node: Node<'_>) -> Option<&'static Kind> {
    match kind {
        Kind::List { of, .. } => Some(of),
        // `[Station]`.
        Kind::Type => Some(kind),
        Kind::Either(kinds) => {
            let mut kinds = kinds.iter();
            let fits = kinds.find(|kind| kind.could_be(node))?;
            items(fits, node)
        }
        _ => None,
    }
}

/// The kinds of which one stands here, also where each item of a list is one of them.
fn each(kind: &'static Kind) -> Vec<&'static Kind> {
    match kind {
        Kind::Either(kinds) => kinds.iter().flat_map(each).collect(),
        Kind::List { of, .. } => each(of),
        _ => vec![kind],
    }
}

impl<'t> Site<'t> {
    /// The keys that may still be added beside this one. None where the spec chooses the keys.
    #[must_use]
    pub fn other_keys(&self) -> Vec<OtherKey> {
        let Some((mapping, kind)) = self.within else {
            return Vec::new();
        };
        let mut tables = Vec::new();
        possible(kind, mapping, &mut tables);
        let mut keys: Vec<OtherKey> = Vec::new();
        for table in tables {
            for key in table.keys {
                let is_new = !keys.iter().any(|known| known.name == key.name);
                if is_new && mapping.entry(key.name).is_none() {
                    keys.push(OtherKey {
                        part: table.name,
                        name: key.name,
                        opens_lines: matches!(key.kind, Kind::Entries { .. } | Kind::Body),
                    });
                }
            }
        }
        keys
    }

    /// The words of which one may stand here, built-in types and units among them.
    #[must_use]
    pub fn words(&self) -> Vec<Word> {
        if self.role == Role::Key {
            return Vec::new();
        }
        let kinds = each(self.kind);
        kinds.into_iter().flat_map(words).collect()
    }

    /// What things one of which is to be named here; ids of [`Item`](super::Item)s.
    #[must_use]
    pub fn names(&self) -> &'static [&'static str] {
        let is = |table: &Table, key: &str| self.part == table.name && self.key == Some(key);
        let under = |key: &str| self.key == Some(key);
        match self.role {
            Role::Key => return &[],
            Role::Chosen => {
                return if is(Precondition::TABLE, ACCEPTED.r#in.name) {
                    ENUMS
                } else if is(Available::TABLE, AVAILABLE.from.name)
                    || is(Available::TABLE, AVAILABLE.until.name)
                {
                    const { &[Series::TABLE.name] }
                } else {
                    &[]
                };
            }
            Role::Value => {}
        }
        let kinds = each(self.kind);
        let takes = |wanted: fn(&Kind) -> bool| kinds.iter().any(|kind| wanted(kind));
        if is(NamedVariant::TABLE, FIELD.r#type.name)
            || self.part == Constants::TABLE.name && takes(is_type_name)
        {
            STRUCTS
        } else if takes(|kind| matches!(kind, Kind::Type)) || takes(is_type_name) {
            TYPES
        } else if is(Answer::TABLE, ANSWER.ids.name) {
            const { &[Conflict::TABLE.name] }
        } else if is(Range::TABLE, RANGE.groups.name) {
            const { &[Group::TABLE.name] }
        } else if is(EnumValue::TABLE, ENUM_VALUE.then.name) {
            VALUES
        } else if under(OPERATION.errors.name) || is(DeclaredError::TABLE, ERROR.code.name) {
            const { &[ResultCode::TABLE.name] }
        } else if under(DEPRECATED.replaced_by.name) {
            OPERATIONS
        } else if is(SetOff::TABLE, SET_OFF.report.name)
            || under(crate::language::grammar::COMMAND.sets_off.name)
        {
            REPORTS
        } else if is(Precondition::TABLE, ACCEPTED.after.name)
            || is(Stream::TABLE, STREAM.started_by.name)
            || is(Stream::TABLE, STREAM.stopped_by.name)
        {
            COMMANDS
        } else if is(Available::TABLE, AVAILABLE.r#for.name) {
            const { &[Audience::TABLE.name] }
        } else if is(Available::TABLE, AVAILABLE.hardware.name) {
            const { &[Machine::TABLE.name] }
        } else if under(FIELD.refers.name) {
            const { &[Entity::TABLE.name] }
        } else if under(COMMON.kept.name) {
            const { &[Store::TABLE.name] }
        } else if under(FIELD.coordinates.name) {
            const { &[CoordinateSystem::TABLE.name] }
        } else {
            &[]
        }
    }

    /// The thing that is named here.
    #[must_use]
    pub fn sought(&self) -> Option<Sought> {
        let kinds = self.names();
        let text = self.node.as_str().filter(|_| !kinds.is_empty())?;
        let mut span = self.node.span();
        let mut name = text;
        if self.node.as_plain().is_some()
            || self
                .node
                .as_scalar()
                .is_some_and(|it| it.style == Style::Quoted)
        {
            // `Station?`, and quotes.
            let quote = usize::from(self.node.as_plain().is_none());
            name = text.trim_matches(['[', ']', '?', ' ']);
            let before = text.find(name).unwrap_or_default();
            span.start += quote + before;
            span.end = span.start + name.len();
        }
        if name.is_empty() || Type::built_in().any(|built_in| built_in == name) && kinds == TYPES {
            return None;
        }
        let owner = if kinds == VALUES {
            Some(self.owner?.to_owned())
        } else {
            None
        };
        Some(Sought {
            kinds,
            owner,
            name: name.to_owned(),
            span,
        })
    }

    /// Whether it says what something is called in code: the `name` of a field or of an enum value.
    #[must_use]
    pub fn is_code_name(&self) -> bool {
        let fields = [
            Field::TABLE,
            Object::TABLE,
            Items::TABLE,
            Choice::TABLE,
            EnumValue::TABLE,
        ];
        self.role == Role::Value
            && self.key == Some(COMMON.name.name)
            && fields.iter().any(|table| table.name == self.part)
    }

    /// The declared type in which it stands.
    #[must_use]
    pub fn owner(&self) -> Option<&'t str> {
        self.owner
    }

    /// Of the key of a section of operations, the ranges from which their codes come.
    #[must_use]
    pub fn operations(&self) -> Option<RangeUse> {
        if self.part != File::TABLE.name || self.role != Role::Key {
            return None;
        }
        [
            (FILE.commands.name, RangeUse::Commands),
            (FILE.reports.name, RangeUse::Reports),
        ]
        .into_iter()
        .find_map(|(key, usage)| (self.key == Some(key)).then_some(usage))
    }

    /// Of the code of an operation, the ranges from which it comes.
    #[must_use]
    pub fn code_of(&self) -> Option<RangeUse> {
        if self.role != Role::Value || self.key != Some(OPERATION.code.name) {
            return None;
        }
        [
            (Command::TABLE.name, RangeUse::Commands),
            (Report::TABLE.name, RangeUse::Reports),
        ]
        .into_iter()
        .find_map(|(part, usage)| (part == self.part).then_some(usage))
    }
}

fn is_type_name(kind: &Kind) -> bool {
    matches!(kind, Kind::TypeName)
}

/// The tables whose keys a mapping may have: one, unless it does not say yet which of several it is.
fn possible(kind: &'static Kind, node: Node<'_>, tables: &mut Vec<&'static Table>) {
    match kind {
        Kind::Map(table) => tables.push(table),
        Kind::Either(kinds) => {
            let kinds = kinds.iter().filter(|kind| kind.could_be(node));
            kinds.for_each(|kind| possible(kind, node, tables));
        }
        Kind::ByKey { tables: each, .. } => {
            let marked = each.iter().find(|(mark, _)| node.entry(mark).is_some());
            match marked {
                Some((_, table)) => tables.push(table),
                None => tables.extend(each.iter().map(|(_, table)| *table)),
            }
        }
        _ => {}
    }
}

/// The entry whose key stands there.
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

/// What a thing says of itself: its title, and more about it if there is more. Empty where the spec does not say it.
#[must_use]
pub fn described(trees: &Trees, place: &Place) -> Option<(Text, Option<Text>)> {
    let tree = trees.tree(place.key.file)?;
    let node = entry_at(tree.root(), place.key)?.value;
    Some((both_languages(node), COMMON.about.read(node)))
}
