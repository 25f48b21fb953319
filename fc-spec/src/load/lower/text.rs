//! Texts and history.

use crate::load::draft::{Place, Placed};
use crate::model::{Aliases, Change, Deprecation, Text};
use crate::syntax::Node;

/// `zh` and `en` of a mapping; empty where missing.
pub(super) fn text(node: Node<'_>) -> Text {
    let [zh, en] = node.get_all(["zh", "en"]);
    text_of(zh, en)
}

/// A text of its nodes in both languages.
pub(super) fn text_of(zh: Option<Node<'_>>, en: Option<Node<'_>>) -> Text {
    Text {
        zh: zh.and_then(string_of).unwrap_or_default(),
        en: en.and_then(string_of).unwrap_or_default(),
    }
}

/// A text in both languages under `key`.
pub(super) fn text_at(node: Node<'_>, key: &str) -> Option<Text> {
    node.get(key).map(text)
}

/// `aliases:`.
pub(super) fn aliases(node: Node<'_>) -> Aliases {
    let [zh, en] = ["zh", "en"].map(|language| {
        let list = node
            .get("aliases")
            .and_then(|aliases| aliases.get(language));
        let items = list.into_iter().flat_map(Node::items);
        items.filter_map(string_of).collect()
    });
    Aliases { zh, en }
}

/// A text under `key`.
pub(super) fn string(node: Node<'_>, key: &str) -> Option<String> {
    node.get(key).and_then(string_of)
}

/// The text of a scalar, without the line end that a block scalar leaves behind.
pub(super) fn string_of(node: Node<'_>) -> Option<String> {
    let text = node.as_str()?;
    Some(text.strip_suffix('\n').unwrap_or(text).to_owned())
}

/// Entries of a list of changes.
pub(super) fn changes(list: Option<Node<'_>>) -> Vec<Placed<'_, Change>> {
    let items = list.into_iter().flat_map(Node::items);
    let change = |node| Placed {
        item: Change {
            date: string(node, "date").unwrap_or_default(),
            text: text(node),
        },
        place: Place { key: node, node },
    };
    items.map(change).collect()
}

/// `changes:` of an operation or type.
pub(super) fn own_changes(node: Node<'_>) -> Vec<Change> {
    changes(node.get("changes"))
        .into_iter()
        .map(|change| change.item)
        .collect()
}

/// `deprecated:`.
pub(super) fn deprecation(node: Option<Node<'_>>) -> Option<Deprecation> {
    let node = node?;
    Some(Deprecation {
        since: string(node, "since"),
        note: text(node),
        replaced_by: string(node, "replaced_by"),
    })
}
