//! Finds, in a draft, the keys that tie reports to commands and the keys that hold the state of a process.

use super::draft::Draft;
use crate::language::grammar::SET_OFF;
use crate::model::{
    self, Direction, Exchange, Field, KeyPath, Operation, SetOff, StructType, Tie, TypeRef,
};
use crate::syntax::Node;

/// Splits a path such as `data.status` into its keys.
pub(super) fn path(text: &str) -> KeyPath {
    text.split('.').map(str::to_owned).collect()
}

/// Splits a path such as `response.data.job` into the message of a command and the remaining keys.
pub(super) fn side(text: &str) -> Option<(Direction, &str)> {
    let (side, keys) = text.split_once('.')?;
    let mut sides = Direction::ALL.iter();
    let side = sides.find(|known| known.name() == side)?;
    Some((*side, keys))
}

/// Lowers an entry of `sets_off`: the name of a report, with or without ties.
pub(super) fn set_off(node: Node<'_>) -> Option<SetOff> {
    let entries = SET_OFF.tied.of(node).into_iter().flat_map(Node::entries);
    let tied = entries.filter_map(|entry| {
        let (side, command) = side(entry.key.as_str()?)?;
        Some(Tie {
            side,
            command: path(command),
            report: path(entry.value.as_str()?),
        })
    });
    Some(SetOff {
        report: SET_OFF.report.read_in_or_at(node)?,
        tied: tied.collect(),
    })
}

/// Returns the body of this direction; `None` if its type is unknown.
pub(super) fn body<'d>(
    draft: &'d Draft<'_>,
    operation: &Operation,
    side: Direction,
) -> Option<&'d StructType> {
    let named = &operation.messages()?.body(side).ty;
    draft.struct_named(named.name())
}

/// Returns the fields along the keys, starting at a body.
pub(super) fn way<'d>(
    draft: &'d Draft<'_>,
    from: &'d StructType,
    keys: &[String],
) -> Option<Vec<&'d Field>> {
    let find = |named: &TypeRef| draft.type_named(named.name()).map(|ty| &ty.def);
    model::way(&find, from, keys)
}

/// Returns the paths in a body that hold states of a process.
pub(super) fn states(draft: &Draft<'_>, from: &StructType) -> Vec<KeyPath> {
    let find = |named: &TypeRef| draft.type_named(named.name()).map(|ty| &ty.def);
    let enums = model::enums(&find, from).into_iter();
    let states = enums.filter(|(_, shape)| shape.is_process());
    states.map(|(keys, _)| keys).collect()
}

/// Returns the paths in a body, other than its state, that hold failures.
fn failures(draft: &Draft<'_>, from: &StructType, state: Option<&KeyPath>) -> Vec<KeyPath> {
    let find = |named: &TypeRef| draft.type_named(named.name()).map(|ty| &ty.def);
    let enums = model::enums(&find, from).into_iter();
    let failing = enums.filter(|(keys, shape)| shape.has_failures() && Some(keys) != state);
    failing.map(|(keys, _)| keys).collect()
}

/// Finds state and failures of each report. Without `state_in`, a body with states in one place has its state there.
/// Failures may be in any other place.
pub(super) fn resolve(draft: &mut Draft<'_>) {
    let mut resolved = Vec::new();
    for (index, operation) in draft.operations.iter().enumerate() {
        let Exchange::Report { state, .. } = &operation.item.exchange else {
            continue;
        };
        let Some(body) = body(draft, &operation.item, Direction::Request) else {
            continue;
        };
        let state = state.clone().or_else(|| {
            let mut states = states(draft, body);
            (states.len() == 1).then(|| states.pop()).flatten()
        });
        let failures = failures(draft, body, state.as_ref());
        resolved.push((index, state, failures));
    }
    for (index, found, failing) in resolved {
        if let Some(operation) = draft.operations.get_mut(index)
            && let Exchange::Report {
                state, failures, ..
            } = &mut operation.item.exchange
        {
            *state = found;
            *failures = failing;
        }
    }
}
