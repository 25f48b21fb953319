//! From a checked draft to the model.

use super::draft::{Draft, Placed};
use crate::model::{Envelope, Frame, Model};

/// The model; `None` where a section is missing, which has been reported.
pub(super) fn build(draft: Draft<'_>) -> Option<Model> {
    let frame = draft.frame?;
    let envelope = draft.envelope?;
    Some(Model {
        protocol: draft.protocol?.item,
        transport: draft.transport?.item,
        frame: Frame {
            byte_order: frame.byte_order,
            header: items(frame.header),
            request_head: frame.request_head,
            response_head: frame.response_head,
            kinds: items(frame.kinds),
            encodings: items(frame.encodings),
            data: frame.data,
        },
        json: draft.json?,
        envelope: Envelope {
            request: items(envelope.request),
            response: items(envelope.response),
        },
        results: items(draft.results),
        calls: draft.calls?.item,
        limits: draft.limits?.item,
        ranges: items(draft.ranges),
        retired: items(draft.retired),
        groups: items(draft.groups),
        operations: items(draft.operations),
        types: shrunk(draft.types.into_iter().map(|ty| ty.def)),
        tables: items(draft.tables),
        retained_sections: items(draft.sections),
        conflicts: items(draft.conflicts),
        answers: items(draft.answers),
        changes: items(draft.changes),
    })
}

fn items<T>(placed: Vec<Placed<'_, T>>) -> Vec<T> {
    shrunk(placed.into_iter().map(|placed| placed.item))
}

/// Without the room that the places took.
fn shrunk<T>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut items: Vec<T> = items.collect();
    items.shrink_to_fit();
    items
}
