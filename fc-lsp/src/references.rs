//! Find references.

use crate::item::meant;
use crate::snapshot::Snapshot;
use fc_spec::source::FileId;
use gen_lsp_types::Location;

/// Returns all places that name the item at an offset, in all files. `with_own` adds the place of its definition.
#[must_use]
pub fn references(
    snapshot: &Snapshot,
    at: (FileId, usize),
    with_own: bool,
) -> Option<Vec<Location>> {
    let item = meant(snapshot, at)?.item;
    let own = snapshot.definitions().get(&item).filter(|_| with_own);
    let own = own.map(|place| place.key);
    let uses = snapshot
        .references()
        .of(&item)
        .map(|reference| reference.span);
    let spans = own.into_iter().chain(uses);
    Some(spans.filter_map(|span| snapshot.location(span)).collect())
}
