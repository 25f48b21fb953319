//! Things with a name and a text: entities, coordinate systems, stores, terms, waivers.

use super::Lowering;
use crate::language::grammar::{COMMON, OTHER_FORMS, STORE, TERM, WAIVER, both_languages as text};
use crate::load::draft::{Place, Placed};
use crate::model::{Aliases, CoordinateSystem, Entity, Store, Term, Waiver};

impl<'a> Lowering<'a, '_> {
    pub(super) fn entity(&mut self, place: Place<'a>) {
        let item = Entity {
            name: place.key.as_str().unwrap_or_default().to_owned(),
            title: text(place.node),
            location: self.location(place.name()),
        };
        self.draft.entities.push(Placed { item, place });
    }

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

    pub(super) fn term(&mut self, place: Place<'a>) {
        let node = place.node;
        let also = TERM.also.of(node);
        let word = text(node);
        let item = Term {
            id: place.key.as_str().unwrap_or_default().to_owned(),
            means: TERM.means.read(node).unwrap_or_else(|| word.clone()),
            word,
            also: Aliases {
                zh: OTHER_FORMS.zh.get(also),
                en: OTHER_FORMS.en.get(also),
            },
            location: self.location(place.name()),
        };
        self.draft.glossary.push(Placed { item, place });
    }

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
