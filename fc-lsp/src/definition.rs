//! Go to definition.

use crate::item::meant;
use crate::snapshot::Snapshot;
use fc_spec::source::FileId;
use gen_lsp_types::Location;

/// Returns the location of the key that defines the item at an offset. It can be in any file.
#[must_use]
pub fn definition(snapshot: &Snapshot, at: (FileId, usize)) -> Option<Location> {
    let meant = meant(snapshot, at)?;
    let place = snapshot.definitions().get(&meant.item)?;
    snapshot.location(place.key)
}
