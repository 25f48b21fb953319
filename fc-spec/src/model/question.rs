//! Questions and decisions for the owner of the protocol.

use super::{AnswerKind, Location, Subject, Text};
use crate::names;
use crate::vocabulary::{Impact, Severity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Confirmation by the owner of the protocol: `{ by: 张伟, date: 2026-11-23, reference: …, reply: … }`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Confirmation {
    /// Name of the person who confirmed it.
    pub by: String,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    #[serde(deserialize_with = "names::read_date")]
    pub date: String,
    /// Reference, such as a mail or a ticket; `null` if there is none.
    pub reference: Option<String>,
    /// The owner's words, in the original language; `null` if there are none.
    pub reply: Option<String>,
}

/// A fact that an answer governs, with its state in the spec until the owner has answered.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Governed {
    /// A fact of an operation, such as `code`, or the keys from the entry with the answer to the fact, such as
    /// `response.data.x.unit`.
    pub path: String,
    /// Confidence in a fact of an operation: `inferred` or `open`. For any other fact, its value, or `absent`.
    pub meanwhile: String,
}

/// A question to the owner, or a decision that the owner can confirm.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Question {
    /// Unique id. It is the id of the first conflict, such as `C040`.
    /// If the conflict has several questions, the place follows: `C087.get_station`.
    /// Without a conflict, it is the operation and the fact: `list_stations.code`.
    pub id: String,
    /// Ids of its conflicts.
    #[serde(deserialize_with = "names::read_conflict_id")]
    pub ids: Vec<String>,
    /// A question or a decision.
    pub kind: AnswerKind,
    /// Its impact; `decided` for a decision.
    pub impact: Impact,
    /// Highest severity of its conflicts; `null` without a conflict.
    pub severity: Option<Severity>,
    /// Id of the group whose file contains it; `null` for other files.
    pub group: Option<String>,
    /// Subject of the question.
    pub subject: Subject,
    /// Text of the question or decision.
    #[serde(flatten)]
    pub text: Text,
    /// The facts it governs.
    pub about: Vec<Governed>,
    /// The owner's confirmation; `null` while the question is open.
    pub confirmed: Option<Confirmation>,
    /// Lines of the file that an answer changes, as a diff without line numbers. `…` is a value that the owner
    /// must give. Empty if the question is settled.
    pub edit: String,
    /// Position in the spec: that of the answer, or of the operation if no answer covers the fact.
    #[serde(rename = "place")]
    pub location: Location,
}

impl Question {
    /// Returns `true` if the owner has not answered yet.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.confirmed.is_none()
    }
}
