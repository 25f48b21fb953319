//! Frame codec, session, TCP client and server for FC protocol stubs.
//!
//! A generated crate supplies structs with the derives of `fc-derive` and one [`Protocol`] implementation. All handling
//! of bytes, timing and checks is in this crate. The layers from the inside out:
//!
//! | Layer | Task | Independent of |
//! |---|---|---|
//! | [`json`], [`message`] | Read and write typed messages in one pass | Frames |
//! | [`frame`] | Decode and encode frames within limits | I/O, sessions |
//! | [`session`] | Match responses, track deadlines, detect repetitions | I/O, clocks |
//! | [`client`] | Connection of an app: calls, reports, streams | |
//! | [`server`] | Ports of a robot: handlers, pushed reports, streams | |
//!
//! Features: `client` and `server` (both by default) add the two upper layers and tokio. `frames` alone adds the two
//! layers in the middle, which do no I/O. Without features there are messages and their JSON. `blocking` is the client
//! without `async`. `serde` allows serde types as values of messages. `metrics` passes counters and times to a recorder
//! of the `metrics` crate.
//!
//! ```
//! use fc_runtime::{Decoder, FrameError, Protocol};
//!
//! /// Returns the codes of all frames in a capture.
//! fn codes<P: Protocol>(capture: &[u8]) -> Result<Vec<u16>, FrameError> {
//!     let mut decoder = Decoder::<P>::new();
//!     decoder.push(capture);
//!     let mut codes = Vec::new();
//!     while let Some(frame) = decoder.next()? {
//!         codes.push(frame.id().code);
//!     }
//!     decoder.finish()?;
//!     Ok(codes)
//! }
//! ```

#[cfg(feature = "blocking")]
pub mod blocking;
#[cfg(feature = "client")]
pub mod client;
#[cfg(feature = "net")]
mod clock;
pub mod condition;
#[cfg(feature = "net")]
mod connection_settings;
#[cfg(feature = "net")]
mod content;
pub mod digest;
pub mod envelope;
#[cfg(feature = "frames")]
pub mod frame;
pub mod json;
#[cfg(feature = "net")]
mod link;
#[cfg(feature = "net")]
mod log_limiter;
pub mod message;
#[cfg(feature = "net")]
mod metrics;
#[cfg(feature = "net")]
mod open_message;
pub mod operation;
pub mod preconditions;
#[cfg(feature = "client")]
mod progress;
pub mod protocol;
#[cfg(feature = "net")]
mod rate;
mod raw;
mod refusal;
#[cfg(feature = "server")]
pub mod server;
#[cfg(feature = "frames")]
pub mod session;
#[cfg(feature = "net")]
mod stream;
#[cfg(feature = "net")]
mod sync;
#[cfg(feature = "net")]
mod trace;
pub mod wire;

#[cfg(feature = "client")]
pub use client::{
    Backoff, Call, CallError, CallOptions, ClientConfig, ClientCounters, ConnectError, Connection,
    ConnectionState, ConnectionStates, DataConnection, DataError, FollowError, Followed, Following,
    Loss, RawReports, StreamItem, Subscription,
};
pub use condition::{ConditionError, ConditionErrorKind};
#[cfg(feature = "net")]
pub use content::StreamContent;
#[cfg(feature = "server")]
pub use frame::PreparedResponse;
#[cfg(feature = "frames")]
pub use frame::{Body, Decoder, Encoder, Frame, FrameError, FrameId, Gzip, Prepared};
#[cfg(feature = "serde")]
pub use json::Serde;
pub use json::{
    Allowance, BodyError, BodyErrorKind, Bytes64, Extra, FromJson, Json, JsonRef, ToJson,
};
#[cfg(feature = "net")]
pub use link::Transport;
pub use message::{Empty, Enveloped, Message, read_enveloped, transcode, write_enveloped};
pub use operation::{
    AcceptedIn, AckPolicy, BodyInfo, Command, DeclaredError, Effect, OperationInfo, OperationKind,
    Report, ResultText, SetsOff, State, Stateless, Undeclared,
};
pub use preconditions::{AcceptedStates, Cadence, Preconditions, States};
pub use protocol::{Defaults, Protocol, RequestEnvelope, ResponseEnvelope, Results};
pub use raw::{RawAnswer, RawReport, RawRequest, RawResponse};
pub use refusal::Refusal;
#[cfg(feature = "server")]
pub use server::{
    AckOutcome, Acknowledgement, AppStream, AppStreams, Audience, ConnectionId, Context, Handling,
    Network, NetworkError, PushError, Request, Server, ServerConfig, ServerCounters, ServerHandle,
    Service,
};
#[cfg(feature = "frames")]
pub use session::{Busy, Due, Incoming, Session, SessionRules};
#[cfg(feature = "net")]
pub use stream::StreamFrame;
pub use wire::{Header, Limits};

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
