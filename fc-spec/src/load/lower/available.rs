//! Lowers `availability:` and `available:`.

use super::Lowering;
use crate::language::grammar::{AVAILABILITY, AVAILABLE, COMMON, both_languages as text};
use crate::load::draft::Origin;
use crate::model::{Availability, Available, Declared};
use crate::syntax::{Entries, Entry, Node};
use std::collections::BTreeMap;

impl<'a> Lowering<'a, '_> {
    pub(super) fn availability(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        self.draft.plain.availability = Availability {
            audiences: self.words(AVAILABILITY.audiences.get(node)),
            hardware: self.words(AVAILABILITY.hardware.get(node)),
            releases: self.words(AVAILABILITY.releases.get(node)),
        };
    }

    fn words(&self, entries: Entries<'a>) -> Vec<Declared> {
        let words = entries.map(|Entry { key, value: node }| Declared {
            name: key.as_str().unwrap_or_default().to_owned(),
            title: text(node),
            location: self.location(key.span()),
        });
        words.collect()
    }
}

/// Returns the limit in `available:` of a mapping.
pub(super) fn available<'a>(node: impl Into<Option<Node<'a>>>) -> Option<Available> {
    let node = COMMON.available.of(node)?;
    Some(Available {
        audiences: AVAILABLE.r#for.get(node),
        hardware: AVAILABLE.hardware.get(node),
        from: releases(AVAILABLE.from.get(node)),
        until: releases(AVAILABLE.until.get(node)),
    })
}

fn releases(entries: Entries<'_>) -> BTreeMap<String, String> {
    let text = |node: Node<'_>| node.as_str().unwrap_or_default().to_owned();
    entries
        .map(|entry| (text(entry.key), text(entry.value)))
        .collect()
}
