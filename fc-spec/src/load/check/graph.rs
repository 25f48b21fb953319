//! Walks graphs, such as types that contain others.

use std::collections::HashMap;
use std::hash::Hash;

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
