//! The conditions for accepting a command, and the times of a report.

use super::shared::Desk;
use crate::emit::markdown::links::Link;
use crate::emit::markdown::rows::{Row, scalar};
use fc_spec::model::{
    Accepted, AcceptedIn, Cadence, Number, Operation, StateSet, Step, TypeShape, Value,
};
use serde::Serialize;

/// The conditions for accepting a command.
#[derive(Debug, Serialize)]
pub(super) struct AcceptedView {
    /// `true` if every state is accepted.
    any: bool,
    /// The enums whose values matter.
    states: Vec<StatesView>,
    /// The commands that must come first.
    after: Vec<Link>,
    note: Option<String>,
}

#[derive(Debug, Serialize)]
struct StatesView {
    link: Link,
    values: Vec<StateView>,
}

#[derive(Debug, Serialize)]
struct StateView {
    /// JSON.
    wire: String,
    name: String,
}

/// The times of a report.
#[derive(Debug, Serialize)]
pub(super) struct CadenceView {
    /// The field that triggers it.
    field: Option<Link>,
    /// The change of a number between two reports.
    step: Option<String>,
    every_ms: Option<u32>,
    within_ms: Option<u32>,
}

pub(super) fn accepted(desk: Desk<'_, '_>, accepted: &Accepted) -> AcceptedView {
    let states = accepted.state_sets().iter();
    let after = accepted.after.iter();
    AcceptedView {
        any: matches!(accepted.states, Some(AcceptedIn::Any)),
        states: states.map(|set| states_view(desk, set)).collect(),
        after: after
            .filter_map(|name| desk.book.operation(name))
            .map(|command| desk.operation(command))
            .collect(),
        note: accepted.note.as_ref().map(|note| desk.sentence(note)),
    }
}

fn states_view(desk: Desk<'_, '_>, set: &StateSet) -> StatesView {
    let ty = desk.book.model.types.get(&set.ty);
    let known = match &ty.shape {
        TypeShape::Enum(shape) => shape.values.as_slice(),
        TypeShape::Struct(_) | TypeShape::OneOf(_) => &[],
    };
    let values = set.values.iter().map(|wire| {
        let value = known.iter().find(|value| value.wire == *wire);
        StateView {
            wire: scalar(wire),
            name: value.map_or_else(String::new, |value| value.name.clone()),
        }
    });
    StatesView {
        link: Link {
            text: desk.lang.text(&ty.title).to_owned(),
            href: desk.page.link(desk.book.place_of_type(ty)),
        },
        values: values.collect(),
    }
}

/// Returns the times of a report. `rows` is the table of its fields, for a link to one of them.
pub(super) fn cadence<'r>(
    operation: &Operation,
    mut rows: impl Iterator<Item = &'r Row>,
) -> Option<CadenceView> {
    let cadence = operation.cadence()?;
    let field = cadence.field().map(|path| {
        // The rows mark items of lists, and the path of a cadence does not.
        let row = rows.find(|row| row.path().replace("[]", "") == path);
        Link {
            text: format!("`{}`", row.map_or(path, Row::path)),
            href: row.map_or_else(String::new, |row| format!("#{}", row.anchor())),
        }
    });
    let number = |number: &Number| Value::Number(number.clone()).to_string();
    Some(CadenceView {
        field,
        step: match cadence {
            Cadence::Step(Step { by, .. }) => Some(number(by)),
            Cadence::OnChange(_) | Cadence::EveryMs(_) | Cadence::WithinMs(_) => None,
        },
        every_ms: match cadence {
            Cadence::EveryMs(ms) => Some(*ms),
            Cadence::OnChange(_) | Cadence::Step(_) | Cadence::WithinMs(_) => None,
        },
        within_ms: match cadence {
            Cadence::WithinMs(ms) => Some(*ms),
            Cadence::OnChange(_) | Cadence::Step(_) | Cadence::EveryMs(_) => None,
        },
    })
}
