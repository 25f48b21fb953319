//! Merges the entries of a mapping.

use super::value::Value;
use super::{Above, Lines, Merge};
use crate::language::Cursor;
use crate::language::grammar::{CHOICE, FIELD_KIND};
use crate::syntax::{Entry, Node, Scalar};

/// An entry of the result.
struct Merged<'t> {
    key: Scalar<'t>,
    value: Value<'t>,
    /// The line of ours after which a following entry is added.
    line: usize,
    /// `true` if only ours has the entry.
    is_own: bool,
}

/// The dependency between the entries of a mapping.
#[derive(Clone, Copy, PartialEq)]
enum Bond {
    /// The entries are independent.
    None,
    /// All entries describe the same subject. Only additions inside their values can be merged.
    OneThing,
}

/// Returns `None` if the order of the entries has a meaning.
fn bond(above: Above<'_>, cursor: Cursor) -> Option<Bond> {
    match (above, cursor) {
        (Above::File, _) => Some(Bond::None),
        (_, Cursor::Declared(_)) => Some(Bond::OneThing),
        (Above::Keys(key, _), Cursor::Chosen { value, .. }) => {
            let is_ordered = std::ptr::eq(value, &raw const FIELD_KIND)
                || key.as_str() == Some(CHOICE.one_of.name);
            (!is_ordered).then_some(Bond::None)
        }
        _ => None,
    }
}

impl<'t> Merge<'t> {
    /// Returns the merged mapping.
    pub(super) fn entries(
        &mut self,
        above: Above<'t>,
        cursor: Cursor,
        base: Option<Node<'t>>,
        ours: Node<'t>,
        theirs: Node<'t>,
    ) -> Option<Value<'t>> {
        let bond = bond(above, cursor)?;
        let base: Vec<_> = base.into_iter().flat_map(Node::entries).collect();
        let ours: Vec<_> = ours.as_mapping()?.collect();
        let theirs: Vec<_> = theirs.as_mapping()?.collect();
        let (our_head, their_head) = match above {
            Above::File => (0, 0),
            Above::Keys(our, their) => (
                self.ours.last_line(our.span()),
                self.theirs.last_line(their.span()),
            ),
        };

        let mut merged: Vec<Merged<'t>> = Vec::new();
        let mut before = our_head;
        for entry in &ours {
            let lines = Lines::of(self.ours, before, entry.span());
            before = lines.last;
            let others = [find(&base, *entry), find(&theirs, *entry)];
            let value = match others {
                [None, None] if bond == Bond::None => Value::of(entry.value),
                [base, Some(their)] => {
                    let theirs = (their, their_lines(self, &theirs, their_head, their));
                    self.of_both(bond, cursor, base, (*entry, lines), theirs)?
                }
                // Theirs has removed an entry that ours has not changed.
                [Some(base), None] if bond == Bond::None && same(base, *entry) => {
                    self.edits.remove_lines(self.ours, lines.span(self.ours)?);
                    continue;
                }
                _ => return None,
            };
            merged.push(Merged {
                key: entry.key.as_scalar()?,
                value,
                line: lines.last,
                is_own: others.iter().all(Option::is_none),
            });
        }

        let mut previous: Option<Scalar<'t>> = None;
        for entry in &theirs {
            let key = entry.key.as_scalar()?;
            let before = previous.replace(key);
            if find(&ours, *entry).is_some() {
                continue;
            }
            if let Some(base) = find(&base, *entry) {
                // Ours has removed it.
                if same(base, *entry) && bond == Bond::None {
                    continue;
                }
                return None;
            }
            if bond == Bond::OneThing {
                return None;
            }
            // After the same entry as in theirs, and after the additions of ours there.
            let place = before.and_then(|key| merged.iter().position(|it| it.key == key));
            let mut at = place.map_or(0, |place| place + 1);
            while merged.get(at).is_some_and(|it| it.is_own) {
                at += 1;
            }
            let below = match at.checked_sub(1).and_then(|at| merged.get(at)) {
                Some(before) => before.line,
                // Text at the top of a file belongs to the file.
                None if our_head == 0 => return None,
                None => our_head,
            };
            self.add(below, their_lines(self, &theirs, their_head, *entry))?;
            merged.insert(
                at,
                Merged {
                    key,
                    value: Value::of(entry.value),
                    line: below,
                    is_own: false,
                },
            );
        }
        let entries = merged.into_iter().map(|it| (it.key, it.value));
        Some(Value::Map(entries.collect()))
    }

    /// Returns the merged value of an entry that both have.
    fn of_both(
        &mut self,
        bond: Bond,
        cursor: Cursor,
        base: Option<Entry<'t>>,
        (ours, lines): (Entry<'t>, Lines),
        (theirs, their_lines): (Entry<'t>, Lines),
    ) -> Option<Value<'t>> {
        let is_base = |entry| base.is_some_and(|base| same(base, entry));
        if same(ours, theirs) || (is_base(theirs) && bond == Bond::None) {
            return Some(Value::of(ours.value));
        }
        if is_base(ours) && bond == Bond::None {
            let text = their_lines.text(self.theirs)?;
            self.edits.replace(lines.span(self.ours)?, text);
            return Some(Value::of(theirs.value));
        }
        let cursor = cursor.under(ours.name(), ours.value);
        let values = [
            base.map(|it| it.value),
            Some(ours.value),
            Some(theirs.value),
        ];
        let above = Above::Keys(ours.key, theirs.key);
        self.both(above, ours.name(), cursor, values)
    }
}

fn find<'t>(entries: &[Entry<'t>], like: Entry<'t>) -> Option<Entry<'t>> {
    let mut entries = entries.iter().copied();
    entries.find(|entry| entry.key.as_scalar() == like.key.as_scalar())
}

fn same(one: Entry<'_>, other: Entry<'_>) -> bool {
    Value::of(one.value) == Value::of(other.value)
}

/// Returns the lines of an entry of theirs.
fn their_lines(merge: &Merge<'_>, theirs: &[Entry<'_>], head: usize, entry: Entry<'_>) -> Lines {
    let at = entry.key.span().start;
    let above = theirs.iter().rfind(|it| it.key.span().start < at);
    let above = above.map_or(head, |it| merge.theirs.last_line(it.span()));
    Lines::of(merge.theirs, above, entry.span())
}
