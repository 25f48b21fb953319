//! The cadence of reports.

use super::Number;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Cadence of a report. A path consists of the wire keys from the body of the report on, joined by dots.
/// A key of a list leads to its items.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Cadence {
    /// The report is sent at each change of the field at this path.
    OnChange(String),
    /// The report is sent at each step of a number.
    Step(Step),
    /// The report is sent at intervals of this many milliseconds.
    EveryMs(u32),
    /// The report is sent at the latest this many milliseconds after a command that sets it off.
    WithinMs(u32),
}

/// A number in a report, and its step from one report to the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Step {
    /// Path of the field.
    pub field: String,
    /// Size of the step, greater than 0.
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
