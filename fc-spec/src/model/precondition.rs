//! The preconditions of a command.

use super::{Scalar, Text, TypeRef};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What has to hold before a command is accepted. What is not said here is not known.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Accepted {
    /// In which states the robot accepts it; `None` where that is not said.
    #[serde(rename = "in")]
    pub states: Option<AcceptedIn>,
    /// Names of the commands that come first.
    pub after: Vec<String>,
    /// More about it.
    pub note: Option<Text>,
}

/// In which states a robot accepts a command.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AcceptedIn {
    /// In any state.
    Any,
    /// In those in which each of these enums has one of these values.
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
