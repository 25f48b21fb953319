//! Checks for unused types.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::{Draft, TypeDraft};
use crate::model::TypeShape;
use crate::text;

/// Checks that an operation or a table uses every declared type, directly or through another type.
pub(super) fn check_unused(draft: &Draft<'_>, faults: &mut Faults) {
    let mut used = vec![false; draft.types.len()];
    let mut open: Vec<usize> = Vec::new();
    let bodies = draft
        .types
        .iter()
        .enumerate()
        .filter(|(_, ty)| ty.def.body_of.is_some())
        .map(|(index, _)| index);
    let rows = draft
        .tables
        .iter()
        .filter_map(|table| draft.type_index.get(table.item.row.name()).copied());
    open.extend(bodies.chain(rows));
    while let Some(index) = open.pop() {
        if let (Some(used), Some(ty)) = (used.get_mut(index), draft.types.get(index))
            && !*used
        {
            *used = true;
            each_name(ty, |name| open.extend(draft.type_index.get(name).copied()));
        }
    }
    for (index, (ty, used)) in draft.types.iter().zip(&used).enumerate() {
        // A repeated type has its own error, which also covers the types made for its fields.
        let is_first = draft.type_index.get(&ty.def.name) == Some(&index);
        let is_declared = ty.origin.key.as_str() == Some(ty.def.name.as_str());
        if !used && is_first && is_declared {
            let message = text!(
                "类型 `{name}` 没有用到",
                "the type `{name}` is not used",
                name = ty.def.name
            );
            faults.push(
                Diagnostic::error(FaultCode::UnusedType, ty.origin.name(), message).note(text!(
                    "在消息体中用到它，或将它删除",
                    "use it in a body, or delete it"
                )),
            );
        }
    }
}

/// Calls `each` with the names of the types in a type's fields or variants.
pub(super) fn each_name<'d>(ty: &'d TypeDraft<'_>, mut each: impl FnMut(&'d str)) {
    match &ty.def.shape {
        TypeShape::Struct(shape) => {
            for field in &shape.fields {
                if let Some(name) = field.ty.innermost() {
                    each(name.name());
                }
            }
        }
        TypeShape::OneOf(choice) => {
            for variant in &choice.variants {
                each(variant.ty.name());
            }
        }
        TypeShape::Enum(_) => {}
    }
}
