//! Types, bodies and fields.

use super::common::{ABOUT, ANSWERS, CHANGES, CODE_NAME, EN, FIELD_DEPRECATED, SINCE, ZH};
use super::{BOTH_LANGUAGES, Key, KeyKind, Kind, Table, entries, list, optional, required, some};
use crate::vocabulary::{IntKind, Quirk, WireForm};

/// A field: a short type, one of the longhand forms, or an inline object.
pub(crate) static FIELD: Kind = Kind::Either(&[
    Kind::Type,
    Kind::ByKey {
        tables: &FIELD_FORMS,
        otherwise: &Kind::Body,
    },
]);

/// The longhand forms, by the key that marks each.
pub(crate) static FIELD_FORMS: [(&str, &Table); 4] = [
    ("type", &TYPED),
    ("fields", &OBJECT),
    ("items", &ITEMS),
    ("one_of", &CHOICE),
];

const NOTE: Key = optional(
    "note",
    BOTH_LANGUAGES,
    "Additional notes, such as special values and origin.",
);
const OPTIONAL: Key = optional("optional", Kind::Bool, "Whether it may be absent.");
const ALSO: Key = optional(
    "also",
    some(&Kind::Text),
    "Other wire keys that the decoder accepts for it.",
);
const SENSITIVE: Key = optional("sensitive", Kind::Bool, "Never shown in logs.");
const DEPRECATED: Key = optional("deprecated", Kind::Map(&FIELD_DEPRECATED), "Withdrawn.");
const EXAMPLE: Key = optional(
    "example",
    Kind::Json,
    "Value in generated examples, as it is sent; `absent` leaves an optional field out.",
);
const QUIRK: Key = optional(
    "quirk",
    some(&Kind::Word(Quirk::WORDS)),
    "Where the decoder is lenient; the encoder is not.",
);
const LENGTH: Key = optional(
    "length",
    Kind::Either(&[
        LENGTH_BOUND,
        Kind::List {
            of: &LENGTH_BOUND,
            min: 2,
            max: 2,
        },
    ]),
    "Characters of a string, bytes of a base64 value or items of a list: an exact number, or minimum and maximum.",
);
const LENGTH_BOUND: Kind = Kind::Int {
    min: 0,
    max: u32::MAX as i128,
};

/// `type:` longhand.
static TYPED: Table = Table {
    name: "field",
    doc: "A field of a JSON object.",
    keys: &[
        required(
            "type",
            Kind::Type,
            "Its type, followed by `?` if the field is optional.",
        ),
        ZH,
        EN,
        NOTE,
        OPTIONAL,
        EXAMPLE,
        optional("unit", Kind::Unit, "Unit, such as `m`, `rad`, `ms`."),
        optional("min", Kind::Number, "Smallest value of a number."),
        optional("max", Kind::Number, "Largest value of a number."),
        LENGTH,
        optional(
            "pattern",
            Kind::Text,
            "Regular expression that the whole string must match.",
        ),
        optional(
            "default",
            Kind::Scalar,
            "Value the receiver uses if the field is absent; documented, not sent.",
        ),
        SINCE,
        CODE_NAME,
        optional(
            "wire",
            Kind::Word(&[WireForm::String.entry()]),
            "How it is sent, if that differs from its type.",
        ),
        QUIRK,
        ALSO,
        SENSITIVE,
        DEPRECATED,
        ANSWERS,
    ],
};

/// `fields:` longhand.
static OBJECT: Table = Table {
    name: "inline object",
    doc: "A field that holds an object written in place.",
    keys: &[
        required("fields", Kind::Body, "Its keys, in the order sent."),
        INLINE_ZH,
        INLINE_EN,
        NOTE,
        OPTIONAL,
        EXAMPLE,
        SINCE,
        CODE_NAME,
        QUIRK,
        ALSO,
        SENSITIVE,
        DEPRECATED,
        ANSWERS,
    ],
};

/// `items:` longhand.
static ITEMS: Table = Table {
    name: "inline list",
    doc: "A field that holds a list of objects written in place.",
    keys: &[
        required("items", Kind::Body, "Keys of each item, in the order sent."),
        INLINE_ZH,
        INLINE_EN,
        NOTE,
        OPTIONAL,
        EXAMPLE,
        LENGTH,
        SINCE,
        CODE_NAME,
        QUIRK,
        ALSO,
        SENSITIVE,
        DEPRECATED,
        ANSWERS,
    ],
};

