//! What a generated protocol tells the runtime: its header, envelope, numbers and operations.
//!
//! **Architecture invariant:** this crate contains no number of a protocol. Every code, port, head
//! byte and result code reaches it through [`Protocol`], [`Command`] and [`Report`].

use crate::digest::{DigestAlgorithm, Sum};
use crate::json::{Allowance, BodyError};
use crate::message::{Message, check, transcode};
use crate::needs::{Cadence, Preconditions};
use std::fmt::Debug;
use std::time::Duration;

/// The fixed bytes in front of the data area of every frame.
///
/// `#[derive(Header)]` writes it from the fields of a struct.
pub trait Header: Copy + Send + Sync + 'static {
    /// How the data is digested.
    type Digest: DigestAlgorithm;

    /// Length in bytes.
    const LEN: usize;
    /// Bytes that must have arrived before [`peek_total_length`](Self::peek_total_length) answers.
    const TOTAL_LENGTH_END: usize;
    /// Largest message id: that of 16 or of 32 bits.
    const ID_MAX: u32;

    /// Reads a header from the start of `bytes`; `None` if there are fewer than [`LEN`](Self::LEN).
    fn read(bytes: &[u8]) -> Option<Self>;
    /// Writes [`LEN`](Self::LEN) bytes to the start of `out`; `false`, and nothing written, if it is
    /// shorter.
    fn write(&self, out: &mut [u8]) -> bool;
    /// The total length of the frame that starts `bytes`, as soon as that field has arrived.
    fn peek_total_length(bytes: &[u8]) -> Option<u32>;

    /// A header whose remaining fields have the constant value they are sent with; lengths and
    /// digest are zero until [`seal`](Self::seal). What the header has no field for is left out; of an id
    /// larger than [`ID_MAX`](Self::ID_MAX), the low bits are sent.
    fn new(head: &'static [u8], kind: u8, code: u16, id: u32, encoding: u8) -> Self;
    /// Sets what is known once the data area is: the length of the whole frame, of the data before
    /// compression, and the digest of the data as sent.
    fn seal(&mut self, total_length: u32, plain_length: u32, digest: Sum);

    /// The bytes that open the frame.
    fn head(&self) -> &[u8];
    /// Kind of the data.
    fn kind(&self) -> u8;
    /// Command code.
    fn code(&self) -> u16;
    /// Message id.
    fn id(&self) -> u32;
    /// How the data is packed; 0 if the header has no field for it.
    fn encoding(&self) -> u8;
    /// Length of the whole frame, header included, in bytes.
    fn total_length(&self) -> u32;
    /// Length of the data before compression, in bytes; if the header has no field for it, that of the data as sent.
    fn plain_length(&self) -> u32;
    /// Digest of the data as sent; zeros if the header has no field for it.
    fn digest(&self) -> Sum;
}

/// The envelope keys of a request. `#[derive(Envelope)]` writes it.
pub trait RequestEnvelope: Message {
    /// The envelope of a request made at `time_ms`, in milliseconds since 1970-01-01T00:00:00Z.
    fn at(time_ms: i64) -> Self;
    /// When the request was made, in milliseconds since 1970-01-01T00:00:00Z, if it says so.
    fn time_ms(&self) -> Option<i64>;
}

/// The envelope keys of a response. `#[derive(Envelope)]` writes it.
pub trait ResponseEnvelope: Message {
    /// Whether responses carry a result code. If not, a response says that all went well, and what did not is
    /// not answered.
    const HAS_RESULT: bool;

    /// The envelope of a response made at `time_ms`, in milliseconds since 1970-01-01T00:00:00Z.
    fn at(time_ms: i64, code: i64, text: &str) -> Self;
    /// When the response was made, in milliseconds since 1970-01-01T00:00:00Z, if it says so.
    fn time_ms(&self) -> Option<i64>;
    /// The result code; `None` if no response carries one.
    fn result_code(&self) -> Option<i64>;
    /// The text beside the result code; empty if there is none. Never rely on it.
    fn result_text(&self) -> &str;
}

