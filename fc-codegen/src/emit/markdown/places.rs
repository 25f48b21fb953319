//! In which coordinate system something is given, and where something is kept.

use super::links::{Anchor, Link, Page};
use super::rows::Rows;
use serde::Serialize;

/// Where something is kept.
#[derive(Debug, Serialize)]
pub(super) struct Kept {
    #[serde(skip)]
    store: String,
    link: Link,
    /// Whether it is still there after a restart; `None` where nothing is known.
    survives_restart: Option<bool>,
}

impl Kept {
    /// Name of the store.
    pub(super) fn store(&self) -> &str {
        &self.store
    }
}

/// In which coordinate system something is given.
#[derive(Debug, Serialize)]
pub(super) struct Given {
    #[serde(skip)]
    system: String,
    link: Link,
}

impl Given {
    /// Name of the coordinate system.
    pub(super) fn system(&self) -> &str {
        &self.system
    }
}

impl Rows<'_, '_> {
    /// Where something is kept, by the name of the store.
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

    /// In what something is given, by the name of the coordinate system.
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
