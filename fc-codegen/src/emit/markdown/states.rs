//! The diagram of an enum whose values are states of a process.

use fc_spec::model::EnumType;
use minijinja::{Value, context};

/// The start and the end of a process in the diagram.
const OUTSIDE: &str = "[*]";

/// Returns the id of the state with this index. Names are not used, because they may be keywords of the diagram's
/// language.
fn id(place: usize) -> String {
    format!("s{place}")
}

/// Returns the states with an arrow, and the arrows. Both are empty if the spec defines no order of the values.
pub(super) fn diagram(shape: &EnumType) -> Value {
    let is_ordered = shape.order.is_some();
    let values = || shape.values.iter().enumerate().filter(|_| is_ordered);
    let starts = values().filter(|(_, value)| value.start);
    let starts = starts.map(|(place, _)| (OUTSIDE.to_owned(), id(place)));
    let named = |name: &String| shape.values.iter().position(|value| value.name == *name);
    let follow = values().flat_map(|(place, value)| {
        let then = value.then.iter().filter_map(named);
        then.map(move |next| (id(place), id(next)))
    });
    let ends = values().filter(|(_, value)| value.is_final);
    let ends = ends.map(|(place, _)| (id(place), OUTSIDE.to_owned()));
    let changes: Vec<(String, String)> = starts.chain(follow).chain(ends).collect();
    let is_drawn = |id: &String| changes.iter().any(|(from, to)| from == id || to == id);
    let states = values().map(|(place, value)| (id(place), &value.name));
    let states = states.filter(|(id, _)| is_drawn(id));
    let states: Vec<_> = states.map(|(id, name)| context! { id, name }).collect();
    let changes = changes.iter();
    let changes: Vec<_> = changes.map(|(from, to)| context! { from, to }).collect();
    context! { states, changes }
}
