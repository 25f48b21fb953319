//! The model, the language and the page of a view, and links from it.

use super::book::Book;
use super::links::{Anchor, Link, Page};
use super::mentions::linked;
use fc_spec::model::{Lang, Location, Operation, Text};

/// The model, the language and the page of a view.
#[derive(Clone, Copy)]
pub(super) struct Desk<'b, 'm> {
    pub(super) book: &'b Book<'m>,
    pub(super) lang: Lang,
    pub(super) page: Page<'m>,
}

impl Desk<'_, '_> {
    /// Returns the address of a place, relative to the page.
    pub(super) fn link(self, page: Page<'_>, anchor: Anchor) -> String {
        self.page.link((page, anchor))
    }

    /// Returns a link with a text to a place.
    pub(super) fn to(self, text: impl Into<String>, place: (Page<'_>, Anchor)) -> Link {
        Link {
            text: text.into(),
            href: self.page.link(place),
        }
    }

    pub(super) fn spec(self, location: &Location) -> Link {
        Link {
            text: location.file.clone(),
            href: self.page.link_to_spec(location, self.lang),
        }
    }

    /// Returns a link with the title of an operation.
    pub(super) fn operation(self, operation: &Operation) -> Link {
        let place = (Page::Operation(operation), Anchor::none());
        self.to(self.lang.text(&operation.title), place)
    }

    /// Returns a sentence of the spec with links to the operations that it names.
    pub(super) fn sentence(self, text: &Text) -> String {
        linked(self.book, self.page, self.lang.text(text))
    }
}
