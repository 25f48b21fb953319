//! The layers below the messages: transport, envelope, results and code ranges.

use super::{Aliases, Location, Scalar, StructRef, Text, Type, Value};
use crate::names;
use crate::vocabulary::{EnvelopeRole, PortRole, RangeUse, ResultRole, Severity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// `protocol:` of `protocol.yaml`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Protocol {
    /// Short id, such as `fc`; the Rust protocol type is its Pascal case.
    #[serde(deserialize_with = "names::read_snake")]
    pub id: String,
    /// Name.
    #[serde(flatten)]
    pub title: Text,
    /// Its purpose.
    pub about: Text,
    /// Version of the spec.
    #[serde(deserialize_with = "names::read_line")]
    pub version: String,
    /// The robot, the party that listens.
    pub robot: Party,
    /// The app, the party that connects.
    pub app: Party,
}

/// A party of the protocol.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Party {
    /// Its name.
    #[serde(flatten)]
    pub title: Text,
    /// Description, with its other names in documents.
    pub about: Text,
}

/// `transport:`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Transport {
    /// Address of the robot, such as `192.168.1.3`.
    #[serde(deserialize_with = "names::read_line")]
    pub host: String,
    /// Its ports.
    pub ports: Ports,
}

/// The TCP ports of the robot. In a dump they are a list.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(into = "Vec<Port>", try_from = "Vec<Port>")]
#[schemars(with = "Vec<Port>")]
pub struct Ports {
    /// Port of commands and reports.
    pub command: Port,
    /// Port of streams.
    pub data: Port,
}

impl Ports {
    /// Returns the port with this role.
    #[must_use]
    pub fn get(&self, role: PortRole) -> &Port {
        match role {
            PortRole::Command => &self.command,
            PortRole::Data => &self.data,
        }
    }

    /// Returns all ports, in the order of the roles.
    #[must_use]
    pub fn each(&self) -> [&Port; 2] {
        [&self.command, &self.data]
    }
}

impl From<Ports> for Vec<Port> {
    fn from(ports: Ports) -> Self {
        vec![ports.command, ports.data]
    }
}

impl TryFrom<Vec<Port>> for Ports {
    type Error = &'static str;

    fn try_from(ports: Vec<Port>) -> Result<Self, Self::Error> {
        let mut ports = ports;
        ports.sort_by_key(|port| port.role);
        match <[Port; 2]>::try_from(ports) {
            Ok([command, data])
                if command.role == PortRole::Command && data.role == PortRole::Data =>
            {
                Ok(Self { command, data })
            }
            _ => Err("there is one port for commands and one for data"),
        }
    }
}

/// A TCP port.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Port {
    /// Its role.
    pub role: PortRole,
    /// Number.
    pub number: u16,
    /// Description.
    #[serde(flatten)]
    pub text: Text,
}

/// `envelope:`: keys of every message, in addition to those of its body.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Envelope {
    /// Keys of every request.
    pub request: Vec<EnvelopeField>,
    /// Keys of every response and acknowledgement.
    pub response: Vec<EnvelopeField>,
}

impl Envelope {
    /// Returns the response key with the result code. `None` if the envelope has none: then every response means success.
    #[must_use]
    pub fn result_code(&self) -> Option<&EnvelopeField> {
        let mut keys = self.response.iter();
        keys.find(|field| field.role == EnvelopeRole::ResultCode)
    }
}

/// A key of the envelope.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct EnvelopeField {
    /// Wire key, such as `cmdTime`.
    #[serde(deserialize_with = "names::read_line")]
    pub wire: String,
    /// Name in code, such as `cmd_time`.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Type.
    #[serde(rename = "type")]
    pub ty: Type,
    /// `true` if it may be missing in received messages. It is always sent.
    pub optional: bool,
    /// Its role.
    pub role: EnvelopeRole,
    /// Value in composed examples.
    pub example: Scalar,
    /// Description.
    #[serde(flatten)]
    pub text: Text,
    /// Other words for it.
    pub aliases: Aliases,
}

