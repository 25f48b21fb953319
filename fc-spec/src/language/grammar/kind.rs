//! The data of a declaration: the kind of value at each key, and its documentation.

use crate::diagnostic::FaultCode;
use crate::syntax::Node;
use crate::vocabulary::Meaning;

/// The kind of a value.
#[derive(Debug)]
pub(crate) enum Kind {
    /// Any string.
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
    /// A bool, a number or a string.
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
    /// A media type, such as `image/png`.
    MediaType,
    /// A unit of measurement.
    Unit,
    /// A key of a JSON object or a name from the source document, unchanged.
    WireKey,
    /// The name of a thing that the spec declares elsewhere.
    Ref {
        /// The form of the name.
        name: &'static Kind,
        /// The parts of the language that can declare the thing.
        kinds: &'static [&'static str],
    },
    /// One of these words.
    Word(&'static [Meaning]),
    /// A list.
    List {
        /// The kind of each item.
        of: &'static Kind,
        /// Fewest items.
        min: usize,
        /// Most items.
        max: usize,
    },
    /// A mapping with known keys.
    Map(&'static Table),
    /// A mapping with freely chosen keys.
    Entries {
        /// The kind of each key.
        key: &'static Kind,
        /// The kind of each value.
        value: &'static Kind,
        /// Fewest entries.
        min: usize,
    },
    /// A body or object: wire keys and their fields, each [`FIELD_KIND`](super::FIELD_KIND).
    Body,
    /// The first of these that fits.
    Either(&'static [Kind]),
    /// A mapping with one of several tables. Its keys select the table.
    ByKey {
        /// The keys that select a table, and their tables.
        tables: &'static [(&'static str, &'static Table)],
        /// The kind of a mapping without any of these keys.
        otherwise: &'static Kind,
    },
}

impl Kind {
    /// Returns the parts of the language that can declare the thing named here. `None` if the value is not a name of a thing.
    pub fn refers(&self) -> Option<&'static [&'static str]> {
        match self {
            Self::Ref { kinds, .. } => Some(kinds),
            Self::Either(kinds) => kinds.iter().find_map(Self::refers),
            Self::List { of, .. } => of.refers(),
            _ => None,
        }
    }

    /// Returns the word of a closed set, if it is one.
    pub fn word(&self, word: &str) -> Option<&'static str> {
        let Self::Word(words) = self else {
            return None;
        };
        let mut words = words.iter().map(|(word, ..)| *word);
        words.find(|known| *known == word)
    }

    /// Returns `true` if a type or the name of one may be here.
    pub fn is_type(&self) -> bool {
        match self {
            Self::Type | Self::TypeName => true,
            Self::Either(kinds) => kinds.iter().any(Self::is_type),
            Self::List { of, .. } => of.is_type(),
            _ => false,
        }
    }

    /// Returns the form of a value. For a reference, this is the form of the name.
    pub fn form(&self) -> &Self {
        match self {
            Self::Ref { name, .. } => name,
            kind => kind,
        }
    }

    /// Returns `true` if the node has the outer form of this kind: scalar, list or mapping.
    pub fn could_be(&self, node: Node<'_>) -> bool {
        match self {
            Self::Map(_) | Self::Entries { .. } | Self::ByKey { .. } | Self::Body => {
                node.as_mapping().is_some()
            }
            Self::List { .. } => node.as_sequence().is_some(),
            Self::Type => node.as_scalar().is_some() || node.as_sequence().is_some(),
            Self::Either(kinds) => kinds.iter().any(|kind| kind.could_be(node)),
            Self::Json => true,
            _ => node.as_scalar().is_some(),
        }
    }
}

/// One sentence in both languages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Doc {
    pub en: &'static str,
    pub zh: &'static str,
}

impl Doc {
    /// Returns the documentation from two lines of a doc comment.
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
    /// The name in prose and in the schema, such as "command" or "header field".
    pub name: &'static str,
    /// The name in Chinese.
    pub name_zh: &'static str,
    /// The description of the mapping.
    pub doc: Doc,
    /// A small example, as YAML.
    pub example: &'static str,
    /// The keys, in the recommended order.
    pub keys: &'static [AnyKey],
}

impl Table {
    /// Returns the key with this name.
    pub fn key(&self, name: &str) -> Option<&'static AnyKey> {
        self.keys.iter().find(|key| key.name == name)
    }
}

/// A known key with a value of any form.
#[derive(Debug)]
pub(crate) struct AnyKey {
    /// The name.
    pub name: &'static str,
    /// `true` if the mapping must have the key.
    pub required: bool,
    /// The kind of the value.
    pub kind: Kind,
    /// The documentation.
    pub doc: Doc,
    /// The optional parts of the declaration.
    pub said: Said,
}

/// The optional parts of a declaration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Said {
    /// The value that the loader uses for a missing key.
    pub default: Option<&'static str>,
    /// An example, as YAML.
    pub example: Option<&'static str>,
    /// Errors of its value that its kind does not imply.
    pub faults: &'static [FaultCode],
}

impl Said {
    /// A declaration without optional parts.
    pub const NOTHING: Self = Self {
        default: None,
        example: None,
        faults: &[],
    };
}
