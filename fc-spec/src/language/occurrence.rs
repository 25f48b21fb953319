//! Every key and value of a file, with its part of the grammar.

use super::cursor::{Cursor, FILE_KIND};
use super::reference::{Word, words};
use crate::language::grammar::{
    AnyKey, COMMON, Choice, Command, EnumValue, FILE, Field, File, Items, Kind, Named, OPERATION,
    Object, Report, TYPES, Table,
};
use crate::model::{RangeUse, Type};
use crate::source::Span;
use crate::syntax::{Node, Style};

/// A key or a scalar value of a file.
#[derive(Clone, Copy, Debug)]
pub struct Occurrence<'t> {
    /// The node.
    pub node: Node<'t>,
    /// Its role.
    pub role: Role,
    /// The part of the language that has the key, as the id of a [`Part`](crate::language::Part).
    pub part: &'static str,
    /// The key; `None` for a key that the part does not have.
    pub key: Option<&'static str>,
    /// The declared type around it.
    owner: Option<&'t str>,
    /// For a key, its mapping and the kind of the mapping.
    within: Option<(Node<'t>, &'static Kind)>,
    kind: &'static Kind,
}

/// The role of a key or value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A key of the language, or a misspelt one.
    Key,
    /// A key that the spec chooses: the name of a thing, or a wire key.
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
    /// `true` if the spec chooses the keys below it, so that it opens lines.
    pub opens_lines: bool,
}

/// A name that refers to a thing. The spec may lack the thing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reference {
    /// The possible kinds of the thing, as in [`DefId`](crate::index::DefId).
    pub kinds: &'static [&'static str],
    /// The thing around it: for an enum value, its enum.
    pub owner: Option<String>,
    /// Its name.
    pub name: String,
    /// The place of the name.
    pub span: Span,
}

static TYPE: Kind = Kind::Type;

/// Calls `see` with every key and every scalar of a file, in the order of the file.
pub fn visit<'t>(root: Node<'t>, see: &mut dyn FnMut(Occurrence<'t>)) {
    let walk = Walk {
        part: File::TABLE.name,
        key: None,
        owner: None,
    };
    walk.through(&FILE_KIND, root, see);
}

/// Returns the values and keys below a top key of a file that name a thing, except types of fields.
pub(crate) fn references<'t>(section: &'static AnyKey, node: Node<'t>) -> Vec<Occurrence<'t>> {
    let walk = Walk {
        part: File::NAME,
        key: Some(section.name),
        owner: None,
    };
    let mut found = Vec::new();
    walk.through(&section.kind, node, &mut |occurrence| {
        if occurrence.role != Role::Key && occurrence.kind.refers().is_some() {
            found.push(occurrence);
        }
    });
    found
}

/// Returns the key or scalar at an offset of the file, or the one that ends there.
#[must_use]
pub fn occurrence_at<'t>(root: Node<'t>, offset: usize) -> Option<Occurrence<'t>> {
    let mut found: Option<Occurrence<'t>> = None;
    visit(root, &mut |occurrence| {
        let span = occurrence.node.span();
        if span.start <= offset && offset <= span.end {
            // A node that begins at the offset wins over a node that ends there.
            found = Some(occurrence);
        }
    });
    found
}

/// The position of the visit.
#[derive(Clone, Copy)]
struct Walk<'t> {
    part: &'static str,
    key: Option<&'static str>,
    owner: Option<&'t str>,
}

impl<'t> Walk<'t> {
    fn through(self, kind: &'static Kind, node: Node<'t>, see: &mut dyn FnMut(Occurrence<'t>)) {
        match Cursor::new(kind, node) {
            Cursor::Declared(table) | Cursor::Ambiguous(table) => {
                self.declared(table, kind, node, see);
            }
            Cursor::Chosen { key, value } => self.chosen(kind, (key, value), node, see),
            Cursor::Items(of) => node.items().for_each(|item| self.through(of, item, see)),
            Cursor::Free if node.as_mapping().is_some() => {}
            Cursor::Free if node.as_sequence().is_none() => {
                see(self.occurrence(Role::Value, kind, node, None));
            }
            // `[Station]`.
            Cursor::Free if kind.is_type() => {
                node.items().for_each(|item| self.through(&TYPE, item, see));
            }
            Cursor::Free => {}
        }
    }

    fn declared(
        self,
        table: &'static Table,
        asked: &'static Kind,
        node: Node<'t>,
        see: &mut dyn FnMut(Occurrence<'t>),
    ) {
        for entry in node.entries() {
            let known = table.key(entry.name());
            let walk = Walk {
                part: table.name,
                key: known.map(|key| key.name),
                ..self
            };
            see(walk.occurrence(Role::Key, asked, entry.key, Some((node, asked))));
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
        see: &mut dyn FnMut(Occurrence<'t>),
    ) {
        let is_types = self.part == File::TABLE.name && self.key == Some(FILE.types.name);
        for entry in node.entries() {
            let mut walk = self;
            if is_types {
                walk.owner = entry.key.as_str();
            }
            see(walk.occurrence(Role::Chosen, key, entry.key, Some((node, asked))));
            walk.through(value, entry.value, see);
        }
    }

    fn occurrence(
        self,
        role: Role,
        kind: &'static Kind,
        node: Node<'t>,
        within: Option<(Node<'t>, &'static Kind)>,
    ) -> Occurrence<'t> {
        Occurrence {
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

/// Returns the alternatives of a kind, including those of list items.
fn each(kind: &'static Kind) -> Vec<&'static Kind> {
    match kind {
        Kind::Either(kinds) => kinds.iter().flat_map(each).collect(),
        Kind::List { of, .. } => each(of),
        _ => vec![kind],
    }
}

impl<'t> Occurrence<'t> {
    /// Returns the keys that the mapping does not have yet. Empty if the spec chooses the keys.
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

    /// Returns the words that are valid here, including built-in types and units.
    #[must_use]
    pub fn words(&self) -> Vec<Word> {
        if self.role == Role::Key {
            return Vec::new();
        }
        let kinds = each(self.kind);
        kinds.into_iter().flat_map(words).collect()
    }

    /// Returns the kinds of things that the value can name, as in [`DefId`](crate::index::DefId).
    #[must_use]
    pub fn names(&self) -> &'static [&'static str] {
        match self.role {
            Role::Key => &[],
            Role::Value if self.kind.is_type() => TYPES,
            Role::Chosen | Role::Value => self.kind.refers().unwrap_or_default(),
        }
    }

    /// Returns the reference to a thing in this node.
    #[must_use]
    pub fn reference(&self) -> Option<Reference> {
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
        let owner = if kinds == EnumValue::KINDS {
            Some(self.owner?.to_owned())
        } else {
            None
        };
        Some(Reference {
            kinds,
            owner,
            name: name.to_owned(),
            span,
        })
    }

    /// Returns `true` for a name in code: the `name` of a field or of an enum value.
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

    /// Returns the declared type around it.
    #[must_use]
    pub fn owner(&self) -> Option<&'t str> {
        self.owner
    }

    /// For the key of a section, returns the use of the code ranges for its operations.
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

    /// For the code of an operation, returns the use of its code ranges.
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

/// Collects the tables whose keys a mapping can have. There are several if no key selects one yet.
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
