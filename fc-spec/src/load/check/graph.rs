//! Walks graphs, such as types that contain others.

use crate::load::draft::{Draft, TypeDraft};
use crate::model::TypeShape;
use std::collections::HashMap;
use std::hash::Hash;

/// Visits the types that the roots contain, as indexes in the draft. Returns each after the types that it contains.
pub(super) fn walk_types(
    draft: &Draft<'_>,
    roots: impl IntoIterator<Item = usize>,
    mut report: impl FnMut(&[usize]),
) -> Vec<usize> {
    let edges = |index: usize| {
        let ty = draft.types.get(index).into_iter();
        let inner = ty.flat_map(|ty| inner_types(draft, ty));
        inner.map(|index| (index, ())).collect()
    };
    walk(roots, edges, |cycle, ()| report(cycle))
}

/// Returns the indexes of the types in a type's fields or variants.
pub(super) fn inner_types(draft: &Draft<'_>, ty: &TypeDraft<'_>) -> Vec<usize> {
    let names = inner_names(ty).into_iter().flatten();
    let indexes = names.filter_map(|name| draft.type_index.get(name));
    indexes.copied().collect()
}

/// Returns the name of the type in each field or variant of a type. Built-in types have none.
pub(super) fn inner_names<'d>(ty: &'d TypeDraft<'_>) -> Vec<Option<&'d str>> {
    match &ty.def.shape {
        TypeShape::Struct(shape) => {
            let types = shape.fields.iter().map(|field| field.ty.innermost());
            types.map(|named| Some(named?.name())).collect()
        }
        TypeShape::OneOf(choice) => {
            let variants = choice.variants.iter();
            variants.map(|variant| Some(variant.ty.name())).collect()
        }
        TypeShape::Enum(_) => Vec::new(),
    }
}

/// Visits every node that the roots lead to, depth-first. Returns the nodes, each after those that it leads to.
///
/// Calls `report` with each cycle and the edge that closes it. The walk is not recursive, so that a long chain cannot
/// exhaust the stack.
pub(super) fn walk<N: Copy + Eq + Hash, E>(
    roots: impl IntoIterator<Item = N>,
    edges: impl Fn(N) -> Vec<(N, E)>,
    mut report: impl FnMut(&[N], E),
) -> Vec<N> {
    let mut finished = Vec::new();
    // The visited nodes, each with `true` if it is finished and `false` if it is on the path.
    let mut visited: HashMap<N, bool> = HashMap::new();
    for root in roots {
        let mut path = Vec::new();
        let mut rest = Vec::new();
        let mut next = (!visited.contains_key(&root)).then_some(root);
        loop {
            if let Some(node) = next.take() {
                visited.insert(node, false);
                path.push(node);
                rest.push(edges(node).into_iter());
            }
            let (Some(node), Some(left)) = (path.last(), rest.last_mut()) else {
                break;
            };
            let Some((to, edge)) = left.next() else {
                visited.insert(*node, true);
                finished.push(*node);
                path.pop();
                rest.pop();
                continue;
            };
            match visited.get(&to) {
                None => next = Some(to),
                Some(true) => {}
                Some(false) => {
                    let start = path.iter().position(|node| *node == to);
                    report(path.get(start.unwrap_or(0)..).unwrap_or_default(), edge);
                }
            }
        }
    }
    finished
}
