//! Checks that a new text has the meaning of the old one.

use crate::language::Cursor;
use crate::syntax::{Node, NodeKind, Tree};

/// Returns `true` if two texts have the same meaning. The scalars and comments must be the same, and each order that
/// has a meaning.
pub(super) fn same(
    (old, old_text): (&Tree<'_>, &str),
    (new, new_text): (&Tree<'_>, &str),
    cursor: Cursor,
) -> bool {
    old.sorted_comments(old_text) == new.sorted_comments(new_text)
        && same_node(old.root(), new.root(), cursor)
}

fn same_node(old: Node<'_>, new: Node<'_>, cursor: Cursor) -> bool {
    match (old.kind(), new.kind()) {
        (NodeKind::Null, NodeKind::Null) => true,
        (NodeKind::Scalar(old), NodeKind::Scalar(new)) => old == new,
        (NodeKind::Sequence(old), NodeKind::Sequence(new)) => {
            let (old, new): (Vec<_>, Vec<_>) = (old.collect(), new.collect());
            let mut pairs = old.iter().zip(&new);
            old.len() == new.len()
                && pairs.all(|(old, new)| same_node(*old, *new, cursor.item(*old)))
        }
        (NodeKind::Mapping(old), NodeKind::Mapping(new)) => {
            let (mut old, new): (Vec<_>, Vec<_>) = (old.collect(), new.collect());
            if cursor.is_declared() {
                // The keys are matched by name, because the formatter may have changed their order.
                let place = |name: &str| new.iter().position(|entry| entry.name() == name);
                old.sort_by_key(|entry| place(entry.name()));
            }
            let mut pairs = old.iter().zip(&new);
            old.len() == new.len()
                && pairs.all(|(old, new)| {
                    old.key.as_scalar() == new.key.as_scalar()
                        && same_node(old.value, new.value, cursor.under(old.name(), old.value))
                })
        }
        _ => false,
    }
}
