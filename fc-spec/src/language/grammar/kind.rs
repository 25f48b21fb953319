//! What a declaration says, as data: what may stand where, and one sentence about it.

use crate::diagnostic::FaultCode;
use crate::syntax::Node;
use crate::vocabulary::Meaning;

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
    /// A media type, such as `image/png`.
    MediaType,
    /// A unit of measurement.
    Unit,
    /// A key of a JSON object or a name of the source, as it is.
    WireKey,
    /// The name of a thing that the spec declares elsewhere.
    Ref {
        /// The form of the name.
        name: &'static Kind,
        /// The parts of the language of which the thing may be.
        kinds: &'static [&'static str],
    },
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
    /// A body or object: wire keys and their fields, each [`FIELD_KIND`](super::FIELD_KIND).
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

impl Kind {
    /// Returns the parts of the language of which a thing may be that is named here; `None` if nothing is.
    pub fn refers(&self) -> Option<&'static [&'static str]> {
        match self {
            Self::Ref { kinds, .. } => Some(kinds),
            Self::Either(kinds) => kinds.iter().find_map(Self::refers),
            Self::List { of, .. } => of.refers(),
            _ => None,
        }
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

    /// Returns the form of a value: of a reference, that of the name.
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
    /// A small one, as YAML.
    pub example: &'static str,
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
    /// What else is said of it.
    pub said: Said,
}

/// What a declaration may say of a key beside its kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Said {
    /// What the loader takes it for where it is not there.
    pub default: Option<&'static str>,
    /// A value, as YAML.
    pub example: Option<&'static str>,
    /// Faults of its value that do not follow from its kind.
    pub faults: &'static [FaultCode],
}

impl Said {
    /// What needs no words.
    pub const NOTHING: Self = Self {
        default: None,
        example: None,
        faults: &[],
    };
}
