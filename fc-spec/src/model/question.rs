//! Questions and decisions for the owner of the protocol.

use super::{AnswerKind, Location, Subject, Text};
use crate::names;
use crate::vocabulary::{Impact, Severity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The word of the protocol's owner: `{ by: 张伟, date: 2026-11-23, reference: …, reply: … }`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Confirmation {
    /// Who said it.
    pub by: String,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    #[serde(deserialize_with = "names::read_date")]
    pub date: String,
    /// Where it can be looked up.
    pub reference: Option<String>,
    /// In their own words, in the language they were said.
    pub reply: Option<String>,
}

/// A fact that an answer governs, and what the spec says of it until the owner has answered.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Governed {
    /// A fact of an operation, such as `code`, or the keys that lead to it from where the answer stands, such as
    /// `response.data.x.unit`.
    pub path: String,
    /// How sure a fact of an operation is: `inferred` or `open`. Of anything else, its value, or `absent`.
    pub meanwhile: String,
}

/// What the owner has been asked, or is to confirm.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Question {
    /// Apart from all others: the first conflict it is about, `C040`, followed by where it stands if that has several
    /// questions, `C087.get_station`; without a conflict, operation and fact, `list_stations.code`.
    pub id: String,
    /// The conflicts it is about.
    #[serde(deserialize_with = "names::read_conflict_id")]
    pub ids: Vec<String>,
    /// A question or a decision.
    pub kind: AnswerKind,
    /// What it holds up.
    pub impact: Impact,
    /// That of the gravest conflict.
    pub severity: Option<Severity>,
    /// Group of the file in which it stands.
    pub group: Option<String>,
    /// What it is about.
    pub subject: Subject,
    /// What is asked, or decided.
    #[serde(flatten)]
    pub text: Text,
    /// The facts it governs.
    pub about: Vec<Governed>,
    /// The owner's word; `None` while it is open.
    pub confirmed: Option<Confirmation>,
    /// The lines of the file that an answer changes, as a diff without line numbers in which `…` is what the owner
    /// has to say; empty where it is settled.
    pub edit: String,
    /// Where it stands.
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
