//! The diagram of an enum whose values are states of a process.

use fc_spec::model::EnumType;
use serde::Serialize;

/// Boxes and arrows. The diagram is empty if the spec defines no order of the values.
#[derive(Debug, Default, Serialize)]
pub(super) struct StateDiagram {
    /// The states with an arrow.
    states: Vec<State>,
    changes: Vec<Change>,
}

#[derive(Debug, Serialize)]
struct State {
    id: String,
    name: String,
}

#[derive(Debug, Serialize)]
struct Change {
    from: String,
    to: String,
}

/// The start and the end of a process in the diagram.
const OUTSIDE: &str = "[*]";

/// Returns the id of the state with this index. Names are not used, because they may be keywords of the diagram's
/// language.
fn id(place: usize) -> String {
    format!("s{place}")
}

impl StateDiagram {
    pub(super) fn of(shape: &EnumType) -> Self {
        if shape.order.is_none() {
            return Self::default();
        }
        let values = || shape.values.iter().enumerate();
        let change = |from: String, to: String| Change { from, to };
        let starts = values().filter(|(_, value)| value.start);
        let starts = starts.map(|(place, _)| change(OUTSIDE.to_owned(), id(place)));
        let named = |name: &String| shape.values.iter().position(|value| value.name == *name);
        let follow = values().flat_map(|(place, value)| {
            let then = value.then.iter().filter_map(named);
            then.map(move |next| change(id(place), id(next)))
        });
        let ends = values().filter(|(_, value)| value.is_final);
        let ends = ends.map(|(place, _)| change(id(place), OUTSIDE.to_owned()));
        let changes: Vec<Change> = starts.chain(follow).chain(ends).collect();
        let states = values().map(|(place, value)| State {
            id: id(place),
            name: value.name.clone(),
        });
        let is_drawn = |state: &State| {
            let mut changes = changes.iter();
            changes.any(|it| it.from == state.id || it.to == state.id)
        };
        Self {
            states: states.filter(is_drawn).collect(),
            changes,
        }
    }
}
