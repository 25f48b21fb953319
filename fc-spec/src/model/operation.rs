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
    /// What belongs here.
    pub about: Option<Text>,
    /// Where it stands.
    #[serde(rename = "place")]
    pub location: Location,
}

/// The code of an operation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Code {
    /// Number; `None` while unassigned, and then `state` is `Open`.
    #[serde(rename = "code")]
    pub value: Option<u16>,
    /// As written in the spec, such as `0x0A01` or `unassigned`.
    #[serde(deserialize_with = "names::read_code")]
    #[serde(rename = "code_spelling")]
    pub spelling: String,
    /// Stated, inferred or open.
    #[serde(rename = "code_state")]
    pub state: BodyState,
}

/// How often a report is sent again until it is acknowledged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Ack {
    /// Wait before it is sent again, in milliseconds.
    pub timeout_ms: u32,
    /// How often it is sent again; 0 for once only.
    pub retries: u32,
}

/// `calls:` and `ack:` of `protocol.yaml`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct CallDefaults {
    /// How long an app waits for an answer, in milliseconds.
    pub timeout_ms: u32,
    /// How long the robot lets a handler work, in milliseconds.
    pub handler_timeout_ms: u32,
    /// Age past which a message is refused as expired, in milliseconds; `None`: never.
    pub max_age_ms: Option<u32>,
    /// Default acknowledgement of reports.
    pub ack: Ack,
}

/// One side of a command or report.
#[derive(Clone, Debug)]
pub struct Body {
    /// Stated, inferred or open.
    pub state: BodyState,
    /// The struct with the keys of the message. The envelope is not part of it.
    pub ty: StructRef,
    /// The reason why the body is inferred or open, or another note.
    pub note: Option<Text>,
}

/// What travels, by the kind of the operation.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(into = "ExchangeDump", try_from = "ExchangeDump")]
#[schemars(with = "ExchangeDump")]
pub enum Exchange {
    /// An app asks, the robot answers.
    Command {
        /// What it does to the robot.
        effect: Effect,
        /// How sure that is.
        effect_state: BodyState,
        /// The reports that the robot sends because of it.
        sets_off: Vec<SetOff>,
        /// What has to hold before it is accepted; `None` where nothing is said of that.
        accepted: Option<Accepted>,
        /// What the command asks, and the answer.
        messages: Messages,
    },
    /// The robot says, an app acknowledges.
    Report {
        /// How often it is sent again until it is acknowledged.
        ack: Ack,
        /// When it is sent; `None` where nothing is said of that.
        cadence: Option<Cadence>,
        /// The key that says how far a process has come.
        state: Option<KeyPath>,
        /// Other keys that may say that something failed.
        failures: Vec<KeyPath>,
        /// What the report says, and its acknowledgement.
        messages: Messages,
    },
    /// One side sends, nobody answers.
    Stream(Stream),
}

impl Exchange {
    /// Returns the reports that a command sets off, for linking.
    pub(super) fn sets_off_mut(&mut self) -> Option<&mut Vec<SetOff>> {
        match self {
            Self::Command { sets_off, .. } => Some(sets_off),
            Self::Report { .. } | Self::Stream(_) => None,
        }
    }

    /// Returns the preconditions of a command, for linking.
    pub(super) fn accepted_mut(&mut self) -> Option<&mut Accepted> {
        match self {
            Self::Command { accepted, .. } => accepted.as_mut(),
            Self::Report { .. } | Self::Stream(_) => None,
        }
    }

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

/// A result besides success that an operation may answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct DeclaredError {
    /// The result code.
    pub code: i64,
    /// What it means for this operation; `None` where only the result code's own text is known.
    pub cause: Option<Text>,
}

/// A command, report or stream.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Operation {
    /// `snake_case` name.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Stated, or inferred where the source prints no type.
    pub kind_state: BodyState,
    /// Who sends the request (or the stream).
    pub sender: Side,
    /// Its code.
    #[serde(flatten)]
    pub code: Code,
    /// Id of its group.
    pub group: String,
    /// Title.
    #[serde(flatten)]
    pub title: Text,
    /// Stated, or inferred where the source has lost the heading.
    pub title_state: BodyState,
    /// Other words for it.
    pub aliases: Aliases,
    /// What it does, where the title does not say it all. Markdown paragraphs.
    pub about: Option<Text>,
    /// Port.
    #[serde(rename = "port_role")]
    pub port: PortRole,
    /// Sections of the source document.
    pub sections: Vec<u16>,
    /// What of the source is lost.
    pub lost: Vec<Fact>,
    /// Name of the store in which what it reads and sets is kept.
    pub kept: Option<String>,
    /// `YYYY-MM` or `YYYY-MM-DD` of the section's first appearance.
    #[serde(default, deserialize_with = "names::read_date")]
    pub since: Option<String>,
    /// For whom it is, and where; `None` for everyone.
    pub available: Option<Available>,
    /// Withdrawn.
    pub deprecated: Option<Deprecation>,
    /// History.
    pub changes: Vec<Change>,
    /// Command, report or stream, and what each of them has.
    #[serde(flatten)]
    pub exchange: Exchange,
    /// What examples of its response show as result text, where the source prints one.
    pub result_text: Option<String>,
    /// Results it may answer besides success, by their codes.
    pub errors: Vec<DeclaredError>,
    /// Where it stands.
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
