//! Coordinate systems and stores of types, fields and operations.

use super::links::{Anchor, Link, Page};
use super::rows::Rows;
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

/// The coordinate system of a value.
#[derive(Debug, Serialize)]
pub(super) struct Given {
    #[serde(skip)]
    system: String,
    link: Link,
}

impl Given {
    /// Returns the name of the coordinate system.
    pub(super) fn system(&self) -> &str {
        &self.system
    }
}

impl Rows<'_, '_> {
    /// Returns the view of a store, by its name.
    pub(super) fn kept(&self, name: &str) -> Kept {
        let store = self.book.model.store(name);
        let title = store.map_or(name, |store| self.lang.text(&store.title));
        Kept {
            store: name.to_owned(),
            link: Link {
                text: title.to_owned(),
                href: self.page.link((Page::Places, Anchor::of("store", name))),
            },
            survives_restart: store.and_then(|store| store.survives_restart),
        }
    }

    /// Returns the view of a coordinate system, by its name.
    pub(super) fn given(&self, name: &str) -> Given {
        let system = self.book.model.coordinate_system(name);
        let title = system.map_or(name, |system| self.lang.text(&system.title));
        Given {
            system: name.to_owned(),
            link: Link {
                text: title.to_owned(),
                href: self
                    .page
                    .link((Page::Places, Anchor::of("coordinates", name))),
            },
        }
    }
}
