//! The terms of a protocol, from `glossary:`.

use super::{Aliases, Location, Text};
use crate::names;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A term of the protocol and its meaning.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Term {
    /// Id, such as `docking`.
    #[serde(deserialize_with = "names::read_snake")]
    pub id: String,
    /// The term.
    #[serde(flatten)]
    pub word: Text,
    /// Its meaning.
    pub means: Text,
    /// Other forms of the term: synonyms, plurals.
    pub also: Aliases,
    /// Position in the spec: file, name and line.
    #[serde(rename = "place")]
    pub location: Location,
}
