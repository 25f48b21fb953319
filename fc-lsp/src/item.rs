//! The definition that a position refers to.

use crate::snapshot::Snapshot;
use fc_spec::index::{DefId, DefSite, Occurrence, Role};
use fc_spec::source::{FileId, Span};

/// A definition, and the words that refer to it.
#[derive(Clone, Debug)]
pub struct Meant {
    /// The definition.
    pub item: DefId,
    /// The span of the words.
    pub span: Span,
}

/// Returns the definition that the word at an offset names or defines.
pub fn meant(snapshot: &Snapshot, at: (FileId, usize)) -> Option<Meant> {
    snapshot.at(at, |occurrence| of_site(snapshot, occurrence))
}

/// Returns the definition that a key or scalar names or defines.
pub fn of_site(snapshot: &Snapshot, occurrence: &Occurrence<'_>) -> Option<Meant> {
    if let Some(reference) = occurrence.reference() {
        let (item, _) = reference.found(snapshot.definitions())?;
        let span = reference.span;
        return Some(Meant { item, span });
    }
    let span = occurrence.node.span();
    let item = if occurrence.role == Role::Chosen {
        said(snapshot, span, occurrence.node.as_str().unwrap_or_default())?
    } else if occurrence.is_code_name() {
        let places = snapshot.definitions().in_file(span.file);
        let around = places.filter(|(item, place)| !item.is_type() && holds(place, span));
        let (item, _) = around.min_by_key(|(_, place)| place.whole.end - place.whole.start)?;
        item.clone()
    } else {
        return None;
    };
    Some(Meant { item, span })
}

/// Returns the definition with this key. If a type is made from an operation or field, returns the operation or field.
fn said(snapshot: &Snapshot, key: Span, name: &str) -> Option<DefId> {
    let places = snapshot.definitions().in_file(key.file);
    let here = places.filter(|(_, place)| place.key == key);
    let (item, _) = here.min_by_key(|(item, _)| item.is_type() && item.name != name)?;
    Some(item.clone())
}

/// Returns `true` if the definition at `place` contains the span.
pub fn holds(place: &DefSite, span: Span) -> bool {
    let whole = place.whole;
    whole.file == span.file && whole.start <= span.start && span.end <= whole.end
}
