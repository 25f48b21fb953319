//! The two languages of the pages.

use fc_spec::model::{Aliases, Text};

/// A language of the docs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lang {
    /// Chinese, at the root of the site.
    Zh,
    /// English, under `en/`.
    En,
}

impl Lang {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Zh, Self::En];

    /// One of two things, by language.
    pub fn pick<T>(self, zh: T, en: T) -> T {
        match self {
            Self::Zh => zh,
            Self::En => en,
        }
    }

    /// The spec's sentence in this language.
    #[must_use]
    pub fn text(self, text: &Text) -> &str {
        self.pick(&text.zh, &text.en)
    }

    /// The other words for a thing in this language.
    #[must_use]
    pub fn aliases(self, aliases: &Aliases) -> Vec<String> {
        self.pick(&aliases.zh, &aliases.en).clone()
    }
}