/// A result code.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ResultCode {
    /// Number.
    pub code: i64,
    /// Name in code, such as `invalid_parameter`.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Case in which the runtime returns it automatically; `null` if it never does.
    pub role: Option<ResultRole>,
    /// Its meaning. The Chinese text is also sent as the result text.
    #[serde(flatten)]
    pub text: Text,
    /// Cases in which a peer returns it.
    pub about: Text,
}

/// Default limits of client and server. Each limit can be changed when a client or server is created.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Limits {
    /// Maximum length of a frame in bytes, including the header.
    pub frame_bytes: u32,
    /// Maximum length of the data in bytes, after decompression.
    pub inflated_bytes: u32,
    /// Maximum nesting depth of a JSON body.
    pub json_depth: u32,
    /// Maximum number of calls in flight on one connection.
    pub in_flight: u32,
    /// Maximum number of reports waiting for one app.
    pub queued_reports: u32,
    /// Maximum number of connections at one server.
    pub connections: u32,
}

/// A range of command codes with a purpose, both ends included.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct CodeRange {
    /// First code.
    #[serde(rename = "from")]
    pub first: u16,
    /// Last code.
    #[serde(rename = "to")]
    pub last: u16,
    /// Spelling of the first code, such as `0x0A01`.
    #[serde(deserialize_with = "names::read_code")]
    #[serde(rename = "from_spelling")]
    pub first_spelling: String,
    /// Spelling of the last code.
    #[serde(deserialize_with = "names::read_code")]
    #[serde(rename = "to_spelling")]
    pub last_spelling: String,
    /// Its purpose.
    #[serde(rename = "use")]
    pub usage: RangeUse,
    /// Ids of the groups whose new operations get their codes here. Empty if the range names no groups.
    #[serde(default, deserialize_with = "names::read_snake")]
    pub groups: Vec<String>,
    /// Description.
    #[serde(flatten)]
    pub text: Text,
}

impl CodeRange {
    /// Returns `true` if a code lies in the range.
    #[must_use]
    pub fn has(&self, code: u16) -> bool {
        (self.first..=self.last).contains(&code)
    }

    /// Returns the code for the next operation in a range for new commands or reports.
    ///
    /// It is the code after the largest one in `taken`. At the end of the range, it is the first free code.
    #[must_use]
    pub fn next(&self, taken: &BTreeSet<u16>) -> Option<u16> {
        if !matches!(self.usage, RangeUse::Commands | RangeUse::Reports) {
            return None;
        }
        let after_last = match taken.range(self.first..=self.last).next_back() {
            Some(last) => last.checked_add(1),
            None => Some(self.first),
        };
        let after_last = after_last.filter(|code| *code <= self.last);
        after_last.or_else(|| (self.first..=self.last).find(|code| !taken.contains(code)))
    }
}

/// A code that must not be used again.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct RetiredCode {
    /// The code.
    pub code: u16,
    /// Its spelling.
    #[serde(deserialize_with = "names::read_code")]
    pub spelling: String,
    /// Reason.
    #[serde(flatten)]
    pub text: Text,
}

/// A published table of constants: each row is a value of the struct type `row`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Table {
    /// Id, such as `cell_layouts`.
    #[serde(deserialize_with = "names::read_snake")]
    pub id: String,
    /// Title.
    #[serde(flatten)]
    pub title: Text,
    /// Its purpose.
    pub about: Text,
    /// The struct of a row.
    pub row: StructRef,
    /// Rows as checked values of that type, in wire form.
    pub rows: Vec<Value>,
    /// Name of the store in which it is kept; `null` if none is stated.
    pub kept: Option<String>,
    /// Position in the spec: file, name and line.
    #[serde(rename = "place")]
    pub location: Location,
}

/// A section that is missing from the source document.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct MissingSection {
    /// Number.
    pub section: u16,
    /// Known facts about it.
    #[serde(flatten)]
    pub text: Text,
}

/// A gap or slip of the source that the spec must answer.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Conflict {
    /// Id, such as `C040`.
    #[serde(deserialize_with = "names::read_conflict_id")]
    pub id: String,
    /// Category, such as `frame`, `codes`, `fields`.
    pub category: String,
    /// Its severity.
    pub severity: Severity,
    /// Description of the gap or contradiction.
    #[serde(flatten)]
    pub text: Text,
}
