//! Lowers preconditions of commands and cadences of reports.

use crate::language::grammar::{ACCEPTED, CADENCE, STEP};
use crate::language::scalar;
use crate::model::{Accepted, AcceptedIn, Cadence, Scalar, StateSet, Step, TypeRef};
use crate::syntax::{Entry, Node};

/// Lowers `accepted:` of a command.
pub(super) fn accepted(node: Node<'_>) -> Accepted {
    let states = ACCEPTED.r#in.of(node).map(|node| match node.as_mapping() {
        Some(enums) => AcceptedIn::States(enums.map(state_set).collect()),
        None => AcceptedIn::Any,
    });
    Accepted {
        states,
        after: ACCEPTED.after.get(node),
        note: ACCEPTED.note.read(node),
    }
}

fn state_set(Entry { key, value }: Entry<'_>) -> StateSet {
    let values: Vec<Scalar> = value.items().filter_map(scalar::scalar).collect();
    StateSet {
        ty: TypeRef::named(key.as_str().unwrap_or_default()),
        values,
    }
}

/// Lowers `cadence:` of a report; `None` if it is malformed, which has its own error.
pub(super) fn cadence(node: Node<'_>) -> Option<Cadence> {
    if let Some(step) = CADENCE.step.of(node) {
        return Some(Cadence::Step(Step {
            field: STEP.field.read(step)?,
            by: STEP.by.read(step)?,
        }));
    }
    let on_change = CADENCE.on_change.read(node).map(Cadence::OnChange);
    let every = || CADENCE.every_ms.read(node).map(Cadence::EveryMs);
    let within = || CADENCE.within_ms.read(node).map(Cadence::WithinMs);
    on_change.or_else(every).or_else(within)
}
