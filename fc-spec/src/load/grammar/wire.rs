//! What lies below the messages.

use super::common::{ABOUT, ALIASES, ANSWERS, CODE_NAME, EN, ZH};
use super::operation::MILLISECONDS;
use super::{
    BOTH_LANGUAGES, Key, KeyKind, Kind, Table, entries, list, optional, required, some, up_to,
};
use crate::vocabulary::{
    ByteOrder, EncodingRole, EnvelopeRole, HeaderQuirk, HeaderRole, JsonRule, KindRole, PortRole,
    RangeUse, ResultRole,
};

const BYTE: i128 = u8::MAX as i128;

/// `protocol:`.
pub(super) static PROTOCOL: Table = Table {
    name: "protocol",
    doc: "What the protocol is called and who talks.",
    keys: &[
        required(
            "id",
            Kind::Name,
            "Short name; the Rust protocol type is its Pascal case.",
        ),
        required("version", Kind::Text, "Version of the spec, quoted."),
        ZH,
        EN,
        required("about", BOTH_LANGUAGES, "What it is for."),
        required("robot", Kind::Map(&PARTY), "The party that listens."),
        required("app", Kind::Map(&PARTY), "The party that connects."),
        ANSWERS,
    ],
};

static PARTY: Table = Table {
    name: "party",
    doc: "A party of the protocol.",
    keys: &[
        ZH,
        EN,
        required(
            "about",
            BOTH_LANGUAGES,
            "What it is, and its other names in documents.",
        ),
    ],
};

/// `transport:`.
pub(super) static TRANSPORT: Table = Table {
    name: "transport",
    doc: "Host and ports.",
    keys: &[
        required("host", Kind::Text, "Address of the robot."),
        required("ports", Kind::Map(&PORTS), "Its TCP ports."),
        ANSWERS,
    ],
};

static PORTS: Table = Table {
    name: "ports",
    doc: "The TCP ports of the robot.",
    keys: &[
        required(
            PortRole::Command.name(),
            Kind::Map(&PORT),
            "Commands and reports.",
        ),
        required(PortRole::Data.name(), Kind::Map(&PORT), "Streams."),
    ],
};

static PORT: Table = Table {
    name: "port",
    doc: "A TCP port.",
    keys: &[
        required(
            "number",
            Kind::Int {
                min: 1,
                max: u16::MAX as i128,
            },
            "Its number.",
        ),
        ZH,
        EN,
    ],
};

/// `frame:`.
pub(super) static FRAME: Table = Table {
    name: "frame",
    doc: "How a frame is laid out. `zh` and `en` describe its data area.",
    keys: &[
        required(
            "byte_order",
            Kind::Word(ByteOrder::WORDS),
            "Order of the bytes of every integer of the header.",
        ),
        ZH,
        EN,
        required("heads", Kind::Map(&HEADS), "The bytes that open a frame."),
        required(
            "header",
            Kind::Entries {
                key: KeyKind::Wire,
                value: &Kind::Map(&HEADER_FIELD),
                min: 1,
            },
            "Header fields in the order in which they are sent.",
        ),
        required(
            "kinds",
            entries(KeyKind::Int(0, BYTE), &Kind::Map(&FRAME_KIND)),
            "Values of the header's kind field.",
        ),
        required(
            "encodings",
            entries(KeyKind::Int(0, BYTE), &Kind::Map(&ENCODING)),
            "Values of the header's encoding field.",
        ),
        ANSWERS,
    ],
};

static HEADS: Table = Table {
    name: "heads",
    doc: "The bytes that open a frame.",
    keys: &[
        required("request", some(&up_to(BYTE)), "Of a command or a report."),
        required(
            "response",
            some(&up_to(BYTE)),
            "Of a response or an acknowledgement.",
        ),
    ],
};

static HEADER_FIELD: Table = Table {
    name: "header field",
    doc: "A field of the header.",
    keys: &[
        required(
            "type",
            Kind::Either(&[
                Kind::Word(&[
                    ("u8", "One byte."),
                    ("u16", "Two bytes."),
                    ("u32", "Four bytes."),
                    ("u64", "Eight bytes."),
                ]),
                Kind::Text,
            ]),
            "Its width: `u8`, `u16`, `u32`, `u64` or `bytes(16)`.",
        ),
        optional(
            "role",
            Kind::Word(HeaderRole::WORDS),
            "What it is used for; a field without a role is only sent.",
        ),
        CODE_NAME,
        optional(
            "value",
            up_to(u64::MAX as i128),
            "What is sent if nothing else determines it.",
        ),
        optional(
            "quirk",
            some(&Kind::Word(HeaderQuirk::WORDS)),
            "Where the decoder is lenient.",
        ),
        ZH,
        EN,
        ALIASES,
        ANSWERS,
    ],
};

const PORT_ROLE: Key = required("port", Kind::Word(PortRole::WORDS), "Port it is sent on.");

static FRAME_KIND: Table = Table {
    name: "frame kind",
    doc: "A value of the header's kind field.",
    keys: &[
        required("name", Kind::Name, "Its name."),
        required("role", Kind::Word(KindRole::WORDS), "What it carries."),
        PORT_ROLE,
        ZH,
        EN,
    ],
};

static ENCODING: Table = Table {
    name: "encoding",
    doc: "A value of the header's encoding field.",
    keys: &[
        required("name", Kind::Name, "Its name."),
        required(
            "role",
            Kind::Word(EncodingRole::WORDS),
            "How the data is packed.",
        ),
        ZH,
        EN,
    ],
};

