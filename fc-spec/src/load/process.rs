//! The keys that tie reports to commands and say how far a process has come, in a draft.

use super::draft::Draft;
use crate::language::grammar::SET_OFF;
use crate::model::{
    self, Direction, Exchange, Field, KeyPath, Operation, SetOff, StructType, Tie, TypeRef,
    TypeShape,
};
use crate::syntax::Node;

/// The keys of `data.status`.
pub(super) fn path(text: &str) -> KeyPath {
    text.split('.').map(str::to_owned).collect()
}

/// Which message of a command `response.data.job` is of, and the keys behind that.
pub(super) fn side(text: &str) -> Option<(Direction, &str)> {
    let (side, keys) = text.split_once('.')?;
    let mut sides = Direction::ALL.iter();
    let side = sides.find(|known| known.name() == side)?;
    Some((*side, keys))
}

/// A report that a command sets off, as written: its name alone, or with what ties it.
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

/// The body that travels this way, unless its type is not known.
pub(super) fn body<'d>(
    draft: &'d Draft<'_>,
    operation: &Operation,
    side: Direction,
) -> Option<&'d StructType> {
    let named = &operation.messages()?.body(side).ty;
    match &draft.type_named(named.name())?.def.shape {
        TypeShape::Struct(shape) => Some(shape),
        TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
    }
}

/// The fields on the way that keys lead from a body.
pub(super) fn way<'d>(
    draft: &'d Draft<'_>,
    from: &'d StructType,
    keys: &[String],
) -> Option<Vec<&'d Field>> {
    let find = |named: &TypeRef| draft.type_named(named.name()).map(|ty| &ty.def);
    model::way(&find, from, keys)
}

/// Where a body has states of a process.
pub(super) fn states(draft: &Draft<'_>, from: &StructType) -> Vec<KeyPath> {
    let find = |named: &TypeRef| draft.type_named(named.name()).map(|ty| &ty.def);
    let enums = model::enums(&find, from).into_iter();
    let states = enums.filter(|(_, shape)| shape.is_process());
    states.map(|(keys, _)| keys).collect()
}

/// Where a body says that something failed, beside its state.
fn failures(draft: &Draft<'_>, from: &StructType, state: Option<&KeyPath>) -> Vec<KeyPath> {
    let find = |named: &TypeRef| draft.type_named(named.name()).map(|ty| &ty.def);
    let enums = model::enums(&find, from).into_iter();
    let failing = enums.filter(|(keys, shape)| shape.has_failures() && Some(keys) != state);
    failing.map(|(keys, _)| keys).collect()
}

/// A report whose body has states in one place has its state there, unless it says so itself; a failure may
/// stand in any other.
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
