//! Operations: commands, reports and streams.

use super::exchange_dump::ExchangeDump;
use super::stream::{Content, Stream};
use super::{
    Accepted, Aliases, Available, Cadence, Change, Deprecation, KeyPath, Location, SetOff,
    StructRef, Text,
};
use crate::names;
use crate::vocabulary::{BodyState, Direction, Effect, Fact, Kind, PortRole, Side};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A command group: one file of `spec/commands/`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Group {
    /// Id; also the name of the Rust module.
    #[serde(deserialize_with = "names::read_snake")]
    pub id: String,
    /// Title.
    #[serde(flatten)]
    pub title: Text,
    /// Description; `null` if there is none.
    pub about: Option<Text>,
    /// Position in the spec: file, name and line.
    #[serde(rename = "place")]
    pub location: Location,
}

/// The code of an operation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Code {
    /// Number; `null` while unassigned, with the state `open`.
    #[serde(rename = "code")]
    pub value: Option<u16>,
    /// Spelling in the spec, such as `0x0A01` or `unassigned`.
    #[serde(deserialize_with = "names::read_code")]
    #[serde(rename = "code_spelling")]
    pub spelling: String,
    /// Confidence in the code.
    #[serde(rename = "code_state")]
    pub state: BodyState,
}

/// Resending of a report until it is acknowledged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Ack {
    /// Wait before it is resent, in milliseconds.
    pub timeout_ms: u32,
    /// Maximum number of resends; 0 sends it only once.
    pub retries: u32,
}

/// `calls:` and `ack:` of `protocol.yaml`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct CallDefaults {
    /// Time an app waits for a response, in milliseconds.
    pub timeout_ms: u32,
    /// Time the robot waits for a handler, in milliseconds.
    pub handler_timeout_ms: u32,
    /// Age above which a message is refused as expired, in milliseconds; `null` if messages do not expire.
    pub max_age_ms: Option<u32>,
    /// Default resending of reports.
    pub ack: Ack,
}

/// One side of a command or report.
#[derive(Clone, Debug)]
pub struct Body {
    /// Confidence in the body.
    pub state: BodyState,
    /// The struct with the keys of the message. The envelope is not part of it.
    pub ty: StructRef,
    /// The reason why the body is inferred or open, or another note.
    pub note: Option<Text>,
}

/// Messages of an operation, by its kind.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(into = "ExchangeDump", try_from = "ExchangeDump")]
#[schemars(with = "ExchangeDump")]
pub enum Exchange {
    /// The app sends a request, and the robot sends a response.
    Command {
        /// Its effect on the robot.
        effect: Effect,
        /// Confidence in the effect.
        effect_state: BodyState,
        /// The reports that the robot sends because of it.
        sets_off: Vec<SetOff>,
        /// Its preconditions; `None` if none are stated.
        accepted: Option<Accepted>,
        /// The request and the response.
        messages: Messages,
    },
    /// The robot sends a report, and the app acknowledges it.
    Report {
        /// Resending until it is acknowledged.
        ack: Ack,
        /// Its cadence; `None` if none is stated.
        cadence: Option<Cadence>,
        /// The key with the state of a process; `None` if there is none.
        state: Option<KeyPath>,
        /// Other keys whose values can mean that something failed.
        failures: Vec<KeyPath>,
        /// The report and its acknowledgement.
        messages: Messages,
    },
    /// One side sends frames without a response.
    Stream(Stream),
}

impl Exchange {
    /// Returns the bodies, for linking.
    pub(super) fn bodies_mut(&mut self) -> impl Iterator<Item = &mut Body> {
        let (first, second) = match self {
            Self::Command { messages, .. } | Self::Report { messages, .. } => {
                (Some(&mut messages.request), Some(&mut messages.response))
            }
            Self::Stream(stream) => match &mut stream.content {
                Content::Json(body) => (Some(body), None),
                Content::Bytes(_) => (None, None),
            },
        };
        first.into_iter().chain(second)
    }

