//! The wire below the messages: transport, frame, envelope, results, ranges of codes.

use super::{Aliases, Location, Scalar, Severity, Text, Type, Value};
use std::collections::BTreeSet;

/// `protocol:` of `protocol.yaml`.
#[derive(Clone, Debug)]
pub struct Protocol {
    /// Short id, such as `fc`; the Rust protocol type is its Pascal case.
    pub id: String,
    /// Name.
    pub title: Text,
    /// What it is for.
    pub about: Text,
    /// Version of the spec.
    pub version: String,
    /// The two parties.
    pub robot: Party,
    /// The two parties.
    pub app: Party,
}

/// A party of the protocol.
#[derive(Clone, Debug)]
pub struct Party {
    /// Its name.
    pub title: Text,
    /// What it is, and what else documents call it.
    pub about: Text,
}

/// `transport:`.
#[derive(Clone, Debug)]
pub struct Transport {
    /// Address of the robot, such as `192.168.1.3`.
    pub host: String,
    /// Ports, in the order written.
    pub ports: Vec<Port>,
}

impl Transport {
    /// The port with this role; a checked model has each role once.
    #[must_use]
    pub fn port(&self, role: PortRole) -> Option<&Port> {
        self.ports.iter().find(|port| port.role == role)
    }
}

/// A TCP port.
#[derive(Clone, Debug)]
pub struct Port {
    /// What it carries.
    pub role: PortRole,
    /// Number.
    pub number: u16,
    /// Description.
    pub text: Text,
}

/// What a port carries; also its key in `transport.ports` and the value of an operation's port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortRole {
    /// Commands and reports (`command`).
    Command,
    /// Streams (`data`).
    Data,
}

/// `frame:`.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Order of the bytes of every integer of the header.
    pub byte_order: ByteOrder,
    /// Header fields in the order in which they travel.
    pub header: Vec<HeaderField>,
    /// First bytes of a request (a command or a report).
    pub request_head: Vec<u8>,
    /// First bytes of a response (an answer or an acknowledgement).
    pub response_head: Vec<u8>,
    /// Values of the header's kind field, sorted.
    pub kinds: Vec<FrameKind>,
    /// Values of the header's encoding field, sorted.
    pub encodings: Vec<Encoding>,
    /// About the data area.
    pub data: Text,
}

impl Frame {
    /// Length of the header in bytes.
    #[must_use]
    pub fn header_len(&self) -> usize {
        self.header.iter().map(|field| field.ty.size()).sum()
    }

    /// The kind with this role; a checked model has stream, command and report once each.
    #[must_use]
    pub fn kind(&self, role: KindRole) -> Option<&FrameKind> {
        self.kinds.iter().find(|kind| kind.role == role)
    }

    /// The encoding with this role; a checked model has each once.
    #[must_use]
    pub fn encoding(&self, role: EncodingRole) -> Option<&Encoding> {
        self.encodings.iter().find(|encoding| encoding.role == role)
    }
}

/// Order of the bytes of an integer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByteOrder {
    /// Most significant byte first.
    Big,
    /// Least significant byte first.
    Little,
}

/// One field of the header.
#[derive(Clone, Debug)]
pub struct HeaderField {
    /// Name in the source document, such as `GZipDataLength`.
    pub wire: String,
    /// Name in code, such as `gzip_data_length`.
    pub name: String,
    /// Width and kind.
    pub ty: HeaderType,
    /// Bytes before it.
    pub offset: usize,
    /// What the engine uses it for; `None` for a field that only travels.
    pub role: Option<HeaderRole>,
    /// What is sent where nothing else decides; only for fields without a role or with role `Status`.
    pub value: u64,
    /// `quirk: zero_when_plain`: a received 0 on an uncompressed frame is accepted.
    pub zero_when_plain: bool,
    /// Description.
    pub text: Text,
    /// Other words for it.
    pub aliases: Aliases,
}

/// Width of a header field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeaderType {
    /// One byte.
    U8,
    /// Two bytes.
    U16,
    /// Four bytes.
    U32,
    /// Eight bytes.
    U64,
    /// A run of bytes (`bytes(16)`), to which the byte order does not apply.
    Bytes(usize),
}

