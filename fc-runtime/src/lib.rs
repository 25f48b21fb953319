//! Frame codec, session, TCP client and server for FC protocol stubs.
//!
//! A generated crate supplies structs with the derives of `fc-derive` and one
//! [`Protocol`] implementation; everything that moves, times or checks bytes is here.

pub mod json;
pub mod message;
pub mod protocol;

pub use json::{BodyError, BodyErrorKind, Bytes64, Extra, FromJson, Json, Serde, ToJson};
pub use message::{Empty, Enveloped, Message, read_enveloped, transcode, write_enveloped};
pub use protocol::{
    AckPolicy, BodyInfo, Command, Defaults, Effect, Header, Limits, OperationInfo, OperationKind,
    Protocol, Report, RequestEnvelope, ResponseEnvelope, ResultText, Results,
};
