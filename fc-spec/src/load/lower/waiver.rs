//! `waivers:`.

use super::Lowering;
use crate::language::grammar::{WAIVER, both_languages as text};
use crate::load::draft::{Place, Placed};
use crate::model::Waiver;

impl<'a> Lowering<'a, '_> {
    pub(super) fn waiver(&mut self, place: Place<'a>) {
        let item = Waiver {
            id: place.key.as_str().unwrap_or_default().to_owned(),
            reason: text(place.node),
            by: WAIVER.by.get(place.node),
            until: WAIVER.until.get(place.node),
            location: self.location(place.name()),
        };
        self.draft.waivers.push(Placed { item, place });
    }
}