    /// Returns the body in this direction.
    fn body_mut(&mut self, direction: Direction) -> Option<&mut Body> {
        let mut bodies = self.bodies_mut();
        match direction {
            Direction::Request => bodies.next(),
            Direction::Response => bodies.nth(1),
        }
    }
}

/// Both sides of a command or report.
#[derive(Clone, Debug)]
pub struct Messages {
    /// The request of a command, or the data of a report.
    pub request: Body,
    /// The response or acknowledgement.
    pub response: Body,
}

impl Messages {
    /// Returns the body in this direction.
    #[must_use]
    pub fn body(&self, direction: Direction) -> &Body {
        match direction {
            Direction::Request => &self.request,
            Direction::Response => &self.response,
        }
    }

    /// Returns both bodies, the request first.
    #[must_use]
    pub fn each(&self) -> [&Body; 2] {
        [&self.request, &self.response]
    }
}

/// A result that an operation may return besides success.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct DeclaredError {
    /// The result code.
    pub code: i64,
    /// Its meaning for this operation; `null` if only the text of the result code is known.
    pub cause: Option<Text>,
}

/// A command, report or stream.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Operation {
    /// `snake_case` name.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Confidence in the kind: inferred if the source prints no type, confirmed if the owner has answered.
    pub kind_state: BodyState,
    /// Sender of the request, the report or the stream.
    pub sender: Side,
    /// Its code.
    #[serde(flatten)]
    pub code: Code,
    /// Id of its group.
    pub group: String,
    /// Title.
    #[serde(flatten)]
    pub title: Text,
    /// Confidence in the title: inferred if the source has lost the heading, confirmed if the owner has answered.
    pub title_state: BodyState,
    /// Other words for it.
    pub aliases: Aliases,
    /// Longer description, as Markdown paragraphs; `null` if the title is enough.
    pub about: Option<Text>,
    /// Port on which it is sent.
    #[serde(rename = "port_role")]
    pub port: PortRole,
    /// Numbers of its sections in the source document; empty if it is not in the document.
    pub sections: Vec<u16>,
    /// Facts missing from the source.
    pub lost: Vec<Fact>,
    /// Name of the store that it reads and sets; `null` if none is stated.
    pub kept: Option<String>,
    /// `YYYY-MM` or `YYYY-MM-DD` of the section's first appearance.
    #[serde(default, deserialize_with = "names::read_date")]
    pub since: Option<String>,
    /// Audiences, machines and releases that have it; `null` for all.
    pub available: Option<Available>,
    /// Its deprecation; `null` if it is not deprecated.
    pub deprecated: Option<Deprecation>,
    /// History.
    pub changes: Vec<Change>,
    /// Kind of the operation, with its messages and the properties of this kind.
    #[serde(flatten)]
    pub exchange: Exchange,
    /// Result text in examples of its response; `null` if the source prints none.
    pub result_text: Option<String>,
    /// Results it may return besides success, by code.
    pub errors: Vec<DeclaredError>,
    /// Position in the spec: file, name and line.
    #[serde(rename = "place")]
    pub location: Location,
}

impl Operation {
    /// Returns `true` if the source document contains the operation.
    #[must_use]
    pub fn is_from_source(&self) -> bool {
        !self.sections.is_empty()
    }

    /// Returns the declared error with this result code, if there is one.
    #[must_use]
    pub fn error(&self, code: i64) -> Option<&DeclaredError> {
        self.errors.iter().find(|error| error.code == code)
    }

