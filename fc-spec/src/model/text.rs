//! Sentences in two languages, and the facts that hang on any part of the spec.

use super::{Confirmation, Governed};
use crate::vocabulary::AnswerKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sentence in both languages.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Text {
    /// Chinese.
    pub zh: String,
    /// English.
    pub en: String,
}

/// Other words for a thing: `{ zh: […], en: […] }`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Aliases {
    /// Chinese.
    pub zh: Vec<String>,
    /// English.
    pub en: Vec<String>,
}

/// A place in the spec, for links from generated text back to its source.
///
/// Committed text names it by file and name alone: a line number would change with every line above it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Location {
    /// Path from the project's root with `/` between its parts, such as `spec/commands/station.yaml`.
    pub file: String,
    /// Its name in the file: the keys that lead to the entry it stands in, such as `commands.get_station`
    /// or `frame`; of an answer the first of its ids, if it has any, from the second such one of the file on
    /// with a number: `C040.2`.
    pub name: String,
    /// Line, counted from 1.
    pub line: usize,
}

/// A dated change: `{ date: 2024-01, zh: …, en: … }`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Change {
    /// `YYYY-MM` or `YYYY-MM-DD`.
    pub date: String,
    /// What changed.
    #[serde(flatten)]
    pub text: Text,
}

/// `deprecated: { since, sunset, note: { zh, en }, replaced_by }`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Deprecation {
    /// `YYYY-MM` or `YYYY-MM-DD`, where the source gives it.
    pub since: Option<String>,
    /// Last day or month in which it is there, `YYYY-MM-DD` or `YYYY-MM`.
    #[serde(default)]
    pub sunset: Option<String>,
    /// Why, and what to do instead.
    #[serde(flatten)]
    pub note: Text,
    /// Name of the operation to use instead.
    pub replaced_by: Option<String>,
}

/// What an answer is about.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Subject {
    /// The protocol as a whole.
    Protocol,
    /// Ports and host.
    Transport,
    /// The frame, or one header field.
    Frame(Option<String>),
    /// The envelope, or one of its keys.
    Envelope(Option<String>),
    /// The result codes, or one of them.
    Results(Option<i64>),
    /// A range of codes or the code map.
    Codes,
    /// An operation, by name.
    Operation(String),
    /// A field: `owner` is the name of the type that holds it, `key` its wire key.
    Field {
        /// Name of the struct type.
        owner: String,
        /// Wire key in it.
        key: String,
    },
    /// A named type.
    Type(String),
    /// A table, by id.
    Table(String),
    /// A retained section number of the source.
    Section(u16),
}

/// One entry of an `answers:` list.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Answer {
    /// Ids of the conflicts it answers, such as `C040`; none where the source has lost what it is about.
    pub ids: Vec<String>,
    /// Decision, quirk, note or question.
    pub kind: AnswerKind,
    /// The answer, or what has to be asked.
    #[serde(flatten)]
    pub text: Text,
    /// The facts it governs.
    pub about: Vec<Governed>,
    /// Whether it says what the runtime does, which no value of the spec changes.
    pub runtime: bool,
    /// The owner's word, which settles it.
    pub confirmed: Option<Confirmation>,
    /// Where it stands.
    pub subject: Subject,
    /// Its place.
    #[serde(rename = "place")]
    pub location: Location,
}
