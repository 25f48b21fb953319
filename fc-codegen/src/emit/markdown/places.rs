//! Coordinate systems and stores of types, fields and operations.

use super::desk::Desk;
use super::links::{Anchor, Link, Page};
use serde::Serialize;

/// The store of a value.
#[derive(Debug, Serialize)]
pub(super) struct Kept {
    #[serde(skip)]
    store: String,
    link: Link,
    /// `true` if the value survives a restart; `None` if this is unknown.
    survives_restart: Option<bool>,
}

impl Kept {
    /// Returns the name of the store.
    pub(super) fn store(&self) -> &str {
        &self.store
    }
}

/// The entity or the coordinate system of a value.
#[derive(Debug, Serialize)]
pub(super) struct Reference {
    #[serde(skip)]
    pub(super) name: String,
    pub(super) link: Link,
}

impl Reference {
    /// Returns the name in the spec.
    pub(super) fn name(&self) -> &str {
        &self.name
    }
}

impl Desk<'_, '_> {
    /// Returns the view of a store, by its name.
    pub(super) fn kept(&self, name: &str) -> Kept {
        let store = self.book.model.store(name);
        let title = store.map_or(name, |store| self.lang.text(&store.title));
        Kept {
            store: name.to_owned(),
            link: self.to(title, (Page::Places, Anchor::of("store", name))),
            survives_restart: store.and_then(|store| store.survives_restart),
        }
    }

    /// Returns the view of a coordinate system, by its name.
    pub(super) fn given(&self, name: &str) -> Reference {
        let system = self.book.model.coordinate_system(name);
        let title = system.map_or(name, |system| self.lang.text(&system.title));
        Reference {
            name: name.to_owned(),
            link: self.to(title, (Page::Places, Anchor::of("coordinates", name))),
        }
    }
}
