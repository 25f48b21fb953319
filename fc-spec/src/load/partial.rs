//! Builds the readable part of a spec, with or without errors.

use super::draft::{Draft, Sourced};
use crate::model::{Envelope, Frame, FrameKinds, Model, Partial, TypeDef, TypeShape, Types, link};

/// The result of loading a spec. The errors are separate, because a spec with errors also has a result.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The readable part of the spec.
    pub partial: Partial,
    /// `true` if all files were readable as YAML, so that a missing thing is really missing.
    pub whole: bool,
    /// `true` if no error prevents a model.
    sound: bool,
}

impl Loaded {
    /// Returns the model; `None` if the spec has any error. Warnings do not prevent a model.
    #[must_use]
    pub fn model(self) -> Option<Model> {
        self.into_model().ok()
    }

    /// Returns the model.
    ///
    /// # Errors
    ///
    /// Returns the readable part if the spec has any error.
    pub fn into_model(self) -> Result<Model, Box<Partial>> {
        if self.sound {
            self.partial.whole()
        } else {
            Err(Box::new(self.partial))
        }
    }
}

/// Removes the places from a checked draft. `sound`: `true` if the spec has no errors.
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
        glossary: items(draft.glossary),
        waivers: items(draft.waivers),
        missing_sections: items(draft.sections),
        conflicts: items(draft.conflicts),
        answers: shrunk(draft.answers.into_iter().map(|answer| answer.item)),
        changes: items(draft.changes),
        ..draft.plain
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

/// Returns a type without its broken parts.
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

/// Collects items and frees the space of their places.
fn shrunk<T>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut items: Vec<T> = items.collect();
    items.shrink_to_fit();
    items
}
