//! A node of a file and the part of the grammar that applies to it.

use crate::language::grammar::{FIELD_KIND, File, Kind, Table};
use crate::syntax::Node;

/// The content of a node according to the grammar.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Cursor {
    /// A mapping with known keys.
    Declared(&'static Table),
    /// A mapping with the keys of two forms, which is an error. Holds the first form.
    Ambiguous(&'static Table),
    /// A mapping whose keys the spec chooses, in an order with a meaning.
    Chosen {
        /// The form of the keys.
        key: &'static Kind,
        /// The form of the values.
        value: &'static Kind,
    },
    /// A list, with the form of its items.
    Items(&'static Kind),
    /// A scalar, a JSON value, or a node with an unexpected form.
    Free,
}

pub(super) static FILE_KIND: Kind = Kind::Map(File::TABLE);
static WIRE_KEY: Kind = Kind::WireKey;

impl Cursor {
    /// Returns the cursor at the root of a file.
    pub fn file(root: Node<'_>) -> Self {
        Self::new(&FILE_KIND, root)
    }

    /// Returns the cursor at a node that should be of this kind. With alternatives, the first one that the node could be applies.
    pub fn new(kind: &'static Kind, node: Node<'_>) -> Self {
        let is_mapping = node.as_mapping().is_some();
        match kind {
            Kind::Map(table) if is_mapping => Self::Declared(table),
            Kind::Entries { key, value, .. } if is_mapping => Self::Chosen { key, value },
            Kind::Body if is_mapping => Self::Chosen {
                key: &WIRE_KEY,
                value: &FIELD_KIND,
            },
            Kind::List { of, .. } if node.as_sequence().is_some() => Self::Items(of),
            Kind::Either(kinds) => {
                let fits = kinds.iter().find(|kind| kind.could_be(node));
                fits.map_or(Self::Free, |kind| Self::new(kind, node))
            }
            Kind::ByKey { tables, otherwise } if is_mapping => {
                let mut marked = tables.iter().filter(|(mark, _)| node.entry(mark).is_some());
                match (marked.next(), marked.next()) {
                    (None, _) => Self::new(otherwise, node),
                    (Some((_, table)), None) => Self::Declared(table),
                    (Some((_, table)), Some(_)) => Self::Ambiguous(table),
                }
            }
            _ => Self::Free,
        }
    }

    /// Returns the position of a declared key in the order of the grammar. `None` if the keys have no order, or for
    /// another key.
    pub fn rank(self, key: &str) -> Option<usize> {
        match self {
            Self::Declared(table) => table.keys.iter().position(|known| known.name == key),
            _ => None,
        }
    }

    /// Returns `true` if the order of the keys has no meaning, so that they may be sorted.
    pub fn is_declared(self) -> bool {
        matches!(self, Self::Declared(_))
    }

    /// Returns `true` if the grammar specifies neither keys nor an order for the content.
    pub fn is_free(self) -> bool {
        matches!(self, Self::Free | Self::Ambiguous(_))
    }

    /// Returns the cursor at the value of a key.
    pub fn under(self, key: &str, value: Node<'_>) -> Self {
        match self {
            Self::Declared(table) => {
                let known = table.key(key);
                known.map_or(Self::Free, |known| Self::new(&known.kind, value))
            }
            Self::Chosen { value: kind, .. } => Self::new(kind, value),
            _ => Self::Free,
        }
    }

    /// Returns the cursor at an item.
    pub fn item(self, item: Node<'_>) -> Self {
        match self {
            Self::Items(kind) => Self::new(kind, item),
            _ => Self::Free,
        }
    }
}
