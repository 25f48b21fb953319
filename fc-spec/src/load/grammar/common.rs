//! Keys that mean the same wherever they stand.

use super::{BOTH_LANGUAGES, Key, Kind, Table, list, optional, required, some};
use crate::vocabulary::{AnswerKind, Severity};

/// `zh`.
pub(super) const ZH: Key = required("zh", Kind::Text, "In Chinese.");
/// `en`.
pub(super) const EN: Key = required("en", Kind::Text, "In English.");
/// `about`.
pub(super) const ABOUT: Key = optional(
    "about",
    BOTH_LANGUAGES,
    "Longer description, as Markdown paragraphs.",
);
/// `since`.
pub(super) const SINCE: Key = optional("since", Kind::Date, "When it first appeared.");
/// `changes`.
pub(super) const CHANGES: Key = optional("changes", list(&CHANGE_KIND), "Its dated changes.");
/// `answers`.
pub(super) const ANSWERS: Key = optional(
    "answers",
    list(&ANSWER_KIND),
    "The spec's answers to gaps and mistakes of the source document.",
);
/// `aliases`.
pub(super) const ALIASES: Key = optional(
    "aliases",
    Kind::Map(&ALIASES_TABLE),
    "Other words that readers know it by; shown on its page and found by the search.",
);
/// `name` where the code name differs from the wire's.
pub(super) const CODE_NAME: Key = optional(
    "name",
    Kind::Name,
    "Name in code, if the one derived from the wire key is not suitable.",
);

static ALIASES_TABLE: Table = Table {
    name: "list of aliases",
    doc: "Other words for it, in both languages.",
    keys: &[
        required("zh", some(&Kind::Text), "In Chinese."),
        required("en", some(&Kind::Text), "In English."),
    ],
};

static CHANGE_KIND: Kind = Kind::Map(&CHANGE);
static ANSWER_KIND: Kind = Kind::Map(&ANSWER);

/// `{ zh, en }`.
pub(super) static TEXT: Table = Table {
    name: "text",
    doc: "A text in both languages.",
    keys: &[ZH, EN],
};

/// An entry of `changes:`.
pub(super) static CHANGE: Table = Table {
    name: "change",
    doc: "A dated change.",
    keys: &[required("date", Kind::Date, "When."), ZH, EN],
};

/// An entry of `answers:`.
pub(super) static ANSWER: Table = Table {
    name: "answer",
    doc: "What the spec answers to gaps and slips of the source.",
    keys: &[
        required(
            "ids",
            some(&Kind::ConflictId),
            "Ids of the conflicts it answers.",
        ),
        required(
            "as",
            Kind::Word(AnswerKind::WORDS),
            "What kind of answer it is.",
        ),
        ZH,
        EN,
    ],
};

/// An entry of `conflicts:`.
pub(super) static CONFLICT: Table = Table {
    name: "conflict",
    doc: "A gap or slip of the source document.",
    keys: &[
        required(
            "category",
            Kind::Text,
            "What it concerns, such as `frame`, `codes`, `fields`.",
        ),
        required(
            "severity",
            Kind::Word(Severity::WORDS),
            "How serious it is.",
        ),
        ZH,
        EN,
    ],
};

/// `deprecated:` of an operation.
pub(super) static DEPRECATED: Table = Table {
    name: "deprecation",
    doc: "Withdrawn: why, and what to use instead.",
    keys: &[
        optional("since", Kind::Date, "Since when."),
        ZH,
        EN,
        optional("replaced_by", Kind::Name, "Operation to use instead."),
    ],
};

/// `deprecated:` of a field.
pub(super) static FIELD_DEPRECATED: Table = Table {
    name: "field deprecation",
    doc: "Withdrawn: why, and what to use instead.",
    keys: &[optional("since", Kind::Date, "Since when."), ZH, EN],
};
