//! What the grammar says of a place in a file, for those who lay out its text.

use super::shape;
use crate::diagnostic::Faults;
use crate::language::grammar::{FIELD_KIND, File, Kind, Table};
use crate::model::Languages;
use crate::syntax::Node;

/// What the grammar says of what is in a node.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Inside {
    /// A mapping with known keys.
    Declared(&'static Table),
    /// A mapping whose keys are chosen freely, and what each has under it. Their order is the spec's own.
    Chosen(&'static Kind),
    /// A list, and what each item is.
    Items(&'static Kind),
    /// Nothing: a scalar, a JSON value, or not what was asked for.
    Free,
}

/// What the grammar says of a file with this root; reports a root that no file can have.
pub(crate) fn inside(root: Node<'_>, faults: &mut Faults) -> Inside {
    if root.as_mapping().is_none() {
        shape::check_kind(
            &Kind::Map(File::TABLE),
            root,
            root.span(),
            Languages::Any,
            faults,
        );
        return Inside::Free;
    }
    Inside::Declared(File::TABLE)
}

impl Inside {
    /// Place of a declared key among the others; `None` where keys have no order, or not this one.
    pub(crate) fn rank(self, key: &str) -> Option<usize> {
        match self {
            Self::Declared(table) => table.keys.iter().position(|known| known.name == key),
            _ => None,
        }
    }

    /// Whether the order of the keys says nothing, so that they may be sorted.
    pub(crate) fn is_declared(self) -> bool {
        matches!(self, Self::Declared(_))
    }

    /// Whether nothing is said of it.
    pub(crate) fn is_free(self) -> bool {
        matches!(self, Self::Free)
    }

    /// Of what stands under a key.
    pub(crate) fn under(self, key: &str, value: Node<'_>) -> Self {
        match self {
            Self::Declared(table) => {
                let kind = table.key(key).map(|known| &known.kind);
                kind.map_or(Self::Free, |kind| of(kind, value))
            }
            Self::Chosen(kind) => of(kind, value),
            _ => Self::Free,
        }
    }

    /// Of an item.
    pub(crate) fn item(self, item: Node<'_>) -> Self {
        match self {
            Self::Items(kind) => of(kind, item),
            _ => Self::Free,
        }
    }

    /// Reports the keys of a mapping that are not declared.
    pub(crate) fn check(self, mapping: Node<'_>, faults: &mut Faults) {
        let Self::Declared(table) = self else {
            return;
        };
        shape::unknown_keys(table, mapping, faults);
    }
}

/// Of a node that a kind is asked of; the choice between kinds is that of the check of shapes.
fn of(kind: &'static Kind, node: Node<'_>) -> Inside {
    match kind {
        Kind::Map(table) if node.as_mapping().is_some() => Inside::Declared(table),
        Kind::Entries { value, .. } if node.as_mapping().is_some() => Inside::Chosen(value),
        Kind::Body if node.as_mapping().is_some() => Inside::Chosen(&FIELD_KIND),
        Kind::List { of, .. } if node.as_sequence().is_some() => Inside::Items(of),
        Kind::Either(kinds) => {
            let mut kinds = kinds.iter();
            let fits = kinds.find(|kind| kind.could_be(node));
            fits.map_or(Inside::Free, |kind| of(kind, node))
        }
        Kind::ByKey { tables, otherwise } if node.as_mapping().is_some() => {
            let mut marked = tables.iter().filter(|(mark, _)| node.entry(mark).is_some());
            match (marked.next(), marked.next()) {
                (None, _) => of(otherwise, node),
                (Some((_, table)), None) => Inside::Declared(table),
                // Two forms in one, which is a fault of the spec.
                (Some(_), Some(_)) => Inside::Free,
            }
        }
        _ => Inside::Free,
    }
}
