//! Lowers texts and history.

use crate::language::grammar::{
    ALIASES, CHANGE, COMMON, DEPRECATED, FIELD_DEPRECATED, both_languages,
};
use crate::load::draft::{Origin, Sourced};
use crate::model::{Aliases, Change, Deprecation};
use crate::syntax::Node;

/// Lowers `aliases:`.
pub(super) fn aliases(node: Node<'_>) -> Aliases {
    let aliases = COMMON.aliases.of(node);
    Aliases {
        zh: ALIASES.zh.get(aliases),
        en: ALIASES.en.get(aliases),
    }
}

/// Lowers the entries of a list of changes.
pub(super) fn changes<'a>(items: impl Iterator<Item = Node<'a>>) -> Vec<Sourced<'a, Change>> {
    let change = |node| Sourced {
        item: Change {
            date: CHANGE.date.get(node),
            text: both_languages(node),
        },
        origin: Origin { key: node, node },
    };
    items.map(change).collect()
}

/// Lowers `changes:` of an operation or type.
pub(super) fn own_changes(node: Node<'_>) -> Vec<Change> {
    changes(COMMON.changes.items(node))
        .into_iter()
        .map(|change| change.item)
        .collect()
}

/// Lowers `deprecated:`.
pub(super) fn deprecation(node: Option<Node<'_>>) -> Option<Deprecation> {
    let node = node?;
    Some(Deprecation {
        since: FIELD_DEPRECATED.since.read(node),
        sunset: FIELD_DEPRECATED.sunset.read(node),
        note: both_languages(node),
        replaced_by: DEPRECATED.replaced_by.read(node),
    })
}
