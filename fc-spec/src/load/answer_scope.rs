//! What an answer governs: the facts that its `about:` names, as the spec says them now.

use super::draft::{AnswerDraft, Draft};
use crate::language::grammar::{ANSWER, FIELD, ITEMS, OBJECT};
use crate::model::{BodyState, Fact, Kind, Operation, Subject};
use crate::syntax::{Entry, Node};
use crate::vocabulary::Word as _;

/// Says in `about:` that a key is not there.
pub(crate) const ABSENT: &str = "absent";

/// A fact that an answer governs.
#[derive(Clone, Copy, Debug)]
pub(super) struct CoveredFact<'a> {
    /// Its path.
    pub path: Node<'a>,
    /// What is said of it until it is settled.
    pub meanwhile: Node<'a>,
    /// What is said of it now.
    pub found: Found<'a>,
    /// Whether the answer is about a value as well, which may be right as it is.
    beside_a_value: bool,
}

/// Where a path leads.
#[derive(Clone, Copy, Debug)]
pub(super) enum Found<'a> {
    /// To a fact of an operation of this kind, and how sure it is.
    Fact(Fact, BodyState, Kind),
    /// To a value.
    Value(Node<'a>),
    /// To a key that this mapping does not have, or that this short form of a field has no room for.
    Absent(Node<'a>),
    /// To something that is no single value.
    Several(Node<'a>),
    /// Nowhere: there is no such key.
    Nowhere(&'a str),
}

impl CoveredFact<'_> {
    /// What is said of it until it is settled, as text.
    pub fn meanwhile(&self) -> &str {
        self.meanwhile.as_str().unwrap_or_default()
    }

    /// Whether it still waits for the owner: a fact is in doubt as long as it is inferred or open, whichever it was.
    pub fn is_untouched(&self) -> bool {
        match self.found {
            Found::Fact(_, state, _) => self.has_to_change() && is_doubt(state),
            _ => self.has_to_change() && self.is_as_before() == Some(true),
        }
    }

    /// Whether it is as it was before it was settled; `None` where that cannot be told, which is a fault of its own.
    pub fn is_as_before(&self) -> Option<bool> {
        match self.found {
            Found::Fact(_, state, _) => {
                let before = BodyState::named(self.meanwhile())?;
                is_doubt(before).then_some(state == before)
            }
            Found::Value(node) => Some(node.as_str() == self.meanwhile.as_str()),
            Found::Absent(_) => Some(self.meanwhile() == ABSENT),
            Found::Several(_) | Found::Nowhere(_) => None,
        }
    }

    /// Whether nobody but the owner knows what to write: an inference is a guess that they may confirm.
    pub fn has_to_be_said(&self) -> bool {
        self.has_to_change() && self.meanwhile() != BodyState::Inferred.name()
    }

    /// Whether to settle it is to change it. A heading or a type byte is confirmed as it is, and so may be a value and
    /// the lack of another beside it.
    pub fn has_to_change(&self) -> bool {
        match self.found {
            Found::Fact(fact, ..) => !matches!(fact, Fact::Title | Fact::Type),
            _ => self.meanwhile() == ABSENT && !self.beside_a_value,
        }
    }
}

/// Whether this is a state that only the owner can end.
pub(super) fn is_doubt(state: BodyState) -> bool {
    matches!(state, BodyState::Inferred | BodyState::Open)
}

/// Everything that an answer governs.
pub(super) fn covered_facts<'d, 'a>(
    draft: &'d Draft<'a>,
    answer: &'d AnswerDraft<'a>,
) -> impl Iterator<Item = CoveredFact<'a>> + use<'d, 'a> {
    let operation = match &answer.item.subject {
        Subject::Operation(name) => {
            let mut all = draft.operations.iter();
            all.find(|operation| {
                operation.item.name == *name && operation.origin.node.span() == answer.holder.span()
            })
        }
        _ => None,
    };
    let operation = operation.map(|operation| &operation.item);
    let holder = answer.holder;
    let entries = ANSWER.about.of(answer.origin.node).map(Node::entries);
    let entries = entries.into_iter().flatten();
    let is_value = |Entry { key, value }: Entry<'_>| {
        let path = key.as_str().unwrap_or_default();
        let is_fact = operation.is_some() && Fact::named(path).is_some();
        !is_fact && value.as_str() != Some(ABSENT)
    };
    let beside_a_value = entries.clone().any(is_value);
    entries.map(move |Entry { key, value }| CoveredFact {
        path: key,
        meanwhile: value,
        found: find(operation, holder, key.as_str().unwrap_or_default()),
        beside_a_value,
    })
}

fn find<'a>(operation: Option<&Operation>, holder: Node<'a>, path: &'a str) -> Found<'a> {
    if let Some(operation) = operation
        && let Some(fact) = Fact::named(path)
        && let Some(state) = operation.fact_state(fact)
    {
        return Found::Fact(fact, state, operation.kind());
    }
    let (way, last) = path.rsplit_once('.').unwrap_or(("", path));
    let mut node = holder;
    for key in way.split('.').filter(|key| !key.is_empty()) {
        match step(node, key) {
            Some(next) => node = next,
            None => return Found::Nowhere(key),
        }
    }
    match (step(node, last), node.as_scalar()) {
        (Some(value), _) if value.as_scalar().is_some() => Found::Value(value),
        (Some(value), _) => Found::Several(value),
        // A field in the short form is its type.
        (None, Some(_)) if last == FIELD.r#type.name => Found::Value(node),
        (None, Some(_)) => Found::Absent(node),
        (None, None) if node.as_mapping().is_some() => Found::Absent(node),
        (None, None) => Found::Nowhere(last),
    }
}

/// What stands under a key, or under that of a field of an object that is written in place.
fn step<'a>(node: Node<'a>, key: &str) -> Option<Node<'a>> {
    let inside = |within: Option<Node<'a>>| within?.get(key);
    node.get(key)
        .or_else(|| inside(OBJECT.fields.of(node)))
        .or_else(|| inside(ITEMS.items.of(node)))
}
