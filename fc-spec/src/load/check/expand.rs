//! Checks that types are finite and small enough to expand in examples, documentation and dumps.

use super::unused_types::each_name;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::{Draft, TypeDraft};
use crate::model::{Text, TypeShape};
use crate::source::Span;
use crate::text;

/// Maximum number of fields in a fully expanded body.
const FIELDS: u64 = 10_000;

/// Maximum nesting of types. The limit `limits.json_depth` on JSON is far lower.
const DEPTH: usize = 64;

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    New,
    Open,
    Done,
}

/// Checks that no type contains itself, not even in a list or an optional field. Returns `false` if one does.
pub(super) fn check_recursion(draft: &Draft<'_>, faults: &mut Faults) -> bool {
    let before = faults.errors();
    let mut states = vec![State::New; draft.types.len()];
    for root in 0..draft.types.len() {
        visit(draft, root, &mut states, faults);
    }
    faults.errors() == before
}

/// Walks depth-first without recursion, so that a long chain of types cannot exhaust the stack.
fn visit(draft: &Draft<'_>, root: usize, states: &mut [State], faults: &mut Faults) {
    let mut path: Vec<(usize, std::vec::IntoIter<usize>)> = Vec::new();
    let enter = |index: usize, states: &mut [State], path: &mut Vec<_>| {
        if let (Some(state), Some(ty)) = (states.get_mut(index), draft.types.get(index)) {
            *state = State::Open;
            path.push((index, inner(draft, ty).into_iter()));
        }
    };
    if states.get(root) == Some(&State::New) {
        enter(root, states, &mut path);
    }
    while let Some((index, rest)) = path.last_mut() {
        let Some(next) = rest.next() else {
            if let Some(state) = states.get_mut(*index) {
                *state = State::Done;
            }
            path.pop();
            continue;
        };
        match states.get(next) {
            Some(State::New) => enter(next, states, &mut path),
            Some(State::Open) => {
                let start = path.iter().position(|(index, _)| *index == next);
                let cycle: Vec<usize> = path
                    .iter()
                    .skip(start.unwrap_or(0))
                    .map(|(index, _)| *index)
                    .collect();
                faults.extend(recursion(draft, &cycle));
            }
            _ => {}
        }
    }
}

fn inner(draft: &Draft<'_>, ty: &TypeDraft<'_>) -> Vec<usize> {
    let mut inner = Vec::new();
    each_name(ty, |name| inner.extend(draft.type_index.get(name).copied()));
    inner
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
    let at = match &ty.def.shape {
        TypeShape::Struct(shape) => shape.fields.iter().position(|field| {
            field
                .ty
                .innermost()
                .is_some_and(|named| named.name() == name)
        }),
        TypeShape::OneOf(choice) => choice
            .variants
            .iter()
            .position(|variant| variant.ty.name() == name),
        TypeShape::Enum(_) => None,
    };
    let part = at.and_then(|at| ty.parts.get(at));
    part.map_or(ty.origin.name(), |part| part.ty)
}

/// Checks that a body has a limited size. Returns `false` for a larger body. Types must not contain themselves.
pub(super) fn check_size(draft: &Draft<'_>, faults: &mut Faults) -> bool {
    let before = faults.errors();
    let mut sizes: Vec<Option<(u64, usize)>> = vec![None; draft.types.len()];
    for root in 0..draft.types.len() {
        measure(draft, root, &mut sizes);
    }
    for (ty, size) in draft.types.iter().zip(&sizes) {
        let is_body = ty
            .def
            .body_of
            .as_ref()
            .is_some_and(|body| body.path.is_empty());
        let Some((fields, depth)) = size.filter(|_| is_body) else {
            continue;
        };
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
        faults.push(Diagnostic::error(
            FaultCode::BodyTooLarge,
            ty.origin.name(),
            message,
        ));
    }
    faults.errors() == before
}

/// Computes the number of fields and the nesting of an expanded type.
fn measure(draft: &Draft<'_>, root: usize, sizes: &mut [Option<(u64, usize)>]) {
    let mut open = vec![root];
    while let Some(&index) = open.last() {
        let (Some(None), Some(ty)) = (sizes.get(index), draft.types.get(index)) else {
            open.pop();
            continue;
        };
        let inner = inner(draft, ty);
        let missing: Vec<usize> = inner
            .iter()
            .copied()
            .filter(|inner| sizes.get(*inner) == Some(&None))
            .collect();
        if !missing.is_empty() {
            open.extend(missing);
            continue;
        }
        let own = u64::try_from(ty.parts.len()).unwrap_or(u64::MAX);
        let size = inner
            .iter()
            .filter_map(|inner| sizes.get(*inner).copied().flatten())
            .fold((own, 1), |(fields, depth), (more, deep)| {
                (fields.saturating_add(more), depth.max(deep + 1))
            });
        if let Some(origin) = sizes.get_mut(index) {
            *origin = Some(size);
        }
        open.pop();
    }
}
