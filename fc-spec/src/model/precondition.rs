//! The preconditions of a command.

use super::{Scalar, Text, TypeRef};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Preconditions of a command. A precondition that is missing here is unknown.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Accepted {
    /// States in which the robot accepts it; `null` if unknown.
    #[serde(rename = "in")]
    pub states: Option<AcceptedIn>,
    /// Names of the commands to be sent first.
    pub after: Vec<String>,
    /// Additional notes.
    pub note: Option<Text>,
}

/// States in which a robot accepts a command.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AcceptedIn {
    /// Any state.
    Any,
    /// The states in which every listed enum has one of its values.
    States(Vec<StateSet>),
}

/// Some values of an enum.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct StateSet {
    /// The enum, which reports or responses of the robot carry.
    #[serde(rename = "type")]
    pub ty: TypeRef,
    /// Its values, in wire form.
    pub values: Vec<Scalar>,
}

impl Accepted {
    /// Returns the required enum values. Empty if the command has no condition on states.
    #[must_use]
    pub fn state_sets(&self) -> &[StateSet] {
        match &self.states {
            Some(AcceptedIn::States(sets)) => sets,
            Some(AcceptedIn::Any) | None => &[],
        }
    }
}
