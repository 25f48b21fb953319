//! Resolves the paths in `about:` of an answer to the facts that the answer covers.

use super::draft::{AnswerDraft, Draft};
use crate::language::grammar::{ANSWER, FIELD, ITEMS, OBJECT};
use crate::model::{BodyState, Fact, Kind, Operation, Subject};
use crate::syntax::{Entry, Node};
use crate::vocabulary::Word as _;

/// The word in `about:` for an absent key.
pub(crate) const ABSENT: &str = "absent";

/// A fact that an answer covers.
#[derive(Clone, Copy, Debug)]
pub(super) struct CoveredFact<'a> {
    /// The path in `about:`.
    pub path: Node<'a>,
    /// The state or value until the owner confirms the answer.
    pub meanwhile: Node<'a>,
    /// The current state or value.
    pub found: Found<'a>,
    /// `true` if the answer also covers a value. The owner may confirm that value unchanged.
    beside_a_value: bool,
}

/// The target of a path.
#[derive(Clone, Copy, Debug)]
pub(super) enum Found<'a> {
    /// A fact of an operation of this kind, with its state.
    Fact(Fact, BodyState, Kind),
    /// A value.
    Value(Node<'a>),
    /// An absent key. The node is the mapping without the key, or a field in the short form.
    Absent(Node<'a>),
    /// A mapping or list instead of a single value.
    Several(Node<'a>),
    /// No target: this key does not exist.
    Nowhere(&'a str),
}

impl CoveredFact<'_> {
    /// Returns the state or value until the owner confirms the answer, as written.
    pub fn meanwhile(&self) -> &str {
        self.meanwhile.as_str().unwrap_or_default()
    }

    /// Returns `true` if the fact still waits for the owner. A fact waits while it is inferred or open, regardless of
    /// its earlier state.
    pub fn is_untouched(&self) -> bool {
        match self.found {
            Found::Fact(_, state, _) => self.has_to_change() && is_doubt(state),
            _ => self.has_to_change() && self.is_as_before() == Some(true),
        }
    }

    /// Returns `true` if the fact equals its `about:` entry; `None` if it cannot be compared, which is a separate
    /// error.
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

    /// Returns `true` if only the owner knows the value. An inference is a guess that the owner may confirm.
    pub fn has_to_be_said(&self) -> bool {
        self.has_to_change() && self.meanwhile() != BodyState::Inferred.name()
    }

    /// Returns `true` if settling the fact changes it. The owner confirms a heading or a type byte unchanged. With a
    /// value in the same answer, an absent key may also stay absent.
    pub fn has_to_change(&self) -> bool {
        match self.found {
            Found::Fact(fact, ..) => !matches!(fact, Fact::Title | Fact::Type),
            _ => self.meanwhile() == ABSENT && !self.beside_a_value,
        }
    }
}

/// Returns `true` for a state that only the owner can end.
pub(super) fn is_doubt(state: BodyState) -> bool {
    matches!(state, BodyState::Inferred | BodyState::Open)
}

/// Returns every fact that an answer covers.
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
        // A field in the short form consists of its type.
        (None, Some(_)) if last == FIELD.r#type.name => Found::Value(node),
        (None, Some(_)) => Found::Absent(node),
        (None, None) if node.as_mapping().is_some() => Found::Absent(node),
        (None, None) => Found::Nowhere(last),
    }
}

/// Returns the value under a key of the mapping, or of the fields in an inline object.
fn step<'a>(node: Node<'a>, key: &str) -> Option<Node<'a>> {
    let inside = |within: Option<Node<'a>>| within?.get(key);
    node.get(key)
        .or_else(|| inside(OBJECT.fields.of(node)))
        .or_else(|| inside(ITEMS.items.of(node)))
}