/// A protocol: its types and every number the runtime needs.
pub trait Protocol: Copy + Default + Debug + Send + Sync + 'static {
    /// Frame header.
    type Header: Header;
    /// Envelope of requests.
    type Request: RequestEnvelope;
    /// Envelope of responses and acknowledgements.
    type Response: ResponseEnvelope;

    /// Short name, for logs.
    const NAME: &'static str;
    /// Usual address of the server.
    const HOST: &'static str;
    /// TCP port of commands, responses and reports.
    const COMMAND_PORT: u16;
    /// TCP port of streams.
    const DATA_PORT: u16;
    /// First bytes of a request.
    const REQUEST_HEAD: &'static [u8];
    /// First bytes of a response.
    const RESPONSE_HEAD: &'static [u8];
    /// Kind of a frame of raw bytes.
    const STREAM: u8;
    /// Kind of a command and of its response.
    const COMMAND: u8;
    /// Kind of a report and of its acknowledgement.
    const REPORT: u8;
    /// Kinds that are refused by name.
    const RESERVED_KINDS: &'static [u8];
    /// Encoding of data sent as it is; 0 if the header does not say how data is packed.
    const PLAIN: u8;
    /// Encoding of data sent as one gzip member; `None` if nothing is compressed.
    const GZIP: Option<u8>;
    /// Quirk: a received plain length of 0 is accepted on a frame that is not compressed.
    const ZERO_PLAIN_LENGTH: bool;
    /// Results the runtime itself answers with.
    const RESULTS: Results;
    /// Times and limits where the user sets none.
    const DEFAULTS: Defaults;

    /// Every operation, for names in spans and logs.
    fn operations() -> &'static [OperationInfo];
}

/// How a protocol digests.
pub type DigestOf<P> = <<P as Protocol>::Header as Header>::Digest;

/// Results the runtime itself answers with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Results {
    /// The call did what it should.
    pub success: ResultText,
    /// Unknown command, reserved kind, bad digest.
    pub protocol: ResultText,
    /// No answer from the handler in time.
    pub timeout: ResultText,
    /// A body that does not parse or breaks a constraint.
    pub invalid: ResultText,
    /// A message older than the configured age.
    pub expired: ResultText,
}

/// A result code and the text sent beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResultText {
    /// Code.
    pub code: i64,
    /// Text.
    pub text: &'static str,
}

/// Times and limits where the user sets none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Defaults {
    /// How long a call waits for its response.
    pub call_timeout: Duration,
    /// How long a handler may take before the peer is told.
    pub handler_timeout: Duration,
    /// Oldest message that is still served; `None` for any age.
    pub max_age: Option<Duration>,
    /// Acknowledgement of reports.
    pub ack: AckPolicy,
    /// Bounds of everything that grows with what a peer sends.
    pub limits: Limits,
}

/// How the acknowledgement of a report is awaited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AckPolicy {
    /// How long to wait before sending the report again; up to an eighth longer, by connection, so
    /// that repetitions to many apps do not coincide.
    pub timeout: Duration,
    /// How often to send it again before giving up.
    pub retries: u32,
}

/// Bounds of everything that grows with what a peer sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Longest frame, header included, in bytes.
    pub frame_bytes: u32,
    /// Longest data after decompression, in bytes.
    pub inflated_bytes: u32,
    /// Most bytes that one byte of compressed data may become, where more than
    /// [`INFLATE_FREE`](Self::INFLATE_FREE) come out. For JSON only: a picture may well be blank.
    pub inflate_ratio: u32,
    /// Deepest nesting of a JSON body.
    pub json_depth: usize,
    /// Most keys of objects and items of lists in a JSON body, those of all levels together.
    pub json_values: usize,
    /// Most memory for the items of lists that are read from a JSON body, in bytes.
    pub json_list_bytes: usize,
    /// Calls in flight on one connection.
    pub in_flight: usize,
    /// Reports waiting for one connection.
    pub queued_reports: usize,
    /// Connections at one server.
    pub connections: usize,
}

