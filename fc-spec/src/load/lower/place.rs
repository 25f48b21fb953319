//! `coordinates:` and `stores:`.

use super::Lowering;
use crate::language::grammar::{COMMON, STORE, both_languages as text};
use crate::load::draft::{Place, Placed};
use crate::model::{CoordinateSystem, Store};

impl<'a> Lowering<'a, '_> {
    pub(super) fn coordinate_system(&mut self, place: Place<'a>) {
        let item = CoordinateSystem {
            name: place.key.as_str().unwrap_or_default().to_owned(),
            title: text(place.node),
            about: COMMON.about.read(place.node),
            location: self.location(place.name()),
        };
        self.draft.coordinates.push(Placed { item, place });
    }

    pub(super) fn store(&mut self, place: Place<'a>) {
        let item = Store {
            name: place.key.as_str().unwrap_or_default().to_owned(),
            title: text(place.node),
            about: COMMON.about.read(place.node),
            survives_restart: STORE.survives_restart.read(place.node),
            location: self.location(place.name()),
        };
        self.draft.stores.push(Placed { item, place });
    }
}
