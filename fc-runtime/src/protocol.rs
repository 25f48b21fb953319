//! The trait of a generated protocol: its header, envelopes, numbers and operations.
//!
//! **Architecture invariant:** this crate contains no number of a protocol. Every code, port, head
//! byte and result code reaches it through [`Protocol`], [`Command`](crate::Command) and
//! [`Report`](crate::Report).

use crate::message::Message;
use crate::operation::{AckPolicy, OperationInfo, ResultText};
use crate::wire::{Header, Limits};
use std::fmt::Debug;
use std::time::Duration;

/// The envelope keys of a request. `#[derive(Envelope)]` implements it.
pub trait RequestEnvelope: Message {
    /// Creates the envelope of a request made at `time_ms`, in milliseconds since 1970-01-01T00:00:00Z.
    fn at(time_ms: i64) -> Self;
    /// Returns the time of the request in milliseconds since 1970-01-01T00:00:00Z, or `None` if the envelope does not
    /// contain it.
    fn time_ms(&self) -> Option<i64>;
}

/// The envelope keys of a response. `#[derive(Envelope)]` implements it.
pub trait ResponseEnvelope: Message {
    /// `true` if responses carry a result code. Without one, every response means success, and the server does not
    /// answer requests that fail.
    const HAS_RESULT: bool;

    /// Creates the envelope of a response made at `time_ms`, in milliseconds since 1970-01-01T00:00:00Z.
    fn at(time_ms: i64, code: i64, text: &str) -> Self;
    /// Returns the time of the response in milliseconds since 1970-01-01T00:00:00Z, or `None` if the envelope does not
    /// contain it.
    fn time_ms(&self) -> Option<i64>;
    /// Returns the result code, or `None` if responses carry none.
    fn result_code(&self) -> Option<i64>;
    /// Returns the text of the result code, or an empty string. Do not rely on it.
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
    /// Reserved kinds. They have an error different from that of unknown kinds.
    const RESERVED_KINDS: &'static [u8];
    /// Encoding of data that is sent unchanged; 0 if the header has no field for the encoding.
    const PLAIN: u8;
    /// Encoding of data that is sent as one gzip member; `None` if the protocol has no compression.
    const GZIP: Option<u8>;
    /// Quirk: the decoder accepts a plain length of 0 on a frame that is not compressed.
    const ZERO_PLAIN_LENGTH: bool;
    /// Results that the runtime sends.
    const RESULTS: Results;
    /// Default times and limits.
    const DEFAULTS: Defaults;

    /// Returns every operation, for names in spans and logs.
    fn operations() -> &'static [OperationInfo];
}

/// The digest algorithm of a protocol.
pub type DigestOf<P> = <<P as Protocol>::Header as Header>::Digest;

/// Results that the runtime sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Results {
    /// Success.
    pub success: ResultText,
    /// Unknown command, reserved kind, wrong digest.
    pub protocol: ResultText,
    /// The handler exceeded its time limit.
    pub timeout: ResultText,
    /// A body that cannot be read or breaks a constraint.
    pub invalid: ResultText,
    /// A message older than the configured age.
    pub expired: ResultText,
}

/// Default times and limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Defaults {
    /// Longest wait of a call for its response.
    pub call_timeout: Duration,
    /// Longest time of a handler before the server answers with the timeout result.
    pub handler_timeout: Duration,
    /// Oldest message that is served; `None` for any age.
    pub max_age: Option<Duration>,
    /// Acknowledgement of reports.
    pub ack: AckPolicy,
    /// Limits of everything that grows with the data of a peer.
    pub limits: Limits,
}