/// `one_of:` longhand.
static CHOICE: Table = Table {
    name: "inline choice",
    doc: "A field that holds one of several objects, told apart by which keys are present; one that fits none is refused.",
    keys: &[
        required(
            "one_of",
            VARIANTS,
            "The objects, in the order in which they are tried.",
        ),
        INLINE_ZH,
        INLINE_EN,
        NOTE,
        OPTIONAL,
        EXAMPLE,
        SINCE,
        CODE_NAME,
        QUIRK,
        ALSO,
        SENSITIVE,
        DEPRECATED,
        ANSWERS,
    ],
};

// The key `data` has a default text, so that the table cannot ask for one; a check does.
const INLINE_ZH: Key = optional("zh", Kind::Text, "In Chinese; only `data` goes without.");
const INLINE_EN: Key = optional("en", Kind::Text, "In English; only `data` goes without.");

const VARIANTS: Kind = Kind::Entries {
    key: KeyKind::Name,
    value: &VARIANT,
    min: 0,
};

static VARIANT: Kind = Kind::ByKey {
    tables: &[("type", &NAMED_VARIANT), ("fields", &INLINE_VARIANT)],
    otherwise: &Kind::Map(&INLINE_VARIANT),
};

static NAMED_VARIANT: Table = Table {
    name: "variant",
    doc: "A variant that is a struct declared elsewhere.",
    keys: &[required("type", Kind::TypeName, "Its struct."), ZH, EN],
};

static INLINE_VARIANT: Table = Table {
    name: "inline variant",
    doc: "A variant written in place.",
    keys: &[
        required("fields", Kind::Body, "Its keys, in the order sent."),
        ZH,
        EN,
    ],
};

/// An entry of `types:`.
pub(super) static TYPE: Kind = Kind::ByKey {
    tables: &[("enum", &ENUM), ("one_of", &ONE_OF), ("fields", &STRUCT)],
    otherwise: &Kind::Map(&STRUCT),
};

static STRUCT: Table = Table {
    name: "struct",
    doc: "An object with known keys; unknown keys are kept.",
    keys: &[
        ZH,
        EN,
        ABOUT,
        SINCE,
        required("fields", Kind::Body, "Its keys, in the order sent."),
        CHANGES,
        ANSWERS,
    ],
};

static ENUM: Table = Table {
    name: "enum",
    doc: "A choice of named values.",
    keys: &[
        required(
            "enum",
            Kind::Word(&[
                (IntKind::U8.name(), "An integer."),
                (IntKind::U16.name(), "An integer."),
                (IntKind::U32.name(), "An integer."),
                (IntKind::U64.name(), "An integer."),
                (IntKind::I8.name(), "An integer."),
                (IntKind::I16.name(), "An integer."),
                (IntKind::I32.name(), "An integer."),
                (IntKind::I64.name(), "An integer."),
                ("string", "A text."),
            ]),
            "Type of the values as they are sent.",
        ),
        optional(
            "closed",
            Kind::Bool,
            "`true`: an unknown value is an error instead of being kept.",
        ),
        ZH,
        EN,
        ABOUT,
        SINCE,
        required(
            "values",
            entries(KeyKind::EnumValue, &Kind::Map(&ENUM_VALUE)),
            "Its values, each under the value that is sent.",
        ),
        CHANGES,
        ANSWERS,
    ],
};

static ENUM_VALUE: Table = Table {
    name: "enum value",
    doc: "A value of an enum.",
    keys: &[required("name", Kind::Name, "Name in code."), ZH, EN, SINCE],
};

static ONE_OF: Table = Table {
    name: "choice",
    doc: "A choice of objects, told apart by which keys are present; one that fits none is refused.",
    keys: &[
        ZH,
        EN,
        ABOUT,
        SINCE,
        required(
            "one_of",
            VARIANTS,
            "The objects, in the order in which they are tried.",
        ),
        CHANGES,
        ANSWERS,
    ],
};

/// An entry of `tables:`.
pub(super) static TABLE: Table = Table {
    name: "table",
    doc: "A published table of constants.",
    keys: &[
        ZH,
        EN,
        ABOUT,
        required("row", Kind::TypeName, "Struct of a row."),
        required("rows", list(&Kind::Json), "Rows, in wire form."),
        ANSWERS,
    ],
};