impl Limits {
    /// What `inflate_ratio` is unless somebody wants another: 256. Deflate reaches 1,030 with what
    /// repeats itself without end; lists of objects, even with nothing but a number to tell one from
    /// the other, reach 20 to 250.
    pub const INFLATE_RATIO: u32 = 256;
    /// Data of so many bytes (1 MiB) or fewer may have been compressed by any ratio: a scan or a grid
    /// in which all is zero is no longer than that.
    pub const INFLATE_FREE: u32 = 1 << 20;
    /// What `json_values` is unless somebody wants another: 1,048,576.
    pub const JSON_VALUES: usize = Allowance::DEFAULT.values;
    /// What `json_list_bytes` is unless somebody wants another: 32 MiB.
    pub const JSON_LIST_BYTES: usize = Allowance::DEFAULT.list_bytes;

    /// What reading one body may cost.
    #[must_use]
    pub const fn json(&self) -> Allowance {
        Allowance {
            depth: self.json_depth,
            values: self.json_values,
            list_bytes: self.json_list_bytes,
        }
    }
}

/// What a command does to the peer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Only asks.
    Read,
    /// Changes what the peer knows or how it behaves.
    Config,
    /// Sets something in motion.
    Motion,
    /// Nobody knows: never repeated by itself, like what sets something in motion.
    Unknown,
}

impl Effect {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Read, Self::Config, Self::Motion, Self::Unknown];
}

/// A request with a code, tied to its response. `#[derive(Command)]` writes it.
#[diagnostic::on_unimplemented(message = "`{Self}` is not a command", note = "derive `Command`")]
pub trait Command: Message {
    /// What answers it.
    type Response: Message;
    /// The results besides success that it declares.
    type Error: DeclaredError;
    /// Command code.
    const CODE: u16;
    /// Name in the spec.
    const NAME: &'static str;
    /// What it does to the peer.
    const EFFECT: Effect;
}

/// A result besides success that a command declares, by name. `#[derive(DeclaredError)]` writes it.
///
/// A handler refuses with it, since a [`Refusal`](crate::Refusal) is made from it; an app gets it back from
/// [`Refusal::declared`](crate::Refusal::declared).
pub trait DeclaredError: Copy + Debug + 'static {
    /// All that the command declares.
    const ALL: &'static [Self];

    /// Its result code, and the text sent beside it.
    fn result(self) -> ResultText;

    /// The one with this result code.
    #[must_use]
    fn of(code: i64) -> Option<Self> {
        let mut all = Self::ALL.iter().copied();
        all.find(|error| error.result().code == code)
    }
}

/// The error of a command that declares none. There is no value of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Undeclared {}

impl DeclaredError for Undeclared {
    const ALL: &'static [Self] = &[];

    fn result(self) -> ResultText {
        match self {}
    }
}

/// A message that is pushed and acknowledged. `#[derive(Report)]` writes it.
#[diagnostic::on_unimplemented(message = "`{Self}` is not a report", note = "derive `Report`")]
pub trait Report: Message {
    /// Command code.
    const CODE: u16;
    /// Name in the spec.
    const NAME: &'static str;
    /// How its acknowledgement is awaited; `None` for the protocol's default.
    const ACK: Option<AckPolicy>;
    /// The state of the process in this report, or [`Stateless`] if it has none.
    type State: State;

    /// Returns the state of the process, or `None` if the report does not contain it.
    fn state(&self) -> Option<Self::State> {
        None
    }

    /// Returns `true` if the report means a failure.
    fn is_failure(&self) -> bool {
        self.state().is_some_and(|state| state.says_failed())
    }
}

