//! `entities:`.

use super::Lowering;
use crate::language::grammar::both_languages as text;
use crate::load::draft::{Place, Placed};
use crate::model::Entity;

impl<'a> Lowering<'a, '_> {
    pub(super) fn entity(&mut self, place: Place<'a>) {
        let item = Entity {
            name: place.key.as_str().unwrap_or_default().to_owned(),
            title: text(place.node),
            location: self.location(place.name()),
        };
        self.draft.entities.push(Placed { item, place });
    }
}
