//! Lowers `availability:` and `available:`.

use super::Lowering;
use crate::language::grammar::{AVAILABILITY, AVAILABLE, COMMON, both_languages as text};
use crate::load::draft::{Origin, Sourced};
use crate::model::{Available, Declared};
use crate::syntax::{Entries, Entry, Node};
use std::collections::BTreeMap;

impl<'a> Lowering<'a, '_> {
    pub(super) fn availability(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        let (audiences, hardware) = (AVAILABILITY.audiences, AVAILABILITY.hardware);
        self.draft.availability.audiences = self.declared(audiences.get(node));
        self.draft.availability.hardware = self.declared(hardware.get(node));
        self.draft.availability.releases = self.declared(AVAILABILITY.releases.get(node));
    }

    fn declared(&self, entries: Entries<'a>) -> Vec<Sourced<'a, Declared>> {
        let declared = entries.map(|Entry { key, value: node }| Sourced {
            item: Declared {
                name: key.as_str().unwrap_or_default().to_owned(),
                title: text(node),
                location: self.location(key.span()),
            },
            origin: Origin { key, node },
        });
        declared.collect()
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
