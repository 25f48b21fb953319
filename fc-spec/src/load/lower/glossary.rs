//! `glossary:`.

use super::Lowering;
use crate::language::grammar::{OTHER_FORMS, TERM, both_languages as text};
use crate::load::draft::{Place, Placed};
use crate::model::{Aliases, Term};

impl<'a> Lowering<'a, '_> {
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
}