impl HeaderType {
    /// Width in bytes.
    #[must_use]
    pub fn size(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::U32 => 4,
            Self::U64 => 8,
            Self::Bytes(len) => len,
        }
    }
}

/// What the engine uses a header field for. A checked model has each role but `Status` exactly once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HeaderRole {
    /// `head`: the bytes that open a frame, of the same length as both heads; first field.
    Head,
    /// `kind`: u8, one of `frame.kinds`.
    Kind,
    /// `code`: u16, the command code.
    Code,
    /// `id`: u32, ties a response to its request.
    Id,
    /// `encoding`: u8, one of `frame.encodings`.
    Encoding,
    /// `status`: sent as `value`, kept as received, never interpreted.
    Status,
    /// `total_length`: u32, header and data as sent.
    TotalLength,
    /// `plain_length`: u32, data before compression.
    PlainLength,
    /// `digest`: bytes(16), MD5 over the data as sent.
    Digest,
}

/// A value of the kind field.
#[derive(Clone, Debug)]
pub struct FrameKind {
    /// Value on the wire.
    pub value: u8,
    /// Its name in the spec, such as `stream`, `command`, `protobuf`, `report`.
    pub name: String,
    /// What it carries.
    pub role: KindRole,
    /// Port it travels on.
    pub port: PortRole,
    /// Description.
    pub text: Text,
}

/// What a frame of some kind carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KindRole {
    /// Raw bytes.
    Stream,
    /// A command of the app or the robot's answer, as JSON.
    Command,
    /// A report of the robot or the app's acknowledgement, as JSON.
    Report,
    /// Refused by name.
    Reserved,
}

/// A value of the encoding field.
#[derive(Clone, Debug)]
pub struct Encoding {
    /// Value on the wire.
    pub value: u8,
    /// Its name in the spec, `plain` or `gzip`.
    pub name: String,
    /// How the data is packed.
    pub role: EncodingRole,
    /// Description.
    pub text: Text,
}

/// How the data of a frame is packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncodingRole {
    /// As it is.
    Plain,
    /// One gzip member (RFC 1952).
    Gzip,
}

/// A place where RFC 8259 leaves open what a JSON text means. What is done there is fixed, the same in
/// every protocol and language; the vectors have it as examples, and `json:` of the spec says it in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JsonRule {
    /// `text`: what is JSON at all.
    Text,
    /// `known_keys`: keys of a message that come twice.
    KnownKeys,
    /// `unknown_keys`: what is not understood and passed on.
    UnknownKeys,
    /// `integers`: how they may be written, and their range.
    Integers,
    /// `floats`: rounding and range.
    Floats,
    /// `strings`: which of them are text.
    Strings,
}

impl JsonRule {
    /// All, in the order of the spec and the pages.
    pub const ALL: [Self; 6] = [
        Self::Text,
        Self::KnownKeys,
        Self::UnknownKeys,
        Self::Integers,
        Self::Floats,
        Self::Strings,
    ];

    /// Its key under `json:`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::KnownKeys => "known_keys",
            Self::UnknownKeys => "unknown_keys",
            Self::Integers => "integers",
            Self::Floats => "floats",
            Self::Strings => "strings",
        }
    }
}

/// `envelope:`: the keys that stand beside a message's own.
#[derive(Clone, Debug)]
pub struct Envelope {
    /// Of every request.
    pub request: Vec<EnvelopeField>,
    /// Of every response and acknowledgement.
    pub response: Vec<EnvelopeField>,
}

/// A key of the envelope.
#[derive(Clone, Debug)]
pub struct EnvelopeField {
    /// Wire key, such as `cmdTime`.
    pub wire: String,
    /// Name in code, such as `cmd_time`.
    pub name: String,
    /// Type.
    pub ty: Type,
    /// Whether a received message may lack it. It is always sent.
    pub optional: bool,
    /// What the engine uses it for.
    pub role: EnvelopeRole,
    /// Value in composed examples.
    pub example: Scalar,
    /// Description.
    pub text: Text,
    /// Other words for it.
    pub aliases: Aliases,
}

/// What the engine uses an envelope key for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnvelopeRole {
    /// `time`: when the message was made, in milliseconds since 1970.
    Time,
    /// `result_code`: one of the result codes. Responses only.
    ResultCode,
    /// `result_text`: text beside the code, never relied on. Responses only.
    ResultText,
}

