//! Checks for unused types.

use super::graph::walk_types;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::Draft;
use crate::text;
use std::collections::HashSet;

/// Checks that an operation or a table uses every declared type, directly or through another type.
pub(super) fn check_unused(draft: &Draft<'_>, faults: &mut Faults) {
    let bodies = draft.types.iter().enumerate();
    let bodies = bodies.filter(|(_, ty)| ty.def.body_of.is_some());
    let rows = draft.tables.iter();
    let rows = rows.filter_map(|table| draft.type_index.get(table.item.row.name()).copied());
    let roots = bodies.map(|(index, _)| index).chain(rows);
    let used = HashSet::<_>::from_iter(walk_types(draft, roots, |_| {}));
    for (index, ty) in draft.types.iter().enumerate() {
        // A repeated type has its own error, which also covers the types made for its fields.
        let is_first = draft.type_index.get(&ty.def.name) == Some(&index);
        let is_declared = ty.origin.key.as_str() == Some(ty.def.name.as_str());
        if !used.contains(&index) && is_first && is_declared {
            let message = text!(
                "类型 `{name}` 没有用到",
                "the type `{name}` is not used",
                name = ty.def.name
            );
            let fault = Diagnostic::error(FaultCode::UnusedType, ty.origin.name(), message);
            faults.push(fault.note(text!(
                "在消息体中用到它，或将它删除",
                "use it in a body, or delete it"
            )));
        }
    }
}