/// `json:`, one key for each [`JsonRule`].
pub(super) static JSON: Table = Table {
    name: "JSON rules",
    doc: "What is done where JSON leaves open what a text means. It is the same in every protocol; the texts explain it.",
    keys: &[
        rule(JsonRule::Text),
        rule(JsonRule::KnownKeys),
        rule(JsonRule::UnknownKeys),
        rule(JsonRule::Integers),
        rule(JsonRule::Floats),
        rule(JsonRule::Strings),
    ],
};

const fn rule(rule: JsonRule) -> Key {
    required(rule.name(), BOTH_LANGUAGES, rule.meaning())
}

/// `envelope:`.
pub(super) static ENVELOPE: Table = Table {
    name: "envelope",
    doc: "The keys that every message carries beside its own.",
    keys: &[
        required(
            "request",
            entries(KeyKind::Wire, &Kind::Map(&ENVELOPE_FIELD)),
            "Of every command and report.",
        ),
        required(
            "response",
            entries(KeyKind::Wire, &Kind::Map(&ENVELOPE_FIELD)),
            "Of every response and acknowledgement.",
        ),
        ANSWERS,
    ],
};

static ENVELOPE_FIELD: Table = Table {
    name: "envelope field",
    doc: "A key of the envelope.",
    keys: &[
        required(
            "type",
            Kind::Type,
            "Its type, followed by `?` if it may be missing in received messages.",
        ),
        required(
            "role",
            Kind::Word(EnvelopeRole::WORDS),
            "What it is used for.",
        ),
        required("example", Kind::Scalar, "What composed examples show."),
        CODE_NAME,
        ZH,
        EN,
        ALIASES,
        ANSWERS,
    ],
};

/// An entry of `results:`.
pub(super) static RESULT: Table = Table {
    name: "result code",
    doc: "A result code. Its Chinese text is also the text sent beside it.",
    keys: &[
        required("name", Kind::Name, "Name in code."),
        optional(
            "role",
            Kind::Word(ResultRole::WORDS),
            "When the runtime returns it by itself.",
        ),
        ZH,
        EN,
        ABOUT,
        ANSWERS,
    ],
};

/// `calls:`.
pub(super) static CALLS: Table = Table {
    name: "calls",
    doc: "How long the two sides wait.",
    keys: &[
        required(
            "timeout_ms",
            MILLISECONDS,
            "How long an app waits for a response.",
        ),
        required(
            "handler_timeout_ms",
            MILLISECONDS,
            "How long the robot waits for a handler.",
        ),
        required(
            "max_age_ms",
            Kind::Either(&[
                MILLISECONDS,
                Kind::Word(&[("never", "No message is too old.")]),
            ]),
            "Age past which a message is refused as expired.",
        ),
        ANSWERS,
    ],
};

/// `ack:`.
pub(super) static ACK: Table = Table {
    name: "acknowledgement",
    doc: "How often a report is sent again until it is acknowledged.",
    keys: &[
        required("timeout_ms", MILLISECONDS, "Wait before it is sent again."),
        required(
            "retries",
            up_to(u32::MAX as i128),
            "How often it is resent; 0 to send it only once.",
        ),
        ANSWERS,
    ],
};

const AT_LEAST_ONE: Kind = Kind::Int {
    min: 1,
    max: u32::MAX as i128,
};

/// `limits:`.
pub(super) static LIMITS: Table = Table {
    name: "limits",
    doc: "Default limits of both stubs.",
    keys: &[
        required(
            "frame_bytes",
            AT_LEAST_ONE,
            "Maximum frame length, including the header.",
        ),
        required(
            "inflated_bytes",
            AT_LEAST_ONE,
            "Maximum length of the data after decompression.",
        ),
        required(
            "json_depth",
            AT_LEAST_ONE,
            "Maximum nesting depth of a JSON body.",
        ),
        required(
            "in_flight",
            AT_LEAST_ONE,
            "Calls in flight on one connection.",
        ),
        required(
            "queued_reports",
            AT_LEAST_ONE,
            "Reports waiting for one app.",
        ),
        required("connections", AT_LEAST_ONE, "Connections at one server."),
    ],
};

/// `codes:`.
pub(super) static CODES: Table = Table {
    name: "codes",
    doc: "Ranges of codes with a purpose, and codes not to be used again.",
    keys: &[
        required("ranges", list(&Kind::Map(&RANGE)), "Ranges with a purpose."),
        optional(
            "retired",
            list(&Kind::Map(&RETIRED)),
            "Codes that must not be used again.",
        ),
        ANSWERS,
    ],
};

static RANGE: Table = Table {
    name: "range",
    doc: "A range of codes, both ends included.",
    keys: &[
        required("from", Kind::Code, "First code."),
        required("to", Kind::Code, "Last code."),
        required("use", Kind::Word(RangeUse::WORDS), "Its purpose."),
        ZH,
        EN,
        ANSWERS,
    ],
};

static RETIRED: Table = Table {
    name: "retired code",
    doc: "A code that must not be used again; the texts say why.",
    keys: &[required("code", Kind::Code, "The code."), ZH, EN],
};

/// An entry of `sections:`.
pub(super) static SECTION: Table = Table {
    name: "retained section",
    doc: "A section number of the source document of which nothing is left.",
    keys: &[ZH, EN, ANSWERS],
};
