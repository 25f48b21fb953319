//! Checks entities and the fields that refer to them.

use super::fields::misfit;
use super::iter::fields;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::FIELD;
use crate::load::draft::Draft;
use crate::model::Type;
use crate::source::Span;
use crate::text;
use std::collections::HashMap;

/// Checks that a field with `refers` can hold an id: an integer, a string or a list of them.
pub(super) fn check_ids(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        if field.details().refers.is_none() || is_id(field.ty.item()) {
            continue;
        }
        // An unknown type has its own error.
        let named = field.ty.innermost();
        if named.is_some_and(|named| draft.type_named(named.name()).is_none()) {
            continue;
        }
        let expected = text!(
            "整数、字符串或它们的列表",
            "an integer, a string or a list of them"
        );
        let message = misfit(FIELD.refers.name, field, &expected);
        let span = part.origin.at(FIELD.refers);
        let fault = Diagnostic::error(FaultCode::RefersOnWrongType, span, message);
        faults.push(fault.also_type(part.ty));
    }
}

/// Checks that all ids of an entity have one type, so that an id from one message fits into another. The wire form of
/// each field may differ.
pub(super) fn check_types(draft: &Draft<'_>, faults: &mut Faults) {
    let mut first: HashMap<&str, (&Type, Span)> = HashMap::new();
    for (_, field, part) in fields(draft) {
        let ty = field.ty.item();
        let Some(entity) = field.details().refers.as_deref().filter(|_| is_id(ty)) else {
            continue;
        };
        let (known, span) = *first.entry(entity).or_insert((ty, part.ty));
        if known != ty {
            let message = text!(
                "`{entity}` 的 ID 应为 `{known}`，与别处相同",
                "expected `{known}`, the type of the other ids of `{entity}`"
            );
            let fault = Diagnostic::error(FaultCode::IdTypes, part.ty, message);
            faults.push(fault.also_first(span));
        }
    }
}

fn is_id(ty: &Type) -> bool {
    matches!(ty, Type::Int(_) | Type::String)
}
