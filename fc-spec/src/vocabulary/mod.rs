//! The closed sets of words in the spec language.
//!
//! Each set is declared only here. One entry holds a word, its meaning and its enum variant. The grammar, the JSON Schema, the model, its
//! dump and every product use this entry.

/// A word of a closed set and its meaning, in English and in Chinese.
pub type Meaning = (&'static str, &'static str, &'static str);

/// A word of any closed set, for code that handles all sets alike.
pub(crate) trait Word: Copy + PartialEq + 'static {
    /// All variants.
    const SET: &'static [Self];
    /// The words and their meanings.
    const WORDS: &'static [Meaning];

    /// Returns the word in the spec.
    fn word(self) -> &'static str;

    /// Returns the variant for a word, if there is one.
    fn named(word: &str) -> Option<Self> {
        Self::SET.iter().copied().find(|known| known.word() == word)
    }
}

/// Declares an enum whose variants are words of the spec. The first line of a variant's doc is its meaning in English, the second its
/// meaning in Chinese.
macro_rules! words {
    (
        $(#[$about:meta])+
        pub enum $Set:ident {
            $(#[doc = $en:literal] #[doc = $zh:literal] $Word:ident = $word:literal,)+
        }
    ) => {
        $(#[$about])+
        #[allow(clippy::doc_markdown, reason = "the JSON Schema has the same sentences")]
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
        )]
        pub enum $Set {
            $(#[doc = $en] #[serde(rename = $word)] $Word,)+
        }

        impl $Set {
            /// All variants, in the order of their declaration.
            pub const ALL: &'static [Self] = &[$(Self::$Word,)+];

            /// The words and their meanings.
            pub const WORDS: &'static [Meaning] = &[$(Self::$Word.entry(),)+];

            /// Returns the word in the spec and in all products.
            #[must_use]
            pub const fn name(self) -> &'static str {
                self.entry().0
            }

            /// Returns the word and its meaning.
            #[must_use]
            pub const fn entry(self) -> Meaning {
                match self {
                    $(Self::$Word => ($word, $en.trim_ascii(), $zh.trim_ascii()),)+
                }
            }
        }

        impl Word for $Set {
            const SET: &'static [Self] = Self::ALL;
            const WORDS: &'static [Meaning] = Self::WORDS;

            fn word(self) -> &'static str {
                self.name()
            }
        }
    };
}

mod evidence;
mod operation;
mod value;
mod wire;

pub use evidence::{AnswerKind, BodyState, Fact, Impact, Severity};
pub use operation::{Direction, Effect, Kind, RangeUse, Side};
pub use value::{FloatKind, IntKind, Quirk, StateOrder, WireForm};
pub use wire::{
    ByteOrder, DigestAlgorithm, EncodingRole, EnvelopeRole, HeaderQuirk, HeaderRole, JsonRule,
    KindRole, PortRole, ResultRole,
};
