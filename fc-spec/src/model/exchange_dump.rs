//! The messages of an operation in a dump, with the same keys for every kind of operation.

use super::operation::{Ack, Body, Exchange, Messages};
use super::stream::{Content, Stream};
use super::{Accepted, Cadence, KeyPath, SetOff, StructRef, Text};
use crate::names;
use crate::vocabulary::{BodyState, Effect, Kind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An exchange in a dump: every key for every kind, `null` where the kind has nothing of it.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
pub(super) struct ExchangeDump {
    /// Command, report or stream.
    kind: Kind,
    /// What it does to the robot; commands only.
    effect: Option<Effect>,
    /// How sure that is; commands only.
    effect_state: Option<BodyState>,
    /// The reports that it sets off; commands only.
    sets_off: Vec<SetOff>,
    /// What has to hold before it is accepted; commands only.
    accepted: Option<Accepted>,
    /// What the command asks, what the report says, what the stream carries.
    request: BodyDump,
    /// The answer or acknowledgement.
    response: BodyDump,
    /// For reports.
    ack: Option<Ack>,
    /// When it is sent; reports only.
    cadence: Option<Cadence>,
    /// Media type of the bytes in a stream's frames, where it is stated and they are raw.
    #[serde(default, deserialize_with = "names::read_media_type")]
    content: Option<String>,
    /// Name of the command after which a stream is sent.
    started_by: Option<String>,
    /// Name of the command after which a stream is no longer sent.
    stopped_by: Option<String>,
    /// The key of a report that says how far a process has come; `null` where there is none.
    state: Option<KeyPath>,
    /// Other keys of a report that may say that something failed.
    failures: Vec<KeyPath>,
}

/// One side of an operation in a dump.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Body")]
struct BodyDump {
    /// Stated, inferred or open.
    state: BodyState,
    /// Name of its struct; `null` for raw bytes and where nothing is sent.
    #[serde(rename = "type")]
    ty: Option<StructRef>,
    /// Why it is inferred or open, or what else there is to say.
    note: Option<Text>,
}

impl From<Exchange> for ExchangeDump {
    fn from(exchange: Exchange) -> Self {
        let of = |kind, request: Option<Body>, response: Option<Body>| Self {
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
                ..of(
                    Kind::Command,
                    Some(messages.request),
                    Some(messages.response),
                )
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
                ..of(
                    Kind::Report,
                    Some(messages.request),
                    Some(messages.response),
                )
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
                    ..of(Kind::Stream, body, None)
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
                effect_state: flat
                    .effect_state
                    .ok_or("a command without `effect_state`")?,
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
