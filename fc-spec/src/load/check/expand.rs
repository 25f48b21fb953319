//! Checks that types are finite and small enough to expand in examples, documentation and dumps.

use super::graph::{inner_names, inner_types, walk_types};
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::{Draft, TypeDraft};
use crate::model::Text;
use crate::source::Span;
use crate::text;
use std::collections::HashMap;

/// Maximum number of fields in a fully expanded body.
const FIELDS: u64 = 10_000;

/// Maximum nesting of types. The limit `limits.json_depth` on JSON is far lower.
const DEPTH: usize = 64;

/// Checks that no type contains itself, not even in a list or an optional field. Returns the indexes of the types, each
/// after the types that it contains; `None` if one contains itself.
pub(super) fn check_recursion(draft: &Draft<'_>, faults: &mut Faults) -> Option<Vec<usize>> {
    let before = faults.errors();
    let order = walk_types(draft, 0..draft.types.len(), |cycle| {
        faults.extend(recursion(draft, cycle));
    });
    (faults.errors() == before).then_some(order)
}

fn recursion(draft: &Draft<'_>, cycle: &[usize]) -> Option<Diagnostic> {
    let types: Vec<_> = cycle
        .iter()
        .filter_map(|index| draft.types.get(*index))
        .collect();
    let first = *types.first()?;
    let name = first.def.name.as_str();
    let others: Vec<_> = types
        .iter()
        .skip(1)
        .map(|ty| text!("`{name}`", "`{name}`", name = ty.def.name))
        .collect();
    let message = if others.is_empty() {
        text!("`{name}` 包含自身", "`{name}` contains itself")
    } else {
        text!(
            "`{name}` 通过 {others} 包含自身",
            "`{name}` contains itself through {others}",
            others = Text::joined(others, "、", ", ")
        )
    };
    let last = *types.last()?;
    let fault = Diagnostic::error(FaultCode::RecursiveType, holding(last, name), message);
    Some(fault.also_declared(first.origin.name()).note(text!(
        "层数不定的值改用 `json`",
        "use `json` for values of arbitrary depth"
    )))
}

/// Returns the place where a type names another.
fn holding(ty: &TypeDraft<'_>, name: &str) -> Span {
    let mut names = inner_names(ty).into_iter();
    let at = names.position(|inner| inner == Some(name));
    let part = at.and_then(|at| ty.parts.get(at));
    part.map_or(ty.origin.name(), |part| part.ty)
}

/// Checks that a body has a limited size. Returns `false` for a larger body. In `order`, each type comes after those
/// that it contains.
pub(super) fn check_size(draft: &Draft<'_>, order: &[usize], faults: &mut Faults) -> bool {
    let before = faults.errors();
    // The number of fields and the nesting of each expanded type.
    let mut sizes: HashMap<usize, (u64, usize)> = HashMap::new();
    for index in order {
        let Some(ty) = draft.types.get(*index) else {
            continue;
        };
        let own = u64::try_from(ty.parts.len()).unwrap_or(u64::MAX);
        let inner = inner_types(draft, ty).into_iter();
        let inner = inner.filter_map(|inner| sizes.get(&inner));
        let size = inner.fold((own, 1), |(fields, depth), (more, deep)| {
            (fields.saturating_add(*more), depth.max(deep + 1))
        });
        sizes.insert(*index, size);
    }
    for (index, ty) in bodies(draft) {
        let (fields, depth) = sizes.get(&index).copied().unwrap_or_default();
        let message = if fields > FIELDS {
            text!(
                "所有类型展开后，这个消息体的字段超过 {FIELDS} 个",
                "with all its types expanded, this body has more than {FIELDS} fields"
            )
        } else if depth > DEPTH {
            text!(
                "这个消息体的类型嵌套超过 {DEPTH} 层",
                "the types of this body are nested more than {DEPTH} levels deep"
            )
        } else {
            continue;
        };
        let span = ty.origin.name();
        faults.push(Diagnostic::error(FaultCode::BodyTooLarge, span, message));
    }
    faults.errors() == before
}

/// Returns the types of whole bodies, with their indexes.
pub(super) fn bodies<'d, 'a>(
    draft: &'d Draft<'a>,
) -> impl Iterator<Item = (usize, &'d TypeDraft<'a>)> {
    draft.types.iter().enumerate().filter(|(_, ty)| {
        let body = ty.def.body_of.as_ref();
        body.is_some_and(|body| body.path.is_empty())
    })
}