/// A result code.
#[derive(Clone, Debug)]
pub struct ResultCode {
    /// Number.
    pub code: i64,
    /// Name in code, such as `invalid_parameter`.
    pub name: String,
    /// When the engine itself answers with it.
    pub role: Option<ResultRole>,
    /// What it means; its Chinese is also the text sent beside it.
    pub text: Text,
    /// When a peer answers with it.
    pub about: Text,
}

/// When the engine itself answers with a result code. A checked model has each role exactly once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ResultRole {
    /// `success`.
    Success,
    /// `protocol`: unknown command, reserved kind, bad digest.
    Protocol,
    /// `timeout`: no answer from the handler in time.
    Timeout,
    /// `invalid`: a body that does not parse or breaks a constraint.
    Invalid,
    /// `expired`: a message older than the configured age.
    Expired,
}

/// Default limits of both stubs; every one can be changed where a stub is made.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Longest frame, header included, in bytes.
    pub frame_bytes: u32,
    /// Longest data after decompression, in bytes.
    pub inflated_bytes: u32,
    /// Deepest nesting of a JSON body.
    pub json_depth: u32,
    /// Calls in flight on one connection.
    pub in_flight: u32,
    /// Reports waiting for one app.
    pub queued_reports: u32,
    /// Connections at one server.
    pub connections: u32,
}

/// A range of command codes with a purpose, both ends included.
#[derive(Clone, Debug)]
pub struct CodeRange {
    /// First code.
    pub first: u16,
    /// Last code.
    pub last: u16,
    /// Spelling of the first code, such as `0x0A01`.
    pub first_spelling: String,
    /// Spelling of the last code.
    pub last_spelling: String,
    /// Its purpose.
    pub usage: RangeUse,
    /// Description.
    pub text: Text,
}

impl CodeRange {
    /// The code that the next operation gets, where new ones are given out: the one after the largest
    /// of those `taken`, or the first gap once the end is reached.
    #[must_use]
    pub fn next(&self, taken: &BTreeSet<u16>) -> Option<u16> {
        if !matches!(self.usage, RangeUse::Commands | RangeUse::Reports) {
            return None;
        }
        let after_last = match taken.range(self.first..=self.last).next_back() {
            Some(last) => last.checked_add(1),
            None => Some(self.first),
        };
        let after_last = after_last.filter(|code| *code <= self.last);
        after_last.or_else(|| (self.first..=self.last).find(|code| !taken.contains(code)))
    }
}

/// Purpose of a range of codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeUse {
    /// `pass_through`: handed to the upper body as it comes.
    PassThrough,
    /// `commands`: new commands count up here.
    Commands,
    /// `reports`: new reports count up here.
    Reports,
    /// `reserved`: not to be given out.
    Reserved,
    /// `historic`: given out in the past, closed for new operations.
    Historic,
}

/// A code that must not be used again.
#[derive(Clone, Debug)]
pub struct RetiredCode {
    /// The code.
    pub code: u16,
    /// Its spelling.
    pub spelling: String,
    /// Why.
    pub text: Text,
}

/// A published table of constants: each row is a value of the struct type `row`.
#[derive(Clone, Debug)]
pub struct Table {
    /// Id, such as `cell_layouts`.
    pub id: String,
    /// Title.
    pub title: Text,
    /// What it is for.
    pub about: Text,
    /// Name of the struct type of a row.
    pub row: String,
    /// Rows as checked values of that type, in wire form.
    pub rows: Vec<Value>,
    /// Where it stands.
    pub location: Location,
}

/// A section number of the source of which nothing is left.
#[derive(Clone, Debug)]
pub struct RetainedSection {
    /// Number.
    pub section: u16,
    /// What is known.
    pub text: Text,
}

/// A gap or slip of the source that the spec must answer.
#[derive(Clone, Debug)]
pub struct Conflict {
    /// Id, such as `C040`.
    pub id: String,
    /// Category, such as `frame`, `codes`, `fields`.
    pub category: String,
    /// How much depends on it.
    pub severity: Severity,
    /// What is missing or contradicts itself.
    pub text: Text,
}
