//! What could be read of a spec, whether or not it has faults.

use super::draft::{Draft, Sourced};
use crate::model::{Envelope, Frame, FrameKinds, Model, Partial, TypeDef, TypeShape, Types, link};

/// What loading a spec comes to. Its faults are told apart from it, since a spec with faults has all of this, too.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// What could be read.
    pub partial: Partial,
    /// Whether all files could be read as YAML, so that what is missing is really missing.
    pub whole: bool,
    /// Whether nothing stands in the way of a model.
    sound: bool,
}

impl Loaded {
    /// The model; `None` if there is any error in the spec. Warnings do not stand in the way.
    #[must_use]
    pub fn model(self) -> Option<Model> {
        self.into_model().ok()
    }

    /// The model, or what could be read if there is any error in the spec.
    ///
    /// # Errors
    ///
    /// What could be read.
    pub fn into_model(self) -> Result<Model, Box<Partial>> {
        if self.sound {
            self.partial.whole()
        } else {
            Err(Box::new(self.partial))
        }
    }
}

/// Takes the places off a checked draft. `sound`: it has no fault that stands in the way of a model.
pub(super) fn build(draft: Draft<'_>, whole: bool, sound: bool) -> Loaded {
    let types = draft.types.into_iter().map(|ty| {
        let mut broken = ty.parts.iter().map(|part| part.broken);
        known(ty.def, || broken.next() == Some(true))
    });
    let frame = draft.frame.and_then(|frame| {
        Some(Frame {
            byte_order: frame.byte_order,
            header: items(frame.header),
            request_head: frame.request_head,
            response_head: frame.response_head,
            kinds: FrameKinds::try_from(items(frame.kinds)).ok()?,
            encodings: items(frame.encodings),
            data: frame.data,
        })
    });
    let envelope = draft.envelope.map(|envelope| Envelope {
        request: items(envelope.request),
        response: items(envelope.response),
    });
    let mut partial = Partial {
        protocol: draft.protocol.map(|it| it.item),
        transport: draft.transport.map(|it| it.item),
        frame,
        json: draft.json,
        envelope,
        results: items(draft.results),
        calls: draft.calls.map(|it| it.item),
        limits: draft.limits.map(|it| it.item),
        ranges: items(draft.ranges),
        retired: items(draft.retired),
        groups: items(draft.groups),
        operations: items(draft.operations),
        types: Types::new(shrunk(types)),
        tables: items(draft.tables),
        entities: items(draft.entities),
        coordinates: items(draft.coordinates),
        stores: items(draft.stores),
        availability: draft.availability.model(),
        glossary: items(draft.glossary),
        waivers: items(draft.waivers),
        missing_sections: items(draft.sections),
        conflicts: items(draft.conflicts),
        answers: shrunk(draft.answers.into_iter().map(|answer| answer.item)),
        questions: draft.questions,
        changes: items(draft.changes),
    };
    let missing = link(
        &mut partial.types,
        &mut partial.operations,
        &mut partial.tables,
        partial.envelope.as_mut(),
    );
    Loaded {
        partial,
        whole,
        sound: sound && missing.is_none(),
    }
}

/// A type without those of its parts that are too broken to say anything.
fn known(mut def: TypeDef, mut broken: impl FnMut() -> bool) -> TypeDef {
    match &mut def.shape {
        TypeShape::Struct(shape) => shape.fields.retain(|_| !broken()),
        TypeShape::Enum(shape) => shape.values.retain(|_| !broken()),
        TypeShape::OneOf(choice) => choice.variants.retain(|_| !broken()),
    }
    def
}

fn items<T>(placed: Vec<Sourced<'_, T>>) -> Vec<T> {
    shrunk(placed.into_iter().map(|placed| placed.item))
}

/// Without the room that the places took.
fn shrunk<T>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut items: Vec<T> = items.collect();
    items.shrink_to_fit();
    items
}