    /// Returns the kind of operation.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self.exchange {
            Exchange::Command { .. } => Kind::Command,
            Exchange::Report { .. } => Kind::Report,
            Exchange::Stream(_) => Kind::Stream,
        }
    }

    /// Returns the request and the response. `None` for a stream, which has no response.
    #[must_use]
    pub fn messages(&self) -> Option<&Messages> {
        match &self.exchange {
            Exchange::Command { messages, .. } | Exchange::Report { messages, .. } => {
                Some(messages)
            }
            Exchange::Stream(_) => None,
        }
    }

    /// Returns the effect of a command on the robot.
    #[must_use]
    pub fn effect(&self) -> Option<Effect> {
        match self.exchange {
            Exchange::Command { effect, .. } => Some(effect),
            Exchange::Report { .. } | Exchange::Stream(_) => None,
        }
    }

    /// Returns the reports that a command sets off.
    #[must_use]
    pub fn sets_off(&self) -> &[SetOff] {
        match &self.exchange {
            Exchange::Command { sets_off, .. } => sets_off,
            Exchange::Report { .. } | Exchange::Stream(_) => &[],
        }
    }

    /// Returns the preconditions of a command.
    #[must_use]
    pub fn accepted(&self) -> Option<&Accepted> {
        match &self.exchange {
            Exchange::Command { accepted, .. } => accepted.as_ref(),
            Exchange::Report { .. } | Exchange::Stream(_) => None,
        }
    }

    /// Returns the cadence of a report.
    #[must_use]
    pub fn cadence(&self) -> Option<&Cadence> {
        match &self.exchange {
            Exchange::Report { cadence, .. } => cadence.as_ref(),
            Exchange::Command { .. } | Exchange::Stream(_) => None,
        }
    }

    /// Returns the state of the effect of a command.
    #[must_use]
    pub fn effect_state(&self) -> Option<BodyState> {
        match self.exchange {
            Exchange::Command { effect_state, .. } => Some(effect_state),
            Exchange::Report { .. } | Exchange::Stream(_) => None,
        }
    }

    /// Returns the state of the body in this direction. It is `Stated` for the raw bytes of a stream.
    #[must_use]
    pub fn body_state(&self, direction: Direction) -> BodyState {
        self.body(direction)
            .map_or(BodyState::Stated, |body| body.state)
    }

    /// Returns the directions of the messages. A stream has no response.
    #[must_use]
    pub fn directions(&self) -> &'static [Direction] {
        match self.exchange {
            Exchange::Stream(_) => &[Direction::Request],
            Exchange::Command { .. } | Exchange::Report { .. } => Direction::ALL,
        }
    }

    /// Returns the state of a fact. `None` if an operation of this kind does not have the fact.
    #[must_use]
    pub fn fact_state(&self, fact: Fact) -> Option<BodyState> {
        Some(match fact {
            Fact::Title => self.title_state,
            Fact::Type => self.kind_state,
            Fact::Code => self.code.state,
            Fact::Effect => self.effect_state()?,
            Fact::Request => self.body(Direction::Request)?.state,
            Fact::Response => self.body(Direction::Response)?.state,
        })
    }

    /// Returns the state of a fact, for changes.
    pub(crate) fn fact_state_mut(&mut self, fact: Fact) -> Option<&mut BodyState> {
        Some(match (fact, &mut self.exchange) {
            (Fact::Title, _) => &mut self.title_state,
            (Fact::Type, _) => &mut self.kind_state,
            (Fact::Code, _) => &mut self.code.state,
            (Fact::Effect, Exchange::Command { effect_state, .. }) => effect_state,
            (Fact::Request, exchange) => &mut exchange.body_mut(Direction::Request)?.state,
            (Fact::Response, exchange) => &mut exchange.body_mut(Direction::Response)?.state,
            (Fact::Effect, _) => return None,
        })
    }

    /// Returns the least certain state of the kind, the code, the effect and the bodies.
    #[must_use]
    pub fn state(&self) -> BodyState {
        self.kind_state
            .max(self.code.state)
            .max(self.effect_state().unwrap_or(BodyState::Stated))
            .max(self.body_state(Direction::Request))
            .max(self.body_state(Direction::Response))
    }
}
