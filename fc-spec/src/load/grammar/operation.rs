//! Groups and operations.

use super::common::{ABOUT, ALIASES, ANSWERS, CHANGES, DEPRECATED, EN, SINCE, ZH};
use super::wire::ACK;
use super::{Key, Kind, Table, list, optional, required, up_to};
use crate::vocabulary::{BodyState, Effect, Lost, Side};

const CODE: Key = required(
    "code",
    Kind::Either(&CODE_FORMS),
    "Code in the frame header, such as `0x0A01`; `unassigned` until there is one.",
);

static CODE_FORMS: [Kind; 3] = [
    Kind::Code,
    Kind::Word(&[(
        "unassigned",
        "No code yet: types and documentation are generated, but it cannot be sent.",
    )]),
    Kind::Map(&CODE_WITH_STATE),
];

static CODE_WITH_STATE: Table = Table {
    name: "inferred code",
    doc: "A code and its confidence.",
    keys: &[
        required("value", Kind::Code, "The code."),
        required("state", Kind::Word(&FACT_STATES), "Its confidence."),
    ],
};

static FACT_STATES: [(&str, &str); 2] = [BodyState::Stated.entry(), BodyState::Inferred.entry()];

const SOURCE: Key = required(
    "source",
    Kind::Map(&SOURCE_TABLE),
    "Where it comes from in the source document.",
);

static SOURCE_TABLE: Table = Table {
    name: "source",
    doc: "Where in the source document it stands, and what of that is lost.",
    keys: &[
        required(
            "sections",
            list(&Kind::Int {
                min: 1,
                max: u16::MAX as i128,
            }),
            "Section numbers; empty if it is not in the source document.",
        ),
        optional(
            "lost",
            list(&Kind::Word(Lost::WORDS)),
            "What is missing from the section.",
        ),
    ],
};

const EFFECT: Key = required(
    "effect",
    Kind::Either(&EFFECT_FORMS),
    "What it does to the robot. Evidence is a title or description that says so (get, set, delete, start), or, as \
     inferred, a body that only asks or only sets. A code, a neighbouring operation or the type of a field is not evidence.",
);

static EFFECT_FORMS: [Kind; 2] = [Kind::Word(Effect::WORDS), Kind::Map(&EFFECT_WITH_STATE)];

static EFFECT_WITH_STATE: Table = Table {
    name: "inferred effect",
    doc: "An effect and its confidence.",
    keys: &[
        required(
            "value",
            Kind::Word(&KNOWN_EFFECTS),
            "What it does to the robot.",
        ),
        required("state", Kind::Word(&FACT_STATES), "Its confidence."),
    ],
};

static KNOWN_EFFECTS: [(&str, &str); 3] = [
    Effect::Read.entry(),
    Effect::Config.entry(),
    Effect::Motion.entry(),
];

const STATE_WORDS: Kind = Kind::Word(&[
    (
        BodyState::Inferred.name(),
        "The source gives the evidence for the body.",
    ),
    (
        BodyState::Open.name(),
        "The body is missing: no keys are known, and every key is kept as received.",
    ),
]);

static STATE_FORMS: [Kind; 2] = [STATE_WORDS, Kind::Map(&STATE_TABLE)];

static STATE_TABLE: Table = Table {
    name: "body state",
    doc: "The confidence of a body, and the reason.",
    keys: &[required("state", STATE_WORDS, "Its confidence."), ZH, EN],
};

const REQUEST_STATE: Key = optional(
    "request_state",
    Kind::Either(&STATE_FORMS),
    "Confidence in the request; `stated` by default.",
);
const RESPONSE_STATE: Key = optional(
    "response_state",
    Kind::Either(&STATE_FORMS),
    "Confidence in the response; `stated` by default.",
);
const ERRORS: Key = optional(
    "errors",
    list(&Kind::Int {
        min: i64::MIN as i128,
        max: i64::MAX as i128,
    }),
    "Result codes it may return besides success.",
);
const RESULT_TEXT: Key = optional(
    "result_text",
    Kind::Text,
    "Result text that the source prints with it; composed examples show it.",
);
const OPERATION_DEPRECATED: Key = optional("deprecated", Kind::Map(&DEPRECATED), "Withdrawn.");

/// `group:`.
pub(super) static GROUP: Table = Table {
    name: "group",
    doc: "A group of operations that belong together.",
    keys: &[
        required("id", Kind::Name, "Short name; the name of the Rust module."),
        ZH,
        EN,
        ABOUT,
    ],
};

/// An entry of `commands:`.
pub(crate) static COMMAND: Table = Table {
    name: "command",
    doc: "A command: the app asks, the robot answers.",
    keys: &[
        CODE,
        ZH,
        EN,
        ALIASES,
        ABOUT,
        EFFECT,
        SINCE,
        SOURCE,
        RESULT_TEXT,
        REQUEST_STATE,
        RESPONSE_STATE,
        optional(
            "request",
            Kind::Body,
            "Keys of the request besides the envelope, in the order sent.",
        ),
        optional(
            "response",
            Kind::Body,
            "Keys of the response besides the envelope, in the order sent.",
        ),
        ERRORS,
        OPERATION_DEPRECATED,
        CHANGES,
        ANSWERS,
    ],
};

/// An entry of `reports:`.
pub(crate) static REPORT: Table = Table {
    name: "report",
    doc: "A report: the robot sends it by itself, the app acknowledges.",
    keys: &[
        CODE,
        ZH,
        EN,
        ALIASES,
        ABOUT,
        SINCE,
        SOURCE,
        RESULT_TEXT,
        REQUEST_STATE,
        RESPONSE_STATE,
        optional(
            "body",
            Kind::Body,
            "Keys of the report besides the envelope, in the order sent.",
        ),
        optional(
            "response",
            Kind::Body,
            "Keys of the acknowledgement besides the envelope, in the order sent.",
        ),
        optional(
            "ack",
            Kind::Map(&ACK),
            "How often it is resent until it is acknowledged.",
        ),
        ERRORS,
        OPERATION_DEPRECATED,
        CHANGES,
        ANSWERS,
    ],
};

/// An entry of `streams:`.
pub(crate) static STREAM: Table = Table {
    name: "stream",
    doc: "A stream of raw bytes on the data port.",
    keys: &[
        CODE,
        ZH,
        EN,
        ALIASES,
        ABOUT,
        required("from", Kind::Word(Side::WORDS), "Who sends it."),
        SINCE,
        SOURCE,
        OPERATION_DEPRECATED,
        CHANGES,
        ANSWERS,
    ],
};

/// A duration in milliseconds.
pub(super) const MILLISECONDS: Kind = up_to(u32::MAX as i128);
