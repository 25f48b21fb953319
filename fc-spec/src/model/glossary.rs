//! The terms of a protocol, from `glossary:`.

use super::{Aliases, Location, Text};
use crate::names;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A word of the protocol, and what it means.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Term {
    /// Id, such as `docking`.
    #[serde(deserialize_with = "names::read_snake")]
    pub id: String,
    /// The word.
    #[serde(flatten)]
    pub word: Text,
    /// What it means.
    pub means: Text,
    /// Other forms of it: synonyms, plurals.
    pub also: Aliases,
    /// Where it stands.
    #[serde(rename = "place")]
    pub location: Location,
}
