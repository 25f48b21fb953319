//! The cadence of reports.

use super::Number;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// When a robot sends a report. A path is that of wire keys from the report's body on, joined by dots; it leads through
/// lists into their items.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Cadence {
    /// At each change of the field at this path.
    OnChange(String),
    /// At each step of a number.
    Step(Step),
    /// At intervals of this many milliseconds.
    EveryMs(u32),
    /// At the latest this many milliseconds after a command that sets it off.
    WithinMs(u32),
}

/// A number of a report, and how far it moves from one report to the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Step {
    /// Path of the field.
    pub field: String,
    /// How far, greater than 0.
    pub by: Number,
}

impl Cadence {
    /// Returns the path of the field that triggers the report, if there is one.
    #[must_use]
    pub fn field(&self) -> Option<&str> {
        match self {
            Self::OnChange(field) | Self::Step(Step { field, .. }) => Some(field),
            Self::EveryMs(_) | Self::WithinMs(_) => None,
        }
    }
}
