//! Merges the items of a list.

use super::value::Value;
use super::{Above, Lines, Merge};
use crate::language::grammar::{CODES, COMMON};
use crate::source::SourceFile;
use crate::syntax::Node;

/// The lists with independent items.
const FREE: [&str; 4] = [
    CODES.ranges.name,
    CODES.retired.name,
    COMMON.answers.name,
    COMMON.changes.name,
];

/// An item of one side.
struct Item<'t> {
    value: Value<'t>,
    lines: Lines,
    /// The index of the base item that it precedes. An old item has its own index.
    gap: usize,
    is_new: bool,
}

impl<'t> Merge<'t> {
    /// Returns the merged list, if both sides have only added items.
    pub(super) fn items(
        &mut self,
        above: Above<'t>,
        key: &str,
        base: Option<Node<'t>>,
        ours: Node<'t>,
        theirs: Node<'t>,
    ) -> Option<Value<'t>> {
        let Above::Keys(our_key, their_key) = above else {
            return None;
        };
        if !FREE.contains(&key) {
            return None;
        }
        let base = base.into_iter().flat_map(Node::items);
        let base: Vec<_> = base.map(Value::of).collect();
        let ours = items(self.ours, our_key, &base, ours)?;
        let theirs = items(self.theirs, their_key, &base, theirs)?;
        let mut below = self.ours.last_line(our_key.span());
        let mut merged = Vec::new();
        for gap in 0..=base.len() {
            for item in ours.iter().filter(|it| it.gap == gap && it.is_new) {
                below = item.lines.last;
                merged.push(item.value.clone());
            }
            for item in theirs.iter().filter(|it| it.gap == gap && it.is_new) {
                if !merged.contains(&item.value) {
                    self.add(below, item.lines)?;
                    merged.push(item.value.clone());
                }
            }
            for item in ours.iter().filter(|it| it.gap == gap && !it.is_new) {
                below = item.lines.last;
                merged.push(item.value.clone());
            }
        }
        Some(Value::List(merged))
    }
}

/// Returns the items of one side, or `None` if it has changed an item of the base.
fn items<'t>(
    file: &SourceFile,
    key: Node<'_>,
    base: &[Value<'t>],
    list: Node<'t>,
) -> Option<Vec<Item<'t>>> {
    let mut above = file.last_line(key.span());
    let mut gap = 0;
    let mut items = Vec::new();
    for node in list.as_sequence()? {
        let value = Value::of(node);
        let lines = Lines::of(file, above, node.span());
        above = lines.last;
        let is_new = base.get(gap) != Some(&value);
        items.push(Item {
            value,
            lines,
            gap,
            is_new,
        });
        gap += usize::from(!is_new);
    }
    (gap == base.len()).then_some(items)
}