/// A state of a process. `#[derive(OpenEnum)]` implements it for enums whose values are states.
pub trait State: Send + Sync + 'static {
    /// Returns `true` for a final state.
    fn is_end(&self) -> bool;

    /// Returns `true` for a failure.
    fn says_failed(&self) -> bool;

    /// Returns `true` if the spec allows this state after `previous`. Without a rule, every state is allowed. The same
    /// state and a failure are always allowed.
    fn is_in_order(&self, previous: &Self) -> bool;
}

/// The state type of a report without a state. It has no values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stateless {}

impl State for Stateless {
    fn is_end(&self) -> bool {
        match *self {}
    }

    fn says_failed(&self) -> bool {
        match *self {}
    }

    fn is_in_order(&self, _: &Self) -> bool {
        match *self {}
    }
}

/// A command that sets off the reports `R`. `#[derive(Command)]` writes it.
#[diagnostic::on_unimplemented(
    message = "nothing is said of `{Self}` setting off `{R}`",
    note = "`#[fc(sets_off(…))]` says which reports a command sets off"
)]
pub trait SetsOff<R: Report>: Command + Clone {
    /// Whether the report belongs to this call, which was answered with `answer`: what ties them differs in
    /// neither. True of every report where nothing in the messages ties them.
    fn has_set_off(&self, answer: &Self::Response, report: &R) -> bool {
        let _ = (answer, report);
        true
    }
}

/// What an operation is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OperationKind {
    /// A request and its response.
    Command,
    /// A pushed message and its acknowledgement.
    Report,
    /// Frames of raw bytes.
    Stream,
}

/// All that a tool needs to know of an operation without its types.
#[derive(Clone, Copy, Debug)]
pub struct OperationInfo {
    /// Name in the spec.
    pub name: &'static str,
    /// Command code; `None` while the spec has not given one.
    pub code: Option<u16>,
    /// What it is.
    pub kind: OperationKind,
    /// What a command does to the peer; `None` for reports and streams.
    pub effect: Option<Effect>,
    /// What has to hold before a command is accepted; `None` where the spec says nothing of that.
    pub preconditions: Option<Preconditions>,
    /// When a report is sent; `None` where the spec says nothing of that.
    pub cadence: Option<Cadence>,
    /// Chinese title.
    pub zh: &'static str,
    /// English title.
    pub en: &'static str,
    /// First version of the spec that has it, as `YYYY-MM` or `YYYY-MM-DD`.
    pub since: Option<&'static str>,
    /// Whether it has been withdrawn.
    pub deprecated: bool,
    /// Path of its page below the documentation's root.
    pub docs: &'static str,
    /// File of the spec that defines it, as a path from the project's root.
    pub spec: &'static str,
    /// Its request, or the body of a report.
    pub request: BodyInfo,
    /// Its response, or the acknowledgement of a report.
    pub response: BodyInfo,
}

/// A body without its type.
#[derive(Clone, Copy, Debug)]
pub struct BodyInfo {
    /// The spec's example as JSON, own keys only.
    pub example: &'static str,
    /// Reads the own keys as the typed message and writes it again in canonical form.
    pub transcode: fn(&[u8]) -> Result<Vec<u8>, BodyError>,
    /// Reads the own keys as the typed message, within this allowance, and says what is wrong with
    /// them.
    pub check: fn(&[u8], Allowance) -> Result<(), BodyError>,
}

impl BodyInfo {
    /// Describes the body type `M`.
    #[must_use]
    pub const fn of<M: Message>() -> Self {
        Self {
            example: M::EXAMPLE,
            transcode: transcode::<M>,
            check: check::<M>,
        }
    }
}

/// Refuses, when it is compiled, a code that stands earlier in the list too. The derives call it.
///
/// # Panics
/// If an earlier code is the same.
#[allow(
    clippy::panic,
    clippy::indexing_slicing,
    reason = "evaluated by the compiler, which reports the panic at the place of the code"
)]
pub const fn first_of_its_code(codes: &[u16], index: usize) {
    let mut earlier = 0;
    while earlier < index {
        assert!(
            codes[earlier] != codes[index],
            "an earlier one has the same command code"
        );
        earlier += 1;
    }
}
