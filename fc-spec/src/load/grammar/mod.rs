//! The spec language, declared: each key once, with its type and one sentence about it in both languages.
//!
//! Shape faults ([`super::shape`]), reading ([`Key::read`]), the JSON Schema and the reference of the language
//! ([`crate::schema`]) all come out of these declarations, so that an editor, a page and the generator cannot
//! disagree. What a declaration cannot say (names that must exist, codes that must differ) is checked on the
//! lowered draft.

/// Declares mappings with known keys. The first line of each comment is English, the second Chinese; `use` puts
/// keys here that are declared elsewhere. Each makes a constant by whose fields the keys are read, and the
/// [`Table`] of them all, in the order in which they are best written.
macro_rules! grammar {
    (@must required) => { true };
    (@must optional) => { false };
    ($(
        #[doc = $en:literal] #[doc = $zh:literal]
        $KEYS:tt: $Keys:ident = $name:literal $name_zh:literal {
            $(use $($first:expr),+;)?
            $(
                #[doc = $key_en:literal] #[doc = $key_zh:literal]
                $must:ident $key:ident: $Form:ty;
                $(use $($next:expr),+;)?
            )*
        }
    )+) => { $(
        #[doc = $en]
        #[allow(clippy::doc_markdown, reason = "the JSON Schema has the same sentences")]
        #[allow(clippy::struct_field_names, reason = "they are the keys of the language")]
        #[derive(Debug)]
        pub(crate) struct $Keys {
            $(#[doc = $key_en] pub $key: $crate::load::grammar::Key<$Form>,)*
        }

        #[doc = $en]
        #[allow(clippy::doc_markdown, reason = "the JSON Schema has the same sentences")]
        pub(crate) const $KEYS: $Keys = $Keys {
            $($key: $crate::load::grammar::Key::new(
                stringify!($key),
                grammar!(@must $must),
                $crate::load::grammar::Doc::new($key_en, $key_zh),
            ),)*
        };

        impl $Keys {
            /// All of its keys.
            pub const TABLE: &'static $crate::load::grammar::Table = &$crate::load::grammar::Table {
                name: $name,
                name_zh: $name_zh,
                doc: $crate::load::grammar::Doc::new($en, $zh),
                keys: &[$($($first.any(),)+)? $($KEYS.$key.any(), $($($next.any(),)+)?)*],
            };
        }

        impl $crate::load::grammar::Form for $Keys {
            const KIND: $crate::load::grammar::Kind = $crate::load::grammar::Kind::Map(Self::TABLE);
            type Value<'a> = $crate::syntax::Node<'a>;

            fn read(node: $crate::syntax::Node<'_>) -> Option<Self::Value<'_>> {
                Some(node)
            }
        }
    )+ };
}

mod common;
mod field;
mod file;
mod form;
mod operation;
pub(crate) mod unit;
mod wire;

pub(crate) use common::*;
pub(crate) use field::*;
pub(crate) use file::*;
pub(crate) use form::{Form, both_languages};
pub(crate) use operation::*;
pub(crate) use wire::*;

use crate::syntax::{Entry, Items, Node};
use crate::vocabulary::Meaning;
use std::marker::PhantomData;

/// What a value may be.
#[derive(Debug)]
pub(crate) enum Kind {
    /// Any text.
    Text,
    /// `true` or `false`.
    Bool,
    /// An integer, decimal or `0x…`.
    Int {
        /// Smallest.
        min: i128,
        /// Largest.
        max: i128,
    },
    /// An integer or a decimal fraction.
    Number,
    /// A bool, number or text.
    Scalar,
    /// Any JSON value, written as YAML.
    Json,
    /// `0x` and four upper-case hex digits.
    Code,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    Date,
    /// A `snake_case` name.
    Name,
    /// Name of a declared type, in `PascalCase`.
    TypeName,
    /// A type: `u8`, `Station`, `string?`, `[Station]`.
    Type,
    /// Id of a conflict, such as `C040`.
    ConflictId,
    /// A unit of measurement.
    Unit,
    /// A key of a JSON object or a name of the source, as it is.
    WireKey,
    /// One of these words.
    Word(&'static [Meaning]),
    /// A list.
    List {
        /// What each item is.
        of: &'static Kind,
        /// Fewest items.
        min: usize,
        /// Most items.
        max: usize,
    },
    /// A mapping with known keys.
    Map(&'static Table),
    /// A mapping whose keys are chosen freely.
    Entries {
        /// What each key is.
        key: &'static Kind,
        /// What stands under each.
        value: &'static Kind,
        /// Fewest entries.
        min: usize,
    },
    /// A body or object: wire keys and their fields, each [`FIELD_KIND`].
    Body,
    /// The first of these that fits.
    Either(&'static [Kind]),
    /// A mapping whose table depends on which key it has.
    ByKey {
        /// The keys that decide, and their tables.
        tables: &'static [(&'static str, &'static Table)],
        /// What it is where it has none of them.
        otherwise: &'static Kind,
    },
}

/// One sentence in both languages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Doc {
    pub en: &'static str,
    pub zh: &'static str,
}

impl Doc {
    /// Of two lines of a doc comment.
    pub const fn new(en: &'static str, zh: &'static str) -> Self {
        Self {
            en: en.trim_ascii(),
            zh: zh.trim_ascii(),
        }
    }
}

/// A mapping with known keys.
#[derive(Debug)]
pub(crate) struct Table {
    /// Its name in prose and in the schema: "command", "header field".
    pub name: &'static str,
    /// Its name in Chinese.
    pub name_zh: &'static str,
    /// What it describes.
    pub doc: Doc,
    /// Its keys, in the order in which they are best written.
    pub keys: &'static [AnyKey],
}

impl Table {
    /// The key of this name.
    pub fn key(&self, name: &str) -> Option<&'static AnyKey> {
        self.keys.iter().find(|key| key.name == name)
    }
}

/// A known key, whatever stands under it.
#[derive(Debug)]
pub(crate) struct AnyKey {
    /// The key.
    pub name: &'static str,
    /// Whether it must be there.
    pub required: bool,
    /// What stands under it.
    pub kind: Kind,
    /// One sentence.
    pub doc: Doc,
}

/// A known key under which an `F` stands.
#[derive(Debug)]
pub(crate) struct Key<F> {
    /// The key.
    pub name: &'static str,
    required: bool,
    doc: Doc,
    form: PhantomData<fn() -> F>,
}

impl<F> Clone for Key<F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F> Copy for Key<F> {}

impl<F: Form> Key<F> {
    /// A key by the name of its field, which for a word of Rust is a raw one.
    const fn new(field: &'static str, required: bool, doc: Doc) -> Self {
        let name = match field.as_bytes() {
            [b'r', b'#', ..] => field.split_at(2).1,
            _ => field,
        };
        Self {
            name,
            required,
            doc,
            form: PhantomData,
        }
    }

    const fn any(self) -> AnyKey {
        AnyKey {
            name: self.name,
            required: self.required,
            kind: F::KIND,
            doc: self.doc,
        }
    }

    /// The key and what stands under it in this mapping.
    pub fn entry<'a>(self, node: impl Into<Option<Node<'a>>>) -> Option<Entry<'a>> {
        node.into()?.entry(self.name)
    }

    /// What stands under it in this mapping.
    pub fn of<'a>(self, node: impl Into<Option<Node<'a>>>) -> Option<Node<'a>> {
        node.into()?.get(self.name)
    }

    /// Items of the list under it in this mapping.
    pub fn items<'a>(self, node: impl Into<Option<Node<'a>>>) -> Items<'a> {
        self.of(node).map(Node::items).unwrap_or_default()
    }

    /// What it says in this mapping; nothing where that is `None`.
    pub fn get<'a>(self, node: impl Into<Option<Node<'a>>>) -> F::Value<'a>
    where
        F::Value<'a>: Default,
    {
        self.read(node).unwrap_or_default()
    }

    /// What it says in this mapping, or what stands here in place of one.
    pub fn read_in_or_at(self, node: Node<'_>) -> Option<F::Value<'_>> {
        F::read(self.of(node).unwrap_or(node))
    }

    /// What it says in this mapping; `None` where it is not there, or malformed, which has been reported.
    pub fn read<'a>(self, node: impl Into<Option<Node<'a>>>) -> Option<F::Value<'a>> {
        F::read(self.of(node)?)
    }
}
