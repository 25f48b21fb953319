//! Operations: commands, reports and streams.

use super::{Aliases, Change, Deprecation, Location, Text};
use crate::vocabulary::{BodyState, Direction, Effect, Kind, Lost, PortRole, Side};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A command group: one file of `spec/commands/`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Group {
    /// Id; also the name of the Rust module.
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
    #[serde(rename = "code_spelling")]
    pub spelling: String,
    /// Stated, inferred or open.
    #[serde(rename = "code_state")]
    pub state: BodyState,
}

/// How often a report is sent again until it is acknowledged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
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

/// One side of an operation.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Body {
    /// Stated, inferred or open.
    pub state: BodyState,
    /// Name of its struct type in `Model::types`; `None` for the raw bytes of a stream.
    /// The struct holds the message's own keys; the envelope stands beside it.
    #[serde(rename = "type")]
    pub ty: Option<String>,
    /// Why it is inferred or open, or what else there is to say.
    pub note: Option<Text>,
}

/// A command, report or stream.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Operation {
    /// `snake_case` name.
    pub name: String,
    /// Command, report or stream.
    pub kind: Kind,
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
    /// Other words for it.
    pub aliases: Aliases,
    /// What it does, where the title does not say it all. Markdown paragraphs.
    pub about: Option<Text>,
    /// What it does to the robot; commands only.
    pub effect: Option<Effect>,
    /// How sure that is; commands only.
    pub effect_state: Option<BodyState>,
    /// Port.
    #[serde(rename = "port_role")]
    pub port: PortRole,
    /// Sections of the source document.
    pub sections: Vec<u16>,
    /// What of the source is lost.
    pub lost: Vec<Lost>,
    /// `YYYY-MM` or `YYYY-MM-DD` of the section's first appearance.
    pub since: Option<String>,
    /// Withdrawn.
    pub deprecated: Option<Deprecation>,
    /// History.
    pub changes: Vec<Change>,
    /// What the command asks, what the report says, what the stream carries.
    pub request: Body,
    /// The answer or acknowledgement.
    pub response: Body,
    /// For reports.
    pub ack: Option<Ack>,
    /// What examples of its response show as result text, where the source prints one.
    pub result_text: Option<String>,
    /// Result codes it may answer besides success, sorted.
    pub errors: Vec<i64>,
    /// Where it stands.
    #[serde(rename = "place")]
    pub location: Location,
}

impl Operation {
    /// Whether the source document has it; what is new has nothing to be sure of.
    #[must_use]
    pub fn is_from_source(&self) -> bool {
        !self.sections.is_empty()
    }

    /// What travels this way.
    #[must_use]
    pub fn body(&self, direction: Direction) -> &Body {
        match direction {
            Direction::Request => &self.request,
            Direction::Response => &self.response,
        }
    }

    /// The least certain of all that is said of it.
    #[must_use]
    pub fn state(&self) -> BodyState {
        self.kind_state
            .max(self.code.state)
            .max(self.effect_state.unwrap_or(BodyState::Stated))
            .max(self.request.state)
            .max(self.response.state)
    }
}
