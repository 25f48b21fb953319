//! Where a thing is written.

use crate::item::meant;
use crate::snapshot::Snapshot;
use fc_spec::source::FileId;
use gen_lsp_types::Location;

/// The key of the thing that is named at an offset, in whichever file.
#[must_use]
pub fn definition(snapshot: &Snapshot, at: (FileId, usize)) -> Option<Location> {
    let meant = meant(snapshot, at)?;
    let place = snapshot.places().get(&meant.item)?;
    snapshot.location(place.key)
}
