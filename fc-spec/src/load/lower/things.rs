//! Lowers things with a name and a text: entities, coordinate systems, stores, terms, waivers.

use super::{Lower, Lowering};
use crate::language::grammar::{
    COMMON, FILE, OTHER_FORMS, STORE, TERM, WAIVER, both_languages as text,
};
use crate::load::draft::{Origin, Sourced};
use crate::model::{Aliases, CoordinateSystem, Entity, Store, Term, Waiver};

impl<'a> Lowering<'a, '_> {
    /// The sections of things.
    pub(super) const THINGS: [Lower<'a, Self>; 5] = [
        (FILE.entities.name, Self::entity),
        (FILE.coordinates.name, Self::coordinate_system),
        (FILE.stores.name, Self::store),
        (FILE.glossary.name, Self::term),
        (FILE.waivers.name, Self::waiver),
    ];

    fn entity(&mut self, origin: Origin<'a>) {
        let item = Entity {
            name: origin.key.as_str().unwrap_or_default().to_owned(),
            title: text(origin.node),
            location: self.location(origin.name()),
        };
        self.draft.plain.entities.push(item);
    }

    fn coordinate_system(&mut self, origin: Origin<'a>) {
        let item = CoordinateSystem {
            name: origin.key.as_str().unwrap_or_default().to_owned(),
            title: text(origin.node),
            about: COMMON.about.read(origin.node),
            location: self.location(origin.name()),
        };
        self.draft.plain.coordinates.push(item);
    }

    fn store(&mut self, origin: Origin<'a>) {
        let item = Store {
            name: origin.key.as_str().unwrap_or_default().to_owned(),
            title: text(origin.node),
            about: COMMON.about.read(origin.node),
            survives_restart: STORE.survives_restart.read(origin.node),
            location: self.location(origin.name()),
        };
        self.draft.plain.stores.push(item);
    }

    fn term(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        let also = TERM.also.of(node);
        let word = text(node);
        let item = Term {
            id: origin.key.as_str().unwrap_or_default().to_owned(),
            means: TERM.means.read(node).unwrap_or_else(|| word.clone()),
            word,
            also: Aliases {
                zh: OTHER_FORMS.zh.get(also),
                en: OTHER_FORMS.en.get(also),
            },
            location: self.location(origin.name()),
        };
        self.draft.glossary.push(Sourced { item, origin });
    }

    fn waiver(&mut self, origin: Origin<'a>) {
        let item = Waiver {
            id: origin.key.as_str().unwrap_or_default().to_owned(),
            reason: text(origin.node),
            by: WAIVER.by.get(origin.node),
            until: WAIVER.until.get(origin.node),
            location: self.location(origin.name()),
        };
        self.draft.waivers.push(Sourced { item, origin });
    }
}
