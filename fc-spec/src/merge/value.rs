//! The content of a text without its places.

use crate::source::SourceFile;
use crate::syntax::{Node, NodeKind, Scalar, Tree};

/// The content of a node. A mapping includes the order of its keys.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value<'t> {
    Null,
    Scalar(Scalar<'t>),
    List(Vec<Self>),
    Map(Vec<(Scalar<'t>, Self)>),
}

impl<'t> Value<'t> {
    pub fn of(node: Node<'t>) -> Self {
        match node.kind() {
            NodeKind::Null => Self::Null,
            NodeKind::Scalar(scalar) => Self::Scalar(scalar),
            NodeKind::Sequence(items) => Self::List(items.map(Self::of).collect()),
            NodeKind::Mapping(entries) => Self::Map(
                entries
                    .filter_map(|entry| Some((entry.key.as_scalar()?, Self::of(entry.value))))
                    .collect(),
            ),
        }
    }
}

/// Returns the comments of the result: those of ours, with the additions and without the removals of theirs. Returns
/// `None` if both have removed the same comment.
pub(super) fn merged_comments<'t>(
    [base, ours, theirs]: [(&Tree<'_>, &'t SourceFile); 3],
) -> Option<Vec<&'t str>> {
    let comments = |(tree, file): (&Tree<'_>, &'t SourceFile)| tree.sorted_comments(&file.text);
    let [base, mut merged, theirs] = [base, ours, theirs].map(comments);
    let mut added = theirs;
    for comment in base {
        if let Some(at) = added.iter().position(|it| *it == comment) {
            added.remove(at);
        } else {
            let at = merged.iter().position(|it| *it == comment)?;
            merged.remove(at);
        }
    }
    merged.extend(added);
    merged.sort_unstable();
    Some(merged)
}
