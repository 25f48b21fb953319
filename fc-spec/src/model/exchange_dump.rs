//! The messages of an operation in a dump, with the same keys for every kind of operation.

use super::operation::{Ack, Body, Exchange, Messages};
use super::stream::{Content, Stream};
use super::{Accepted, Cadence, KeyPath, SetOff, StructRef, Text};
use crate::names;
use crate::vocabulary::{BodyState, Effect, Kind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An exchange in a dump. Every kind has every key. A key that does not apply is `null` or empty.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(super) struct ExchangeDump {
    /// Command, report or stream.
    kind: Kind,
    /// Its effect on the robot; commands only.
    effect: Option<Effect>,
    /// Confidence in the effect; commands only.
    effect_state: Option<BodyState>,
    /// The reports that it sets off; commands only.
    sets_off: Vec<SetOff>,
    /// Its preconditions; commands only. `null` if none are stated.
    accepted: Option<Accepted>,
    /// Request of a command, data of a report, or data of a stream.
    request: BodyDump,
    /// Response or acknowledgement. A stream has none: its type is `null`.
    response: BodyDump,
    /// Resending until it is acknowledged; reports only.
    ack: Option<Ack>,
    /// Its cadence; reports only. `null` if none is stated.
    cadence: Option<Cadence>,
    /// Media type of the raw bytes in the frames of a stream; `null` if not stated.
    #[serde(default, deserialize_with = "names::read_media_type")]
    content: Option<String>,
    /// Name of the command that starts a stream; `null` if not stated.
    started_by: Option<String>,
    /// Name of the command that stops a stream; `null` if not stated.
    stopped_by: Option<String>,
    /// Key of a report with the state of a process; `null` if there is none.
    state: Option<KeyPath>,
    /// Other keys of a report whose values can mean that something failed.
    failures: Vec<KeyPath>,
}

/// One side of an operation in a dump.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Body")]
struct BodyDump {
    /// Confidence in the body.
    state: BodyState,
    /// Name of its struct; `null` for raw bytes and for a message that does not exist.
    #[serde(rename = "type")]
    ty: Option<StructRef>,
    /// Reason why it is inferred or open, or another note.
    note: Option<Text>,
}

impl From<Exchange> for ExchangeDump {
    fn from(exchange: Exchange) -> Self {
        let both = |messages: Messages| [Some(messages.request), Some(messages.response)];
        let of = |kind, [request, response]: [Option<Body>; 2]| Self {
            kind,
            effect: None,
            effect_state: None,
            sets_off: Vec::new(),
            accepted: None,
            request: request.map_or(BodyDump::RAW, BodyDump::from),
            response: response.map_or(BodyDump::RAW, BodyDump::from),
            ack: None,
            cadence: None,
            state: None,
            failures: Vec::new(),
            content: None,
            started_by: None,
            stopped_by: None,
        };
        match exchange {
            Exchange::Command {
                effect,
                effect_state,
                sets_off,
                accepted,
                messages,
            } => Self {
                effect: Some(effect),
                effect_state: Some(effect_state),
                sets_off,
                accepted,
                ..of(Kind::Command, both(messages))
            },
            Exchange::Report {
                ack,
                cadence,
                state,
                failures,
                messages,
            } => Self {
                ack: Some(ack),
                cadence,
                state,
                failures,
                ..of(Kind::Report, both(messages))
            },
            Exchange::Stream(stream) => {
                let (content, body) = match stream.content {
                    Content::Bytes(media_type) => (media_type, None),
                    Content::Json(body) => (None, Some(body)),
                };
                Self {
                    content,
                    started_by: stream.started_by,
                    stopped_by: stream.stopped_by,
                    ..of(Kind::Stream, [body, None])
                }
            }
        }
    }
}

impl BodyDump {
    const RAW: Self = Self {
        state: BodyState::Stated,
        ty: None,
        note: None,
    };

    fn message(self) -> Option<Body> {
        Some(Body {
            state: self.state,
            ty: self.ty?,
            note: self.note,
        })
    }
}

impl From<Body> for BodyDump {
    fn from(body: Body) -> Self {
        Self {
            state: body.state,
            ty: Some(body.ty),
            note: body.note,
        }
    }
}

impl TryFrom<ExchangeDump> for Exchange {
    type Error = &'static str;

    fn try_from(flat: ExchangeDump) -> Result<Self, Self::Error> {
        let (request, response) = (flat.request.message(), flat.response.message());
        let messages = |request: Option<Body>| {
            let messages = request.zip(response);
            messages.map(|(request, response)| Messages { request, response })
        };
        Ok(match flat.kind {
            Kind::Command => Self::Command {
                effect: flat.effect.ok_or("a command without `effect`")?,
                effect_state: (flat.effect_state).ok_or("a command without `effect_state`")?,
                sets_off: flat.sets_off,
                accepted: flat.accepted,
                messages: messages(request).ok_or("a command without the type of a body")?,
            },
            Kind::Report => Self::Report {
                ack: flat.ack.ok_or("a report without `ack`")?,
                cadence: flat.cadence,
                state: flat.state,
                failures: flat.failures,
                messages: messages(request).ok_or("a report without the type of a body")?,
            },
            Kind::Stream => Self::Stream(Stream {
                content: request.map_or(Content::Bytes(flat.content), Content::Json),
                started_by: flat.started_by,
                stopped_by: flat.stopped_by,
            }),
        })
    }
}
