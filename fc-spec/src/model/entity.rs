//! `entities:`.

use super::{Location, Text};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A kind of thing that has ids, to which fields refer.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Entity {
    /// Name, such as `station`.
    pub name: String,
    /// What it is called.
    #[serde(flatten)]
    pub title: Text,
    /// Where it stands.
    #[serde(rename = "place")]
    pub location: Location,
}
