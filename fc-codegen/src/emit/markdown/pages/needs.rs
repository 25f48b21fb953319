//! The conditions for accepting a command, and the times of a report.

use super::shared::{Desk, list};
use crate::emit::markdown::links::Link;
use crate::emit::markdown::rows::{Row, scalar};
use fc_spec::model::{Accepted, AcceptedIn, Cadence, Operation, StateSet, TypeShape, Value};
use minijinja::context;

pub(super) fn accepted(desk: Desk<'_, '_>, accepted: &Accepted) -> minijinja::Value {
    let states = accepted.state_sets().iter();
    let after = accepted.after.iter();
    let after = after.filter_map(|name| Some(desk.operation(desk.book.operation(name)?)));
    context! {
        any => matches!(accepted.states, Some(AcceptedIn::Any)),
        states => list(states.map(|set| states_view(desk, set))),
        after => list(after),
        note => accepted.note.as_ref().map(|note| desk.sentence(note)),
    }
}

fn states_view(desk: Desk<'_, '_>, set: &StateSet) -> minijinja::Value {
    let ty = desk.book.model.types.get(&set.ty);
    let known = match &ty.shape {
        TypeShape::Enum(shape) => shape.values.as_slice(),
        TypeShape::Struct(_) | TypeShape::OneOf(_) => &[],
    };
    let values = set.values.iter().map(|wire| {
        let value = known.iter().find(|value| value.wire == *wire);
        context! {
            wire => scalar(wire),
            name => value.map_or_else(String::new, |value| value.name.clone()),
        }
    });
    context! {
        link => desk.to(desk.lang.text(&ty.title), desk.book.place_of_type(ty)),
        values => list(values),
    }
}

/// Returns the times of a report. `rows` is the table of its fields, for a link to one of them.
pub(super) fn cadence<'r>(
    operation: &Operation,
    mut rows: impl Iterator<Item = &'r Row>,
) -> Option<minijinja::Value> {
    let cadence = operation.cadence()?;
    let field = cadence.field().map(|path| {
        // The rows mark items of lists, and the path of a cadence does not.
        let row = rows.find(|row| row.path().replace("[]", "") == path);
        Link {
            text: format!("`{}`", row.map_or(path, Row::path)),
            href: row.map_or_else(String::new, |row| format!("#{}", row.anchor())),
        }
    });
    let (step, every_ms, within_ms) = match cadence {
        Cadence::OnChange(_) => (None, None, None),
        Cadence::Step(step) => (Some(step.by.clone()), None, None),
        Cadence::EveryMs(ms) => (None, Some(*ms), None),
        Cadence::WithinMs(ms) => (None, None, Some(*ms)),
    };
    let step = step.map(|by| Value::Number(by).to_string());
    Some(context! { field, step, every_ms, within_ms })
}
