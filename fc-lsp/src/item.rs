//! The thing that is meant at a place of a file.

use crate::snapshot::Snapshot;
use fc_spec::index::{Item, Place, Role, Site};
use fc_spec::source::{FileId, Span};

/// A thing, and the words at which it is meant.
#[derive(Clone, Debug)]
pub struct Meant {
    /// The thing.
    pub item: Item,
    /// The words.
    pub span: Span,
}

/// The thing that is named or said at an offset.
pub fn meant(snapshot: &Snapshot, at: (FileId, usize)) -> Option<Meant> {
    snapshot.at(at, |site| of_site(snapshot, site))
}

/// The same of a key or scalar.
pub fn of_site(snapshot: &Snapshot, site: &Site<'_>) -> Option<Meant> {
    if let Some(sought) = site.sought() {
        let (item, _) = sought.found(snapshot.places())?;
        let span = sought.span;
        return Some(Meant { item, span });
    }
    let span = site.node.span();
    let item = if site.role == Role::Chosen {
        said(snapshot, span, site.node.as_str().unwrap_or_default())?
    } else if site.is_code_name() {
        let places = snapshot.places().in_file(span.file);
        let around = places.filter(|(item, place)| !item.is_type() && holds(place, span));
        let (item, _) = around.min_by_key(|(_, place)| place.whole.end - place.whole.start)?;
        item.clone()
    } else {
        return None;
    };
    Some(Meant { item, span })
}

/// The thing that this key says: the operation or field rather than the type that is made of it.
fn said(snapshot: &Snapshot, key: Span, name: &str) -> Option<Item> {
    let places = snapshot.places().in_file(key.file);
    let here = places.filter(|(_, place)| place.key == key);
    let (item, _) = here.min_by_key(|(item, _)| item.is_type() && item.name != name)?;
    Some(item.clone())
}

/// Whether a thing is written around a place.
pub fn holds(place: &Place, span: Span) -> bool {
    let whole = place.whole;
    whole.file == span.file && whole.start <= span.start && span.end <= whole.end
}
