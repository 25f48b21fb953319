//! Frame codec, session, TCP client and server for FC protocol stubs.
//!
//! A generated crate supplies structs with the derives of `fc-derive` and one
//! [`Protocol`] implementation; everything that moves, times or checks bytes is here.

#[cfg(feature = "client")]
pub mod client;
#[cfg(feature = "net")]
mod clock;
pub mod envelope;
pub mod frame;
pub mod json;
#[cfg(feature = "net")]
mod keys;
#[cfg(feature = "net")]
mod link;
pub mod message;
pub mod protocol;
mod raw;
#[cfg(feature = "server")]
pub mod server;
pub mod session;
#[cfg(feature = "net")]
mod stream;

#[cfg(feature = "client")]
pub use client::{
    Backoff, Call, CallError, CallOptions, ClientConfig, ClientCounters, ConnectError, Connection,
    DataConnection, RawReports,
};
pub use frame::{Body, Decoder, Encoder, Frame, FrameError, FrameId, Gzip, Prepared, digest};
#[cfg(feature = "net")]
pub use link::Stream;

pub use json::{BodyError, BodyErrorKind, Bytes64, Extra, FromJson, Json, Serde, ToJson};
pub use message::{Empty, Enveloped, Message, read_enveloped, transcode, write_enveloped};
pub use protocol::{
    AckPolicy, BodyInfo, Command, Defaults, Effect, Header, Limits, OperationInfo, OperationKind,
    Protocol, Report, RequestEnvelope, ResponseEnvelope, ResultText, Results,
};
pub use raw::{RawAnswer, RawReport, RawRequest, RawResponse, Refusal};
#[cfg(feature = "server")]
pub use server::{
    AckOutcome, Acknowledgement, AppStream, AppStreams, Audience, ConnectionId, Context, Handling, PushError, Request,
    Server, ServerConfig, ServerCounters, ServerHandle, Service,
};
#[cfg(feature = "net")]
pub use stream::{StreamError, StreamFrame};
pub use session::{Busy, Due, Incoming, Session};
