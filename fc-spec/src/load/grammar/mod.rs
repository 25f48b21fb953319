//! The spec language as data: which keys a mapping may have, what stands under each, and one
//! sentence about it.
//!
//! Shape faults ([`super::shape`]) and the JSON Schema of the language
//! ([`crate::schema`]) are both read off these tables, so that an editor and the generator
//! cannot disagree. What a table cannot say (names that must exist, codes that must differ) is
//! checked on the lowered draft.

mod common;
mod field;
mod operation;
pub(crate) mod unit;
mod wire;

pub(crate) use field::{FIELD, FIELD_FORMS};
pub(crate) use operation::{COMMAND, REPORT, STREAM};

use common::{CHANGE, CONFLICT, TEXT};

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
    /// Name of a declared type.
    TypeName,
    /// A type: `u8`, `Station`, `string?`, `[Station]`.
    Type,
    /// Id of a conflict, such as `C040`.
    ConflictId,
    /// A unit of measurement.
    Unit,
    /// One of these words, each with what it means.
    Word(&'static [(&'static str, &'static str)]),
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
        key: KeyKind,
        /// What stands under each.
        value: &'static Kind,
        /// Fewest entries.
        min: usize,
    },
    /// A body or object: wire keys and their fields, each a [`FIELD`].
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

/// What a freely chosen key may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum KeyKind {
    /// A `snake_case` name.
    Name,
    /// A `PascalCase` name.
    TypeName,
    /// A key of a JSON object or a name of the source, as it is.
    Wire,
    /// An integer within bounds.
    Int(i128, i128),
    /// A value of an enum: an integer or a text.
    EnumValue,
    /// Id of a conflict.
    ConflictId,
}

/// A mapping with known keys.
#[derive(Debug)]
pub(crate) struct Table {
    /// Its name in prose and in the schema: "command", "header field".
    pub name: &'static str,
    /// What it describes.
    pub doc: &'static str,
    /// Its keys, in the order in which they are best written.
    pub keys: &'static [Key],
}

/// A known key.
#[derive(Debug)]
pub(crate) struct Key {
    /// The key.
    pub name: &'static str,
    /// Whether it must be there.
    pub required: bool,
    /// What stands under it.
    pub kind: Kind,
    /// One sentence.
    pub doc: &'static str,
}

impl Table {
    /// The key of this name.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }
}

/// A key that must be there.
pub(crate) const fn required(name: &'static str, kind: Kind, doc: &'static str) -> Key {
    Key {
        name,
        required: true,
        kind,
        doc,
    }
}

/// A key that may be there.
pub(crate) const fn optional(name: &'static str, kind: Kind, doc: &'static str) -> Key {
    Key {
        name,
        required: false,
        kind,
        doc,
    }
}

/// A non-negative integer of a bounded size.
pub(crate) const fn up_to(max: i128) -> Kind {
    Kind::Int { min: 0, max }
}

/// A list of any length.
pub(crate) const fn list(of: &'static Kind) -> Kind {
    Kind::List {
        of,
        min: 0,
        max: usize::MAX,
    }
}

/// A list with something in it.
pub(crate) const fn some(of: &'static Kind) -> Kind {
    Kind::List {
        of,
        min: 1,
        max: usize::MAX,
    }
}

/// A mapping with free keys, possibly empty.
pub(crate) const fn entries(key: KeyKind, value: &'static Kind) -> Kind {
    Kind::Entries { key, value, min: 0 }
}

/// Top keys that stand exactly once in a spec.
pub(crate) const ONCE: &[&str] = &[
    "protocol",
    "transport",
    "frame",
    "json",
    "envelope",
    "results",
    "calls",
    "ack",
    "limits",
    "codes",
    "sections",
    "changes",
];

/// Top keys that stand only in `commands/*.yaml`, below a `group`.
pub(crate) const GROUPED: &[&str] = &["group", "commands", "reports", "streams"];

/// A file of the spec.
pub(crate) static FILE: Table = Table {
    name: "file",
    doc: "A file of the spec. `protocol.yaml` says what lies below the messages, `commands/*.yaml` hold one group of operations each.",
    keys: &[
        optional(
            "group",
            Kind::Map(&operation::GROUP),
            "The group of operations in this file.",
        ),
        optional(
            "commands",
            entries(KeyKind::Name, &Kind::Map(&COMMAND)),
            "Commands of the app, by name.",
        ),
        optional(
            "reports",
            entries(KeyKind::Name, &Kind::Map(&REPORT)),
            "Reports of the robot, by name.",
        ),
        optional(
            "streams",
            entries(KeyKind::Name, &Kind::Map(&STREAM)),
            "Streams of raw bytes, by name.",
        ),
        optional(
            "types",
            entries(KeyKind::TypeName, &field::TYPE),
            "Structs, enums and choices, by name.",
        ),
        optional(
            "tables",
            entries(KeyKind::Name, &Kind::Map(&field::TABLE)),
            "Published tables of constants, by id.",
        ),
        optional(
            "conflicts",
            entries(KeyKind::ConflictId, &Kind::Map(&CONFLICT)),
            "Gaps and mistakes in the source document that the spec has to answer.",
        ),
        optional(
            "protocol",
            Kind::Map(&wire::PROTOCOL),
            "Name and description of the protocol.",
        ),
        optional("transport", Kind::Map(&wire::TRANSPORT), "Host and ports."),
        optional("frame", Kind::Map(&wire::FRAME), "How a frame is laid out."),
        optional(
            "json",
            Kind::Map(&wire::JSON),
            "How bodies are read where JSON leaves it open.",
        ),
        optional(
            "envelope",
            Kind::Map(&wire::ENVELOPE),
            "The keys that every message carries besides its own.",
        ),
        optional(
            "results",
            entries(
                KeyKind::Int(i64::MIN as i128, i64::MAX as i128),
                &Kind::Map(&wire::RESULT),
            ),
            "Result codes, by number.",
        ),
        optional(
            "calls",
            Kind::Map(&wire::CALLS),
            "How long the two sides wait.",
        ),
        optional(
            "ack",
            Kind::Map(&wire::ACK),
            "How often a report is resent by default.",
        ),
        optional(
            "limits",
            Kind::Map(&wire::LIMITS),
            "Default limits of client and server.",
        ),
        optional(
            "codes",
            Kind::Map(&wire::CODES),
            "Ranges of codes with a purpose, and codes not to be used again.",
        ),
        optional(
            "sections",
            entries(
                KeyKind::Int(1, u16::MAX as i128),
                &Kind::Map(&wire::SECTION),
            ),
            "Numbers of the sections missing from the source document.",
        ),
        optional(
            "changes",
            list(&Kind::Map(&CHANGE)),
            "Dated changes of the protocol as a whole.",
        ),
    ],
};

/// A text in both languages.
pub(crate) const BOTH_LANGUAGES: Kind = Kind::Map(&TEXT);
