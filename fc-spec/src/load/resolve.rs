//! Fills in derived values of the draft that need a lookup of names.

use super::answer_scope::{Found, covered_facts};
use super::draft::Draft;
use super::process;
use crate::language::grammar::REPORT;
use crate::model::{BodyState, Example, Exchange, Field, Subject, Type, TypeShape};

/// Fills in ports, acknowledgements, states of reports, borrowed texts, the kind of each example and confirmed facts.
pub(super) fn resolve(draft: &mut Draft<'_>) {
    resolve_ports(draft);
    resolve_acks(draft);
    process::resolve(draft);
    resolve_texts(draft);
    resolve_examples(draft);
    resolve_confirmed(draft);
}

/// Gives each operation the port of its frame kind.
fn resolve_ports(draft: &mut Draft<'_>) {
    let Some(frame) = &draft.frame else {
        return;
    };
    for operation in &mut draft.operations {
        let role = operation.item.kind().role();
        if let Some(kind) = frame.kinds.iter().find(|kind| kind.item.role == role) {
            operation.item.port = kind.item.port;
        }
    }
}

fn resolve_acks(draft: &mut Draft<'_>) {
    let Some(default) = draft.default_ack else {
        return;
    };
    if let Some(calls) = &mut draft.calls {
        calls.item.ack = default;
    }
    for operation in &mut draft.operations {
        let has_own = REPORT.ack.of(operation.origin.node).is_some();
        if let (Exchange::Report { ack, .. }, false) = (&mut operation.item.exchange, has_own) {
            *ack = default;
        }
    }
}

/// Gives a field in the short form the title of its type.
fn resolve_texts(draft: &mut Draft<'_>) {
    let mut titles = Vec::new();
    for (at, ty) in draft.types.iter().enumerate() {
        for (index, (field, part)) in ty.fields().enumerate() {
            if let (true, Type::Named(named)) = (part.borrows_text, &field.ty)
                && let Some(named) = draft.type_named(named.name())
            {
                titles.push((at, index, named.def.title.clone()));
            }
        }
    }
    for (at, index, title) in titles {
        if let Some(field) = draft.field_mut(at, index) {
            field.text = title;
        }
    }
}

/// Marks optional fields as absent in composed examples if they have no example and none can be derived.
fn resolve_examples(draft: &mut Draft<'_>) {
    for ty in &mut draft.types {
        if let TypeShape::Struct(shape) = &mut ty.def.shape {
            for field in &mut shape.fields {
                if field.optional && field.example == Example::Derived && !is_derivable(&field.ty) {
                    field.example = Example::Absent;
                }
            }
        }
    }
}

/// Marks lost facts as confirmed that the owner has settled. A code, an effect or a body must also be stated in the
/// spec. A heading or a type byte needs no change.
fn resolve_confirmed(draft: &mut Draft<'_>) {
    let mut confirmed = Vec::new();
    for answer in &draft.answers {
        if let (Some(_), Subject::Operation(name)) = (&answer.item.confirmed, &answer.item.subject)
        {
            for covered in covered_facts(draft, answer) {
                if let Found::Fact(fact, state, _) = covered.found
                    && (matches!(state, BodyState::Stated | BodyState::Free)
                        || !covered.has_to_change())
                {
                    confirmed.push((name.clone(), fact));
                }
            }
        }
    }
    for (name, fact) in confirmed {
        let mut operations = draft.operations.iter_mut();
        let operation = operations.find(|operation| operation.item.name == name);
        if let Some(state) = operation.and_then(|operation| operation.item.fact_state_mut(fact)) {
            *state = BodyState::Confirmed;
        }
    }
}

/// Returns `true` if a value of this type can be composed without an example. A named type reports its own missing
/// examples.
pub(super) fn is_derivable(ty: &Type) -> bool {
    match ty {
        Type::Int(_) | Type::Float(_) | Type::String => false,
        Type::Array(item) => is_derivable(item),
        Type::Bool
        | Type::TimestampMs
        | Type::TimestampS
        | Type::Base64
        | Type::Json
        | Type::Named(_) => true,
    }
}

impl Draft<'_> {
    fn field_mut(&mut self, ty: usize, field: usize) -> Option<&mut Field> {
        match &mut self.types.get_mut(ty)?.def.shape {
            TypeShape::Struct(shape) => shape.fields.get_mut(field),
            _ => None,
        }
    }
}
